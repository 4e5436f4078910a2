// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <steadyrest/contour/offline/identify/servo_fit.hpp>
#include <steadyrest/kernel/machine/axis.hpp>
#include <steadyrest/kernel/machine/dialect.hpp>

namespace steadyrest::contour::offline {

/// A setting of the control, in the control's own unit.
struct ServoSetting {
  std::string parameter;
  double value = 0.0;
  std::string unit;
};

/// What the axis makes of a circle of radius R at speed v, both axes alike.
struct CircleFigures {
  double radius_error = 0.0;     ///< R − R′
  double following_error = 0.0;  ///< RMS of one axis
};

/// Settings that take most of an axis's error away.
struct ServoProposal {
  std::vector<ServoSetting> settings;
  double radius = 0.0;
  double speed_au_s = 0.0;
  CircleFigures before;
  CircleFigures after;
};

/// Settings for this axis on a circle of 10 mm (rotary: rad of an equal share of the travel) at the
/// most speed and acceleration that the axis has. Empty: the control has none that this module
/// knows, or nothing is won beyond two standard deviations of what the fit leaves open.
///
/// LinuxCNC (pid): x″·τ + x′ = P·(c − x) + FF1·c′ + FF2·c″; FF1 = 1, FF2 = τ leave no error.
/// SINUMERIK: speed feed-forward (MD32620 = 3, MD32610 = 1) with the setpoint of the position loop
/// delayed by MD32810 = τ leaves x = c/(1 + τ·s).
/// P, MD32200: raised until k·τ = ¼ with the longest τ that the record allows, the aperiodic limit;
/// only where τ is known and the encoder sees no structural mode.
///
/// Sources: linuxcnc pid(9); SINUMERIK 840D sl function manual K3/G2, equivalent time constant.
[[nodiscard]] std::optional<ServoProposal> propose(const ServoFit& fit,
                                                   const kernel::machine::Axis& axis,
                                                   kernel::machine::Dialect dialect);

/// The error by the transfer function (k + f·s + b·s²)/(τ·s² + s + k), its setpoint delayed by
/// 1/(1 + T·s) in the position loop: b LinuxCNC's FF2, T SINUMERIK's MD32810.
struct ServoPlan {
  double gain_1_s = 0.0;
  double feed_forward = 0.0;
  double second_s = 0.0;    ///< b
  double balanced_s = 0.0;  ///< T
};
[[nodiscard]] CircleFigures on_circle(const ServoPlan& plan, double lag_s, double delay_s,
                                      double radius, double speed_au_s);

}  // namespace steadyrest::contour::offline
