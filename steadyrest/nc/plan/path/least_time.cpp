// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/nc/plan/path/least_time.hpp>

namespace steadyrest::nc::plan {

using kernel::outcome::Refusal;

std::optional<Refusal> LeastTime::add(const Piece& piece, const interpret::Move& move) {
  if (piece.plan.rapid) {
    return std::nullopt;
  }
  return add_time(piece.segment.length_mm / piece.segment.feed_mm_s, move.line);
}

std::optional<Refusal> LeastTime::add_dwell(const interpret::Move& dwell) {
  return add_time(dwell.dwell_s, dwell.line);
}

std::optional<Refusal> LeastTime::add_time(double seconds, std::uint32_t line) {
  constexpr double kDay_s = 24.0 * 3600.0;
  total_s_ += seconds;
  if (total_s_ <= kLongestProgram_s) {
    return std::nullopt;
  }
  return kernel::outcome::bad_input(
      "", line,
      seconds > kLongestProgram_s
          ? fmt::format("takes {:.3g} days; a program may take 30 days", seconds / kDay_s)
          : "the program takes longer than 30 days up to here",
      "look for a feed or a dwell in the wrong unit");
}

}  // namespace steadyrest::nc::plan
