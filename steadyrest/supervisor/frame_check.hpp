// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>

#include <steadyrest/kernel/machine/axis.hpp>
#include <steadyrest/kernel/outcome/reason.hpp>
#include <steadyrest/kernel/signal/frame.hpp>

namespace steadyrest::supervisor {

/// Judges whether one cycle's inputs may be acted on.
///
/// Law, first match wins: any number that is not finite → input_not_finite; too many axes, a
/// negative feed, a linear axis further outside its limits than its whole travel →
/// input_out_of_range; the clock's verdict on the time stamp; age above `stale_after_s` →
/// input_stale; else none.
/// The override states are not checked here: each channel's envelope checks its own, so that a bad
/// spindle panel does not withdraw the feed.
/// A port that delivers an old sample must say so in `age_s`; there is no clock here.
class FrameCheck {
 public:
  FrameCheck(std::span<const kernel::machine::Axis> axes, double stale_after_s) noexcept;

  /// `of_time`: FrameClock's verdict on the frame's time stamp.
  [[nodiscard]] kernel::outcome::Reason fault(const kernel::signal::Frame& frame,
                                              kernel::outcome::Reason of_time) const noexcept;

 private:
  struct Range {
    double min;
    double max;
  };

  [[nodiscard]] bool finite(const kernel::signal::Frame& frame) const noexcept;
  [[nodiscard]] bool in_range(const kernel::signal::Frame& frame) const noexcept;

  std::array<Range, kernel::signal::kMaxAxes> range_{};
  double stale_after_s_;
};

}  // namespace steadyrest::supervisor
