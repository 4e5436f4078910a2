// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include <fmt/core.h>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/nc/rewrite/walk/frame_line.hpp>

namespace steadyrest::nc::rewrite {

// A line that changes the frame while a correction is in force: the correction comes off before it
// and goes on again after it. The obstacles, in the order they are reported.
std::optional<kernel::outcome::Refusal> fault_of(const FrameLine& frame, char letter,
                                                 const std::string& program) {
  const auto refuse = [&](std::string what, std::string to_do) {
    return kernel::outcome::bad_input(program, frame.line, std::move(what), std::move(to_do));
  };
  const bool end = frame.ends;
  if (frame.frame == Frame::measured) {
    return refuse(
        fmt::format("measures another work offset (G10 L20) while a correction of {} is on",
                    letter),
        "measure before the first correction, or leave this axis out of the plan");
  }
  if (frame.frame == Frame::stored) {
    return refuse(fmt::format("stores the machine position (G28.1, G30.1) while a correction of {} "
                              "is on: the correction would remain in it after the program",
                              letter),
                  "store it before the first correction, or leave this axis out of the plan");
  }
  // Lines that may run twice or never cannot take it off reliably.
  if (!frame.may_write) {
    constexpr std::string_view kWhere =
        "in a subprogram, a loop, cutter compensation, a rotated frame, diameter mode (G7) or a "
        "block-delete line";
    return end ? refuse(fmt::format("the program ends {}: there is no way to remove the correction",
                                    kWhere),
                        "end the program at its top level")
               : refuse(fmt::format("the work offset changes {} while a correction is on", kWhere),
                        "change it at the top level, without /");
  }
  // The axis would move uncorrected in that line.
  if (frame.moves_axis && frame.frame == Frame::changed) {
    return refuse(
        fmt::format("the work offset changes in a line that moves {} while a correction is on",
                    letter),
        "change the work offset on a separate line");
  }
  return std::nullopt;
}

}  // namespace steadyrest::nc::rewrite
