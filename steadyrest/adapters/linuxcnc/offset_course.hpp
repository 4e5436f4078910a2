// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include <steadyrest/adapters/linuxcnc/sample.hpp>

namespace steadyrest::adapters::linuxcnc {

/// Makes LinuxCNC's external offsets follow what the layer asks for.
///
/// Its planner moves an offset o towards the target T with the acceleration a of the axis's share:
/// v = √(2a·(T − o) + (a·Δt)²) − a·Δt. A target that moves is followed late, by v²/2a; so the
/// target leads by that. While the machine is off LinuxCNC takes the offset in force into the
/// commanded position: the target is 0 then and grows from 0 at 1 mm/s afterwards.
class OffsetCourse {
 public:
  /// mm/s² (rad/s²) of each axis for offsets; 0: not known, no lead.
  explicit OffsetCourse(const kernel::signal::AxisValues& acceleration = {}) noexcept
      : acceleration_(acceleration) {}

  /// Turns the offsets that `pins` has into what the HAL gets. Once for each command.
  void apply(Pins& pins, bool enabled, std::uint64_t tick, double period_s) noexcept;

 private:
  kernel::signal::AxisValues acceleration_;
  kernel::signal::AxisValues asked_{};  ///< the last sum of both offsets
  std::uint64_t tick_ = 0;
  bool begun_ = false;
  bool was_off_ = false;
  kernel::signal::AxisValues given_{};  ///< of the offset against heat, after the machine was off
};

}  // namespace steadyrest::adapters::linuxcnc
