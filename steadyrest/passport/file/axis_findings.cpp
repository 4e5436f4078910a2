// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/core.h>

#include <steadyrest/kernel/units/convert.hpp>
#include <steadyrest/passport/file/axis_findings.hpp>

namespace steadyrest::passport {
namespace {

using kernel::machine::Axis;
using kernel::machine::Machine;

using List = std::vector<Finding>;

constexpr double kSameGain = 0.005;  // of the mean: finer than a gain can be set

/// A line at 45° at speed v: each axis runs at v/√2 and lags by (v/√2)/k; the difference of the
/// lags, projected across the line, is (v/2)·|1/kx − 1/ky|. Circles become ellipses by the same
/// amount.
void servo_gains(const Machine& machine, List& out) {
  const auto axes = contouring(machine);
  if (axes.empty()) {
    return;
  }
  const auto [low, high] = std::minmax_element(
      axes.begin(), axes.end(),
      [](const Axis* a, const Axis* b) { return a->servo_gain_1_s < b->servo_gain_1_s; });
  const double k_low = (*low)->servo_gain_1_s;
  const double k_high = (*high)->servo_gain_1_s;
  if (k_high - k_low <= kSameGain * k_high) {
    return;
  }
  // 1000 mm/min, a feed that everyone can picture.
  constexpr double kSpeed_mm_s = 1000.0 / 60.0;
  out.push_back(
      {Severity::warning, "servo_gain",
       fmt::format("the servo gains differ: {} has {:.4g} 1/s, {} has {:.4g} 1/s; that alone costs "
                   "{:.1f} µm on a 45° line at 1000 mm/min",
                   (*low)->name, k_low, (*high)->name, k_high,
                   kernel::units::um_from_mm(kSpeed_mm_s / 2.0 * (1.0 / k_low - 1.0 / k_high))),
       "set axes that contour together to the same gain"});
}

/// Lag is (1 − a)·v/k, so unequal weights act like unequal gains.
void feed_forward(const Machine& machine, List& out) {
  const auto axes = contouring(machine);
  const bool differ = std::any_of(axes.begin(), axes.end(), [&](const Axis* axis) {
    return std::abs(axis->feed_forward - axes.front()->feed_forward) > 1e-6;
  });
  if (differ) {
    out.push_back({Severity::warning, "feed_forward", "the axes' feed-forward weights differ",
                   "set axes that contour together to the same weight"});
  }
}

/// Closed loop with lag τ in the velocity loop: τ·s² + s + k, damping 1/(2·√(kτ)). It is 1 at kτ =
/// 0.25, where overshoot begins, and 0.5 at kτ = 1.
void drives(const Machine& machine, List& out) {
  for (const Axis& axis : machine.axes) {
    if (axis.drive_acceleration_au_s2 < axis.max_acceleration_au_s2) {
      out.push_back(
          {Severity::warning, "drive_acceleration",
           fmt::format("axis {} plans with more acceleration than its drive delivers", axis.name),
           "lower max_acceleration below drive_acceleration, or the drive saturates"});
    }
    // Friction at least as strong as the drive: the axis never breaks away.
    if (axis.friction.breakaway_au_s2 >= axis.drive_acceleration_au_s2) {
      out.push_back(
          {Severity::error, "friction",
           fmt::format(
               "axis {} is unable to move: its friction is not below what the drive delivers",
               axis.name),
           "correct [axis.friction] or drive_acceleration"});
    }
    if (axis.velocity_lag_s * axis.servo_gain_1_s >= 1.0) {
      out.push_back({Severity::warning, "servo_gain",
                     fmt::format("axis {} oscillates: gain times velocity lag is {:.2f}", axis.name,
                                 axis.velocity_lag_s * axis.servo_gain_1_s),
                     "lower servo_gain or velocity_lag; overshoot begins at 0.25"});
    }
    // Sampled with one period of dead time the loop is z² − z + kT = 0; its roots leave the unit
    // circle at kT = 1.
    if (machine.control.servo_period_s * axis.servo_gain_1_s >= 1.0) {
      out.push_back({Severity::error, "servo_gain",
                     fmt::format("axis {} is unstable: gain times servo period is {:.2f}",
                                 axis.name, machine.control.servo_period_s * axis.servo_gain_1_s),
                     "lower servo_gain or servo_period_ms; the product must stay well below 1"});
    }
  }
}

/// An unknown lag changes the sign of the error on a circle between kτ = 0 and 1.
void unknown_lag(const Machine& machine, List& out) {
  std::string names;
  for (const Axis* axis : contouring(machine)) {
    if (!axis->velocity_lag_known) {
      names += (names.empty() ? "" : ", ") + axis->name;
    }
  }
  if (!names.empty()) {
    out.push_back(
        {Severity::note, "velocity_lag",
         fmt::format("the lag of the velocity loop of {} is not known: program predistort "
                     "changes only what gets no worse with any",
                     names),
         "fit it with machine from-log, or write velocity_lag_ms (0: none)"});
  }
}

/// A limit along the path beyond what all axes together can do (the root of the sum of squares) is
/// harmless, but the reader of the file expects it to have an effect.
void path_limits(const Machine& machine, List& out) {
  double speed2 = 0.0;
  double acceleration2 = 0.0;
  for (const Axis* axis : contouring(machine)) {
    speed2 += axis->max_speed_au_s * axis->max_speed_au_s;
    acceleration2 += axis->max_acceleration_au_s2 * axis->max_acceleration_au_s2;
  }
  const auto beyond = [&out](std::string_view key, double value, double reach) {
    if (std::isfinite(value) && value > reach * (1.0 + 1e-9)) {
      out.push_back({Severity::note, "path_limits",
                     fmt::format("{} is more than all axes together can do", key),
                     "leave it out or lower it; the axes' own limits apply"});
    }
  };
  beyond("rapid_mm_min", machine.control.rapid_mm_s, std::sqrt(speed2));
  beyond("max_feed_mm_min", machine.control.max_feed_mm_s, std::sqrt(speed2));
  beyond("max_path_acceleration_mm_s2", machine.control.max_path_acceleration_mm_s2,
         std::sqrt(acceleration2));
}

}  // namespace

std::vector<const Axis*> contouring(const Machine& machine) {
  std::vector<const Axis*> out;
  for (const Axis& axis : machine.axes) {
    if (axis.present && !axis.rotary) {
      out.push_back(&axis);
    }
  }
  return out;
}

void add_axis_findings(const Machine& machine, std::vector<Finding>& out) {
  servo_gains(machine, out);
  feed_forward(machine, out);
  drives(machine, out);
  unknown_lag(machine, out);
  path_limits(machine, out);
}

}  // namespace steadyrest::passport
