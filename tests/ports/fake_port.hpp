// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include <tests/ports/subject.hpp>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/kernel/override/table.hpp>

namespace steadyrest::ports {

/// The smallest machine that keeps the laws: a line along X at 10 mm/s, a cycle of 1 ms; what is
/// written is in force with the next frame.
class FakePort final : public kernel::port::Port {
 public:
  static constexpr double kPeriod_s = 0.001;
  static constexpr double kFeed_mm_s = 10.0;

  FakePort(const kernel::machine::Machine& machine, std::vector<Turn> turns)
      : axes_(machine.axes.size()),
        table_(kernel::override::Table::make(machine.feed_override).value()),
        turns_(std::move(turns)) {
    line_.end_mm = {1000.0, 0.0, 0.0};
    line_.length_mm = 1000.0;
    line_.feed_mm_s = kFeed_mm_s;
  }

  [[nodiscard]] kernel::port::Capability capability() const noexcept override {
    return {
        .feed_override = true, .spindle_override = true, .axis_offset = true, .path_offset = true};
  }

  kernel::outcome::Result<kernel::signal::Frame> read() noexcept override {
    if (lost) {
      return std::unexpected(kernel::outcome::Refusal{.kind = kernel::outcome::Kind::unavailable,
                                                      .file = {},
                                                      .what = "the fake machine does not answer",
                                                      .to_do = "mend its link"});
    }
    kernel::signal::Frame frame;
    frame.cycle = ++cycle_;
    frame.time_s = static_cast<double>(cycle_) * kPeriod_s;
    for (const Turn& turn : turns_) {
      panel_ = turn.time_s <= frame.time_s ? turn.ratio : panel_;
    }
    frame.feed.panel_ratio = panel_;
    frame.feed.panel_code = table_.code(table_.nearest_step(panel_).value_or(0));
    frame.feed.effective_ratio =
        command_.feed_masks_panel ? std::min(panel_, command_.feed_ratio) : panel_;
    frame.spindle.effective_ratio =
        command_.spindle_masks_panel ? std::min(1.0, command_.spindle_ratio) : 1.0;
    frame.motion = kernel::signal::Motion::feed;
    frame.programmed_feed_mm_s = kFeed_mm_s;
    frame.path_speed_mm_s = kFeed_mm_s * frame.feed.effective_ratio;
    s_mm_ += frame.path_speed_mm_s * kPeriod_s;
    frame.axis_count = static_cast<std::uint8_t>(axes_);
    for (std::size_t i = 0; i < axes_; ++i) {
      frame.axis[i].command_mm =
          (i == 0 ? s_mm_ : 0.0) + command_.offset_mm[i] + command_.path_offset_mm[i];
      frame.axis[i].actual_mm = frame.axis[i].command_mm;
    }
    frame.path = {&line_, 1};
    frame.path_position_mm = s_mm_;
    return frame;
  }

  kernel::outcome::Result<void> write(const kernel::signal::Command& command) noexcept override {
    if (!command.write) {
      return kernel::outcome::refuse("a command that must not be written",
                                     "write in the mode act only");
    }
    command_ = command;
    return {};
  }

  bool lost = false;

 private:
  std::size_t axes_;
  kernel::override::Table table_;
  std::vector<Turn> turns_;
  kernel::signal::PathSegment line_;
  kernel::signal::Command command_;
  std::uint64_t cycle_ = 0;
  double panel_ = 1.0;
  double s_mm_ = 0.0;
};

}  // namespace steadyrest::ports
