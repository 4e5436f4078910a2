// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <steadyrest/motion/offline/scene/scene.hpp>
#include <steadyrest/motion/offline/scene/score.hpp>

/// The scenes of reference/motion.md §4c and §4d: count 0.001 mm, 1 kHz, stamps of 100 ns.
namespace steadyrest::motion::offline::test {

using online::Edge;
using online::Estimate;
using online::Estimator;
using online::Tick;

inline constexpr double kCount = 0.001;  ///< mm

/// 5 % phase and 2 % random error of the lines.
inline Recording line_errors() {
  Recording how;
  how.phase_error_counts = 0.05;
  how.line_error_counts = 0.02;
  return how;
}

inline const Record& sine_ideal() {
  static const Record record = offline::record(sine(1.0, 2.0, 2.0), {});
  return record;
}
inline const Record& sine_line_errors() {
  static const Record record = offline::record(sine(1.0, 2.0, 2.0), line_errors());
  return record;
}
/// The S-curve of the table: 20 mm/s, stop, back at 2 mm/s, each held for 0.2 s. Different from
/// `s_curve()`, whose holds weight the RMS over the whole profile differently.
inline Profile table_s_curve() {
  std::vector<JerkPiece> pieces{{0.1, 0.0}};
  const auto add = [&](double change_mm_s, double hold_s) {
    for (const JerkPiece& piece : speed_change(change_mm_s, 200.0, 5000.0)) {
      pieces.push_back(piece);
    }
    pieces.push_back({hold_s, 0.0});
  };
  add(20.0, 0.2);
  add(-20.0, 0.1);
  add(-2.0, 0.2);
  add(2.0, 0.1);
  return jerk_pieces("s-curve of the table", {0.0003, 0.0, 0.0}, pieces);
}

inline const Record& s_curve_ideal() {
  static const Record record = offline::record(table_s_curve(), {});
  return record;
}
inline const Record& s_curve_line_errors() {
  static const Record record = offline::record(table_s_curve(), line_errors());
  return record;
}

/// Accelerates forever: x = v₀·t + a·t²/2.
inline Profile ramp(double speed_mm_s, double acceleration_mm_s2, double duration_s) {
  Profile out = constant_speed(speed_mm_s, duration_s);
  out.name = "ramp";
  out.max_speed_mm_s = speed_mm_s + acceleration_mm_s2 * duration_s;
  out.max_acceleration_mm_s2 = acceleration_mm_s2;
  out.at = [=](double t) {
    return MotionState{0.00021 + t * (speed_mm_s + 0.5 * acceleration_mm_s2 * t),
                       speed_mm_s + acceleration_mm_s2 * t, acceleration_mm_s2};
  };
  return out;
}

/// The truth `before_s` before tick k; linear between ticks, exact for v and a of constant jerk at
/// whole ticks.
inline MotionState motion_of(const Record& record, std::size_t k, double before_s) {
  const double at = static_cast<double>(k) - before_s * record.how.cycle_hz;
  const auto i = static_cast<std::size_t>(at);
  const double w = at - static_cast<double>(i);
  const MotionState& a = record.truth[i];
  const MotionState& b = record.truth[i + 1];
  return {a.position_mm + w * (b.position_mm - a.position_mm),
          a.velocity_mm_s + w * (b.velocity_mm_s - a.velocity_mm_s),
          a.acceleration_mm_s2 + w * (b.acceleration_mm_s2 - a.acceleration_mm_s2)};
}

/// Mean of estimate − truth from `from_s` on.
inline double mean_velocity_error(const std::vector<Estimate>& estimates, const Record& record,
                                  double from_s) {
  double sum = 0.0;
  double n = 0.0;
  for (std::size_t k = 0; k < estimates.size(); ++k) {
    if (record.ticks[k].t_s >= from_s) {
      sum += estimates[k].velocity_mm_s - record.truth[k].velocity_mm_s;
      n += 1.0;
    }
  }
  return sum / n;
}

template <class E>
Score scored(typename E::Config config, const Record& record, double lag_s = 0.0,
             double from_s = 0.02) {
  E estimator = E::make(config).value();
  return score(run(estimator, record), record, lag_s, from_s);
}

}  // namespace steadyrest::motion::offline::test
