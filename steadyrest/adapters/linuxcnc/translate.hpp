// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include <steadyrest/adapters/linuxcnc/sample.hpp>
#include <steadyrest/kernel/signal/command.hpp>
#include <steadyrest/kernel/signal/frame.hpp>

namespace steadyrest::adapters::linuxcnc {

/// How LinuxCNC's numbers become ours.
struct Units {
  std::size_t axes = 3;         ///< in the order of the machine file; 1 … 8
  double servo_period_s = 0.0;  ///< [EMCMOT] SERVO_PERIOD; must be given
  double linear_unit_mm = 1.0;  ///< [TRAJ] LINEAR_UNITS: 1, or 25.4 for inches
  std::array<bool, kernel::signal::kMaxAxes> rotary{};  ///< counted in degrees
};

/// A servo cycle as a frame, without its age. Values that are not finite stay so: the supervisor
/// judges them. A feed hold keeps its block's motion, as motion.motion-type does.
[[nodiscard]] kernel::signal::Frame frame_of(const Sample& sample, const Units& units) noexcept;

/// What layer.hal makes of a ceiling for LinuxCNC, which multiplies it with the panel, such that
/// the product is min(ceiling, panel):  share = min(1, ceiling/panel), panel > 0. At panel 0 the
/// control is at rest: the share is then that for a panel that returns to 100 %.
[[nodiscard]] double feed_share(double ceiling_ratio, double panel_ratio) noexcept;

/// The command's ratios and offsets as pins; heartbeat and arming are the port's. What is not
/// finite becomes neutral: the panel's value alone, the offset that `before` had, no path offset.
[[nodiscard]] Pins pins_of(const kernel::signal::Command& command, const Sample& sample,
                           const Units& units, const Pins& before) noexcept;

}  // namespace steadyrest::adapters::linuxcnc
