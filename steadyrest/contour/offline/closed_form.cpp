// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>

#include <fmt/core.h>

#include <steadyrest/contour/offline/closed_form.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>

namespace steadyrest::contour::offline {
namespace {

using kernel::outcome::bad_input;
using kernel::outcome::Refusal;
using kernel::outcome::refuse;
using kernel::outcome::Result;

constexpr double kNone = std::numeric_limits<double>::infinity();

std::optional<Refusal> outside(std::string_view what, double value, double low, double high,
                               bool low_allowed) {
  const bool above = low_allowed ? value >= low : value > low;
  if (std::isfinite(value) && above && value <= high) {
    return std::nullopt;
  }
  return bad_input(fmt::format("{} = {:.10g}; allowed: {} {:.10g} … {:.10g}", what, value,
                               low_allowed ? "from" : "above", low, high),
                   "give a value in that range");
}

std::optional<Refusal> unfit(const Servo& servo, double radius_mm) {
  if (auto refusal = outside("radius in mm", radius_mm, 0.0, 1e9, false)) {
    return refusal;
  }
  if (auto refusal = outside("servo gain in 1/s", servo.gain_1_s, 0.0, 1e6, false)) {
    return refusal;
  }
  if (auto refusal = outside("feed-forward weight", servo.feed_forward, 0.0, 1.5, true)) {
    return refusal;
  }
  return outside("velocity lag in s", servo.velocity_lag_s, 0.0, 10.0, true);
}

/// Both errors as fractions of R, at W = ω².
struct Shares {
  double contour = 0.0;
  double tracking = 0.0;
};

// G(jω) = (k + a·jω)/(k − τω² + jω) of the axis law; g = |G|² is the squared ratio of actual to
// commanded radius. At a = τ = 0 this is ε = R − R/√(1 + q²) with q = ω/k.
Shares shares(const Servo& servo, double w) {
  const double k = servo.gain_1_s;
  const double a = servo.feed_forward;
  const double tau = servo.velocity_lag_s;
  const double denominator = (k - tau * w) * (k - tau * w) + w;
  const double gain2 = (k * k + a * a * w) / denominator;
  // 1 − √g = (1 − g)/(1 + √g), with 1 − g free of cancellation at low speed.
  const double one_minus_gain2 = w * (tau * tau * w + (1.0 - 2.0 * k * tau) - a * a) / denominator;
  return {one_minus_gain2 / (1.0 + std::sqrt(gain2)),
          std::sqrt(w * ((1.0 - a) * (1.0 - a) + tau * tau * w) / denominator)};
}

/// Smallest W > 0 with |G|² = g: g·τ²·W² + (g·(1 − 2kτ) − a²)·W + k²·(g − 1) = 0. `rest` = g − 1 is
/// passed in because it is small.
double crossing(const Servo& servo, double rest) {
  const double k = servo.gain_1_s;
  const double tau = servo.velocity_lag_s;
  const double g = 1.0 + rest;
  const double a2 = g * tau * tau;
  const double a1 = g * (1.0 - 2.0 * k * tau) - servo.feed_forward * servo.feed_forward;
  const double a0 = k * k * rest;
  if (a2 == 0.0) {
    const double root = a1 == 0.0 ? kNone : -a0 / a1;
    return root > 0.0 ? root : kNone;
  }
  const double discriminant = a1 * a1 - 4.0 * a2 * a0;
  if (discriminant < 0.0) {
    return kNone;
  }
  // The two roots without cancellation.
  const double q = -0.5 * (a1 + std::copysign(std::sqrt(discriminant), a1));
  const double first = q / a2;
  const double second = q == 0.0 ? kNone : a0 / q;
  double best = kNone;
  for (const double root : {first, second}) {
    if (root > 0.0) {
      best = std::min(best, root);
    }
  }
  return best;
}

}  // namespace

// A circle at constant speed is a sine in each axis, ω = v/R: the steady state follows from the
// transfer function alone. Tracking error: |1 − G|·R.
Result<CircleErrors> circle_errors(const Servo& servo, double radius_mm, double speed_mm_s) {
  if (auto refusal = unfit(servo, radius_mm)) {
    return std::unexpected(*refusal);
  }
  if (auto refusal = outside("speed in mm/s", speed_mm_s, 0.0, 1e9, true)) {
    return std::unexpected(*refusal);
  }
  const double omega = speed_mm_s / radius_mm;
  const Shares share = shares(servo, omega * omega);
  return CircleErrors{radius_mm * share.contour, radius_mm * share.tracking};
}

// Where |G| first leaves 1 ± ε/R: two quadratics in ω², whose smallest positive root is the limit.
// With velocity lag |G| rises above 1 before it falls, so both sides count.
Result<CircleLimit> circle_limit(const Servo& servo, double radius_mm, double max_error_mm) {
  if (auto refusal = unfit(servo, radius_mm)) {
    return std::unexpected(*refusal);
  }
  if (auto refusal = outside("largest error in mm", max_error_mm, 0.0, radius_mm, false)) {
    return std::unexpected(*refusal);
  }
  // With an error equal to R the tool stays at the centre. Close to that the speed grows without
  // bound, and 1 − (1 − ε/R)² is 1 to the last digit.
  constexpr double kMostShare = 1.0 - 1e-6;
  const double share = max_error_mm / radius_mm;
  if (share > kMostShare) {
    return refuse(fmt::format("the largest error, {:.12g} mm, is not below the radius, {:.12g} mm",
                              max_error_mm, radius_mm),
                  "give an error that the part may have, far below the radius");
  }
  // R′ = R ∓ ε: g − 1 = (1 ∓ ε/R)² − 1, written without the 1 that would swallow a small fraction.
  // With velocity lag the circle may first come out too large.
  const double too_small = crossing(servo, -share * (2.0 - share));
  const double too_large = crossing(servo, share * (2.0 + share));
  const double w = std::min(too_small, too_large);
  if (!std::isfinite(w)) {
    // |G| → a without lag, → 0 with it.
    const double rest = servo.velocity_lag_s > 0.0 ? 0.0 : servo.feed_forward;
    return CircleLimit{kNone, {radius_mm * (1.0 - rest), radius_mm * std::abs(1.0 - rest)}};
  }
  const double speed_mm_s = radius_mm * std::sqrt(w);
  const Shares at = shares(servo, w);
  return CircleLimit{speed_mm_s, {radius_mm * at.contour, radius_mm * at.tracking}};
}

}  // namespace steadyrest::contour::offline
