// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <fmt/core.h>

#include <steadyrest/kernel/units/convert.hpp>
#include <steadyrest/passport/file/consistency.hpp>

// Findings are about machines that load but will disappoint: values that are each in range and
// together make no sense. The checks say what it costs, in µm or seconds, and what to change.
namespace steadyrest::passport {
namespace {

using kernel::machine::Axis;
using kernel::machine::Contour;
using kernel::machine::Envelope;
using kernel::machine::Machine;
using kernel::machine::OverrideTable;

using List = std::vector<Finding>;

constexpr double kSameGain = 0.005;  // of the mean: less is below what a gain can be set to

/// Axes that contour together: present and linear. A rotary axis lags in degrees; its share of a
/// contour error depends on the radius, which no machine file knows.
std::vector<const Axis*> contouring(const Machine& machine) {
  std::vector<const Axis*> out;
  for (const Axis& axis : machine.axes) {
    if (axis.present && !axis.rotary) {
      out.push_back(&axis);
    }
  }
  return out;
}

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
  // 1000 mm/min, a feed that everybody can picture.
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
    if (axis.drive_acceleration_mm_s2 < axis.max_acceleration_mm_s2) {
      out.push_back(
          {Severity::warning, "drive_acceleration",
           fmt::format("axis {} plans with more acceleration than its drive delivers", axis.name),
           "lower max_acceleration below drive_acceleration, or the drive saturates"});
    }
    // Friction at least as strong as the drive: the axis never breaks away.
    if (axis.friction.breakaway_mm_s2 >= axis.drive_acceleration_mm_s2) {
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

/// A limit along the path beyond what all axes together can do (the root of the sum of squares) is
/// harmless, but the reader of the file expects it to act.
void path_limits(const Machine& machine, List& out) {
  double speed2 = 0.0;
  double acceleration2 = 0.0;
  for (const Axis* axis : contouring(machine)) {
    speed2 += axis->max_speed_mm_s * axis->max_speed_mm_s;
    acceleration2 += axis->max_acceleration_mm_s2 * axis->max_acceleration_mm_s2;
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

/// Steps are decimal fractions, so equality needs a tolerance of rounding only.
bool has_ratio(const OverrideTable& table, double ratio) {
  return std::any_of(table.ratio.begin(), table.ratio.end(),
                     [ratio](double step) { return std::abs(step - ratio) < 1e-9; });
}

/// Faults of one switch. Handing back means writing 100 %: without that step the layer could only
/// leave its own value behind. A max_percent below its steps means that the control clips them:
/// what the layer writes is not what it gets.
void override_table(std::string_view name, const OverrideTable& table, List& out) {
  if (!has_ratio(table, 1.0)) {
    out.push_back({Severity::error, "override_100",
                   fmt::format("[override.{}] has no 100 % step: the layer has no way to hand back "
                               "the programmed value",
                               name),
                   "list every step of the switch"});
  }
  if (table.max_ratio < 1.0) {
    out.push_back({Severity::error, "override_max",
                   fmt::format("[override.{}] is clipped below 100 %", name),
                   "correct max_percent"});
  } else if (!table.ratio.empty() && table.ratio.back() > table.max_ratio * (1.0 + 1e-9)) {
    out.push_back({Severity::warning, "override_max",
                   fmt::format("[override.{}] has steps above its max_percent, which the control "
                               "clips",
                               name),
                   "correct max_percent or the steps"});
  }
}

void overrides(const Machine& machine, List& out) {
  override_table("feed", machine.feed_override, out);
  // The same codes: without [override.rapid] the rapid table is made from the feed's, and one fault
  // is enough.
  if (machine.rapid_override.code != machine.feed_override.code) {
    override_table("rapid", machine.rapid_override, out);
  }
  override_table("spindle", machine.spindle_override, out);
  if (!has_ratio(machine.feed_override, 0.0)) {
    out.push_back({Severity::warning, "override_0", "[override.feed] has no 0 % step",
                   "list it if the switch has one: the operator stops the feed with it"});
  }
}

/// Position feedback resolves one count, so a limit below two would be guessed, not held. Backlash
/// leaves the axis half of it behind on either side of a reversal, at any feed.
void contour_limit(const Machine& machine, List& out) {
  if (!machine.contour.enabled) {
    return;
  }
  for (const Axis* axis : contouring(machine)) {
    if (machine.contour.limit_mm < 2.0 * axis->encoder.count_mm) {
      out.push_back({Severity::error, "contour_limit",
                     fmt::format("the contour limit of {:.4g} µm is below the resolution of axis "
                                 "{}: one count is {:.4g} µm",
                                 kernel::units::um_from_mm(machine.contour.limit_mm), axis->name,
                                 kernel::units::um_from_mm(axis->encoder.count_mm)),
                     "set limit_um to two counts or more"});
    }
    if (machine.contour.limit_mm < 0.5 * axis->backlash_mm) {
      out.push_back({Severity::warning, "contour_limit",
                     fmt::format("the contour limit of {:.4g} µm is below half the backlash of "
                                 "axis {}: no feed holds it at a reversal",
                                 kernel::units::um_from_mm(machine.contour.limit_mm), axis->name),
                     "compensate the backlash in the control or raise limit_um"});
    }
  }
}

/// The envelope clamps last, whatever the rooms ask for; it must leave them room, and 100 % above
/// all, because neutral is 100 %.
void envelope(const Machine& machine, List& out) {
  const Envelope& envelope = machine.envelope;
  const Contour& contour = machine.contour;
  if (contour.min_ratio > envelope.max_feed_ratio || contour.max_ratio < envelope.min_feed_ratio) {
    out.push_back({Severity::error, "envelope", "[contour] and [envelope] have no feed in common",
                   "let min_percent … max_percent overlap min_feed_percent … max_feed_percent"});
  } else if (contour.max_ratio > envelope.max_feed_ratio ||
             contour.min_ratio < envelope.min_feed_ratio) {
    out.push_back({Severity::note, "envelope", "[contour] may ask for feeds that [envelope] clamps",
                   "narrow min_percent … max_percent unless you mean that"});
  }
  if (envelope.min_feed_ratio > 1.0 || envelope.max_feed_ratio < 1.0) {
    out.push_back({Severity::error, "envelope", "[envelope] does not allow 100 % feed",
                   "let min_feed_percent … max_feed_percent contain 100"});
  }
  if (envelope.min_spindle_ratio > 1.0 || envelope.max_spindle_ratio < 1.0) {
    out.push_back({Severity::error, "envelope", "[envelope] does not allow 100 % spindle speed",
                   "let min_spindle_percent … max_spindle_percent contain 100"});
  }
  if (envelope.stale_after_s < machine.control.interpolator_period_s) {
    out.push_back(
        {Severity::error, "stale",
         "stale_after_ms is shorter than one interpolator period: every input would be stale",
         "set stale_after_ms to several periods"});
  }
}

/// What the modulator would refuse, told before a run: a modulation needs two speeds.
void chatter(const Machine& machine, List& out) {
  if (!machine.chatter.enabled) {
    return;
  }
  const auto& envelope = machine.envelope;
  const auto& ratio = machine.spindle_override.ratio;
  const auto within = std::count_if(ratio.begin(), ratio.end(), [&](double r) {
    return r >= envelope.min_spindle_ratio && r <= envelope.max_spindle_ratio;
  });
  if (within < 2) {
    out.push_back({Severity::error, "chatter",
                   "[chatter] is enabled, but the spindle override has fewer than two steps within "
                   "[envelope]",
                   "give [override.spindle], or set enabled = false in [chatter]"});
  }
}

/// Distance covered until an override acts is v·delay; only the look-ahead can act earlier.
void tempo(const Machine& machine, List& out) {
  const double delay_s = machine.feed_override.scan_period_s + machine.feed_override.dead_time_s;
  if (delay_s > 0.5) {
    out.push_back({Severity::warning, "override_delay",
                   fmt::format("a feed override takes up to {:.2f} s to act: shorter features are "
                               "corrected only from the path ahead",
                               delay_s),
                   "use a faster path to the override if there is one"});
  }
}

}  // namespace

/// All checks run: a machine file is corrected once, not fault by fault.
std::vector<Finding> findings(const Machine& machine) {
  List out;
  servo_gains(machine, out);
  feed_forward(machine, out);
  drives(machine, out);
  path_limits(machine, out);
  overrides(machine, out);
  contour_limit(machine, out);
  envelope(machine, out);
  chatter(machine, out);
  tempo(machine, out);
  return out;
}

/// As doctor prints it.
std::string_view word(Severity severity) noexcept {
  switch (severity) {
    case Severity::note:
      return "note";
    case Severity::warning:
      return "warning";
    case Severity::error:
      return "error";
  }
  return "?";
}

}  // namespace steadyrest::passport
