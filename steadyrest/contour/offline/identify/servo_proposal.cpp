// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <complex>

#include <steadyrest/contour/offline/identify/servo_proposal.hpp>

namespace steadyrest::contour::offline {
namespace {

using kernel::machine::Axis;
using kernel::machine::Dialect;

constexpr double kCircleRadius = 10.0;
constexpr double kCircleRadius_rad = 0.1;
constexpr double kAperiodic = 0.25;  // k·τ
constexpr double kWorthRaising = 1.1;
constexpr double kMinMmPerS = 0.06;  // (m/min)/mm for 1/s
constexpr double kSurelyWon = 2.0;   // standard deviations
constexpr double kLagKnown = 2.0;    // times its standard deviation

/// The gain that the record's damping allows; the present one where it does not say.
double allowed_gain(const ServoFit& fit) {
  const bool known = fit.lag_s > kLagKnown * fit.lag_sd_s && fit.most_lag_s > 0.0;
  if (!known || fit.mode_hz > 0.0) {
    return fit.gain_1_s;
  }
  const double most = kAperiodic / std::max(fit.most_lag_s, fit.lag_s);
  return most > kWorthRaising * fit.gain_1_s ? most : fit.gain_1_s;
}

double size_of(const CircleFigures& figures) {
  return std::abs(figures.radius_error) + figures.following_error;
}

/// Standard deviation of the error's size, by what the fit leaves open of k, f and τ.
double doubt(const ServoPlan& plan, const ServoFit& fit, double radius, double speed_au_s,
             bool set_forward) {
  const auto size = [&](double k, double f, double tau) {
    ServoPlan moved = plan;
    moved.gain_1_s = std::max(plan.gain_1_s + k, 1e-3);
    moved.feed_forward += f;
    return size_of(
        on_circle(moved, std::max(0.0, fit.lag_s + tau), fit.delay_s, radius, speed_au_s));
  };
  const double at = size(0.0, 0.0, 0.0);
  return std::hypot(size(fit.gain_sd_1_s, 0.0, 0.0) - at,
                    set_forward ? 0.0 : size(0.0, fit.feed_forward_sd, 0.0) - at,
                    size(0.0, 0.0, fit.lag_sd_s) - at);
}

std::vector<ServoSetting> settings_of(const ServoPlan& plan, const ServoFit& fit, Dialect dialect) {
  std::vector<ServoSetting> out;
  const bool raised = plan.gain_1_s > fit.gain_1_s;
  if (dialect == Dialect::linuxcnc) {
    out.push_back({"FF1", plan.feed_forward, ""});
    if (plan.second_s > 0.0) {
      out.push_back({"FF2", plan.second_s, "s"});
    }
    if (raised) {
      out.push_back({"P", plan.gain_1_s, "1/s"});
    }
    return out;
  }
  out.push_back({"MD32620 $MA_FFW_MODE", 3.0, ""});
  out.push_back({"MD32610 $MA_VELO_FFW_WEIGHT", plan.feed_forward, ""});
  if (plan.balanced_s > 0.0) {
    out.push_back({"MD32810 $MA_EQUIV_SPEEDCTRL_TIME", plan.balanced_s, "s"});
  }
  if (raised) {
    out.push_back({"MD32200 $MA_POSCTRL_GAIN", plan.gain_1_s * kMinMmPerS, "(m/min)/mm"});
  }
  return out;
}

}  // namespace

CircleFigures on_circle(const ServoPlan& plan, double lag_s, double delay_s, double radius,
                        double speed_au_s) {
  const std::complex<double> s(0.0, speed_au_s / radius);
  const auto setpoint = plan.gain_1_s / (1.0 + plan.balanced_s * s);
  const auto response = (setpoint + plan.feed_forward * s + plan.second_s * s * s) /
                        (lag_s * s * s + s + plan.gain_1_s) * std::exp(-delay_s * s);
  return {radius * (1.0 - std::abs(response)), radius * std::abs(1.0 - response) / std::sqrt(2.0)};
}

std::optional<ServoProposal> propose(const ServoFit& fit, const Axis& axis, Dialect dialect) {
  if (dialect != Dialect::linuxcnc && dialect != Dialect::sinumerik) {
    return std::nullopt;
  }
  ServoProposal out;
  out.radius = axis.rotary ? kCircleRadius_rad : kCircleRadius;
  out.speed_au_s =
      std::min(axis.max_speed_au_s, std::sqrt(out.radius * axis.max_acceleration_au_s2));
  const ServoPlan now{.gain_1_s = fit.gain_1_s, .feed_forward = fit.feed_forward};
  ServoPlan then{.gain_1_s = allowed_gain(fit), .feed_forward = 1.0};
  const bool known = fit.lag_s > kLagKnown * fit.lag_sd_s && fit.mode_hz == 0.0;
  (dialect == Dialect::linuxcnc ? then.second_s : then.balanced_s) = known ? fit.lag_s : 0.0;
  const auto figures = [&](const ServoPlan& plan) {
    return on_circle(plan, fit.lag_s, fit.delay_s, out.radius, out.speed_au_s);
  };
  out.before = figures(now);
  out.after = figures(then);
  const double doubts = std::hypot(doubt(now, fit, out.radius, out.speed_au_s, false),
                                   doubt(then, fit, out.radius, out.speed_au_s, true));
  const double won = size_of(out.before) - size_of(out.after);
  const double seen = std::max(axis.encoder.count_au, fit.rms);
  if (won < kSurelyWon * doubts || won < seen ||
      std::abs(out.after.radius_error) > std::abs(out.before.radius_error) + seen) {
    return std::nullopt;
  }
  out.settings = settings_of(then, fit, dialect);
  return out;
}

}  // namespace steadyrest::contour::offline
