// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <steadyrest/trial/cut/motion_score.hpp>

// How good the layer's estimates are on this cut, compared with differencing the counts, which is
// all a control would have; the truth is the motor side, where the encoder sits.
namespace steadyrest::trial::cut {
namespace {

using kernel::outcome::Result;
using motion::online::BackwardDifference;

// Without a bound there is no coverage, rather than a perfect one.
double share(std::size_t part, std::size_t whole) {
  return whole == 0 ? std::numeric_limits<double>::quiet_NaN()
                    : static_cast<double>(part) / static_cast<double>(whole);
}

}  // namespace

// Axes without counts have nothing to estimate.
Result<MotionScore> MotionScore::make(std::span<const kernel::machine::Axis> axes, double cycle_s) {
  MotionScore score;
  for (std::size_t i = 0; i < std::min(axes.size(), kernel::signal::kMaxAxes); ++i) {
    const kernel::machine::Axis& axis = axes[i];
    if (!axis.present || !(axis.encoder.count_au > 0.0)) {
      continue;
    }
    auto difference =
        BackwardDifference::make({.count_mm = axis.encoder.count_au, .cycle_s = cycle_s});
    if (!difference) {
      return std::unexpected(std::move(difference.error()));
    }
    score.axes_.push_back({.name = axis.name,
                           .index = i,
                           .count_mm = axis.encoder.count_au,
                           .difference = *difference});
  }
  return score;
}

void MotionScore::add(const kernel::signal::Frame& frame,
                      const kernel::signal::AxisValues& velocity_mm_s,
                      const kernel::signal::AxisValues& acceleration_mm_s2) noexcept {
  const auto square = [](double value) { return value * value; };
  for (Axis& axis : axes_) {
    const kernel::signal::AxisSample& sample = frame.axis[axis.index];
    const double v = velocity_mm_s[axis.index];
    const double a = acceleration_mm_s2[axis.index];
    const auto naive = axis.difference.tick(
        {.t_s = frame.time_s,
         .count = sample.count,
         // The counter rounds: count n is n ± ½.
         .low_mm = (static_cast<double>(sample.count) - 0.5) * axis.count_mm,
         .high_mm = (static_cast<double>(sample.count) + 0.5) * axis.count_mm});
    const double v_error = std::abs(sample.velocity_mm_s - v);
    const double a_error = std::abs(sample.acceleration_mm_s2 - a);
    ++axis.samples;
    axis.estimate_squares.velocity += square(v_error);
    axis.estimate_squares.acceleration += square(a_error);
    axis.difference_squares.velocity += square(naive.velocity_mm_s - v);
    axis.difference_squares.acceleration += square(naive.acceleration_mm_s2 - a);
    // Coverage counts only where there is a bound; a missing bound is no failure.
    axis.bounded[0] += std::isfinite(sample.velocity_bound_mm_s);
    axis.bounded[1] += std::isfinite(sample.acceleration_bound_mm_s2);
    axis.kept[0] +=
        std::isfinite(sample.velocity_bound_mm_s) && v_error <= sample.velocity_bound_mm_s;
    axis.kept[1] += std::isfinite(sample.acceleration_bound_mm_s2) &&
                    a_error <= sample.acceleration_bound_mm_s2;
  }
}

std::vector<MotionFigures> MotionScore::figures() const {
  std::vector<MotionFigures> all;
  for (const Axis& axis : axes_) {
    const auto rms = [&axis](double squares) {
      return axis.samples == 0 ? 0.0 : std::sqrt(squares / static_cast<double>(axis.samples));
    };
    all.push_back({.axis = axis.name,
                   .velocity_rms_mm_s = rms(axis.estimate_squares.velocity),
                   .acceleration_rms_mm_s2 = rms(axis.estimate_squares.acceleration),
                   .difference_velocity_rms_mm_s = rms(axis.difference_squares.velocity),
                   .difference_acceleration_rms_mm_s2 = rms(axis.difference_squares.acceleration),
                   .velocity_coverage_ratio = share(axis.kept[0], axis.bounded[0]),
                   .acceleration_coverage_ratio = share(axis.kept[1], axis.bounded[1])});
  }
  return all;
}

}  // namespace steadyrest::trial::cut
