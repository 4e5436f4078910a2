// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include <steadyrest/adapters/linuxcnc/sample.hpp>
#include <steadyrest/kernel/offset/limited_follower.hpp>

namespace steadyrest::adapters::linuxcnc {

/// Makes LinuxCNC's external offsets follow what the layer asks for.
///
/// Its planner moves an offset o towards the target T with the acceleration a of the axis's share,
///   v = √(2a·(T − o) + (a·Δt)²) − a·Δt,
/// so it stays v²/2a behind a target that moves. Here p follows what is asked for with at most
/// 0.9·a, w being its speed, and the target leads it: T = p + w·|w|/2a. Where the layer asks for no
/// more than the axis can do, p is what it asks for; where it asks for more, p overshoots
/// by a twentieth of the offset at most.
///
/// The offset against heat moves by no more than `slew`, in the control's units per second. The
/// layer asks for no more than that, except where it begins at 0: after a start, or a stall, while
/// the offset of before is still in force. It goes on from there.
///
/// While the machine is off LinuxCNC takes the offset in force into the commanded position: the
/// target is 0 then, and the offset against heat grows from 0 by `back` afterwards.
class OffsetCourse {
 public:
  struct Config {
    kernel::signal::AxisValues acceleration{};  ///< for offsets, ≥ 0; 0: not known, no lead
    kernel::signal::AxisValues in_force{};      ///< offset against heat that the HAL has
    double slew = 1.0;                          ///< > 0
    double back = 1.0;                          ///< of the control's units per second, > 0; 1 mm/s
  };

  explicit OffsetCourse(const Config& config) noexcept;

  /// Turns the offsets that `pins` has into what the HAL gets. Once for each command.
  void apply(Pins& pins, bool enabled, std::uint64_t tick, double period_s) noexcept;

 private:
  struct Axis {
    kernel::offset::LimitedFollower sum;  ///< of both offsets: p and w
    double given = 0.0;                   ///< of the offset against heat
  };

  /// T for this axis.
  [[nodiscard]] double target(std::size_t axis, double asked, double dt_s) noexcept;

  kernel::signal::AxisValues acceleration_;
  double slew_;
  double back_;
  std::array<Axis, kernel::signal::kMaxAxes> axis_{};
  std::uint64_t tick_ = 0;
  bool begun_ = false;
  bool was_off_ = false;
};

}  // namespace steadyrest::adapters::linuxcnc
