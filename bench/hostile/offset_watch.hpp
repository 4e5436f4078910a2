// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include <steadyrest/kernel/signal/path.hpp>

namespace steadyrest::bench::hostile {

/// The machine's side of the axis offsets, from the design's safety section only: inside the clamp,
/// by the slew over real time, frozen in the cut without a valid wish (unless they fade there),
/// towards 0 without any.
class OffsetWatch {
 public:
  struct Rules {
    kernel::signal::AxisValues max_mm{};  ///< 0: this axis takes none
    double slew_mm_s = 0.05;
    double slack_s = 0.0;  ///< a stamp may be late by this much
    bool fades = false;    ///< without a wish it ramps out in the cut too
  };

  explicit OffsetWatch(const Rules& rules) : rules_(rules) {}

  void pass(double real_s) noexcept {
    for (double& credit_s : credit_s_) {
      credit_s = std::min(credit_s + real_s, real_s + rules_.slack_s);
    }
  }
  /// Another machine file is in force.
  void limit(const kernel::signal::AxisValues& max_mm) noexcept { rules_.max_mm = max_mm; }
  [[nodiscard]] double limit_mm(std::size_t axis) const noexcept { return rules_.max_mm[axis]; }
  /// The watchdog drops them.
  void drop() noexcept { held_mm_ = {}; }

  /// `wished`: somebody may ask for an offset; `in_cut`: certainly a tool in the cut.
  [[nodiscard]] std::string write(const kernel::signal::AxisValues& offset_mm, bool wished,
                                  bool in_cut) {
    for (std::size_t axis = 0; axis < offset_mm.size(); ++axis) {
      const double now_mm = offset_mm[axis];
      const double before_mm = held_mm_[axis];
      const double moved_mm = std::abs(now_mm - before_mm);
      // Beyond a limit that was lowered it goes back, and no further out.
      const bool beyond = std::abs(before_mm) > rules_.max_mm[axis];
      if (!(std::abs(now_mm) <= std::max(rules_.max_mm[axis], std::abs(before_mm)))) {
        return fmt::format("clamp: axis {} at {:g} mm", axis, now_mm);
      }
      if (moved_mm > rules_.slew_mm_s * credit_s_[axis] + 1e-9) {
        return fmt::format("offset slew: axis {} from {:g} to {:g} mm", axis, before_mm, now_mm);
      }
      if (!wished && moved_mm > 0.0 && in_cut && !rules_.fades && !beyond) {
        return fmt::format("freeze: axis {} from {:g} to {:g} mm in the cut", axis, before_mm,
                           now_mm);
      }
      if (!wished && std::abs(now_mm) > std::abs(before_mm)) {
        return fmt::format("ramp out: axis {} from {:g} to {:g} mm", axis, before_mm, now_mm);
      }
      credit_s_[axis] = std::max(0.0, credit_s_[axis] - moved_mm / rules_.slew_mm_s);
    }
    held_mm_ = offset_mm;
    return {};
  }
  [[nodiscard]] const kernel::signal::AxisValues& held_mm() const { return held_mm_; }
  [[nodiscard]] bool at_zero() const { return held_mm_ == kernel::signal::AxisValues{}; }

 private:
  Rules rules_;
  kernel::signal::AxisValues held_mm_{};
  kernel::signal::AxisValues credit_s_{};
};

}  // namespace steadyrest::bench::hostile
