// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <steadyrest/motion/online/estimator/estimator.hpp>

/// Exactly known motions, and an encoder's record of them.
namespace steadyrest::motion::offline {

/// Position and its derivatives at one instant.
struct MotionState {
  double position_mm = 0.0;
  double velocity_mm_s = 0.0;
  double acceleration_mm_s2 = 0.0;
};

/// A motion in closed form; `at` must be continuous in position.
struct Profile {
  std::string name;
  double duration_s = 1.0;
  double max_speed_mm_s = 0.0;  ///< limits kept by the motion
  double max_acceleration_mm_s2 = 0.0;
  double max_jerk_mm_s3 = 0.0;
  std::function<MotionState(double)> at;
};

/// x = A·(1 − cos 2πft).
[[nodiscard]] Profile sine(double amplitude_mm, double frequency_hz, double duration_s);

/// A piece of constant jerk, {duration in s, jerk in mm/s³}; motion starts from standstill.
struct JerkPiece {
  double duration_s = 0.0;
  double jerk_mm_s3 = 0.0;
};
[[nodiscard]] Profile jerk_pieces(const std::string& name, const MotionState& start,
                                  const std::vector<JerkPiece>& pieces);

/// The pieces that change the speed by `change_mm_s` with the given limits.
[[nodiscard]] std::vector<JerkPiece> speed_change(double change_mm_s, double max_acceleration_mm_s2,
                                                  double max_jerk_mm_s3);

/// From rest to 20 mm/s, stop, back at 2 mm/s, stop (A = 200 mm/s², J = 5000 mm/s³), 0.1 s of rest
/// between.
[[nodiscard]] Profile s_curve();

/// The paper's flywheel (fig. 2): from v0 counts/tick at constant deceleration, counts of 0.001 mm,
/// ticks of 1 ms.
[[nodiscard]] Profile flywheel(double counts_per_tick, double counts_per_tick2);

[[nodiscard]] Profile constant_speed(double speed_mm_s, double duration_s);

/// Standstill on a line with a vibration of this amplitude.
[[nodiscard]] Profile dither(double amplitude_mm, double frequency_hz, double duration_s);

/// How the motion is recorded.
struct Recording {
  double count_mm = 0.001;
  double cycle_hz = 1000.0;
  double clock_s = 1e-7;            ///< period of the time stamps, which are truncated; 0 = exact
  double phase_error_counts = 0.0;  ///< amplitude of the error that repeats every four lines
  double line_error_counts = 0.0;   ///< RMS error of a single line
  double tick_jitter_s = 0.0;       ///< RMS of the cycle's start
  double lost_share = 0.0;          ///< edges that were not recorded
  std::uint64_t seed = 1;
};

/// One axis as recorded, and the truth at its ticks.
struct Record {
  std::string name;
  Recording how;
  double max_speed_mm_s = online::kNoBound;
  double max_acceleration_mm_s2 = online::kNoBound;
  double max_jerk_mm_s3 = online::kNoBound;
  std::vector<online::Edge> edges;  ///< positions are the nominal ones
  std::vector<online::Tick> ticks;
  std::vector<MotionState> truth;  ///< at the ticks; empty when unknown
  std::vector<double>
      line_error_mm;  ///< of the lines from `first_line` on: true − nominal position
  std::int64_t first_line = 0;
};

/// Records the motion. Deterministic in the seed.
[[nodiscard]] Record record(const Profile& profile, const Recording& how);

}  // namespace steadyrest::motion::offline
