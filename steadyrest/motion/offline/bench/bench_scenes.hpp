// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/motion/offline/bench/estimator_choice.hpp>
#include <steadyrest/motion/offline/scene/scene.hpp>

/// The scenes of the benchmark: count 0.001 mm, 1 kHz, stamps of 100 ns unless said.
namespace steadyrest::motion::offline {

/// A motion recorded once or several times, and the known limits of the axis.
struct BenchScene {
  std::string name;
  std::vector<Record> records;
  std::vector<std::vector<std::uint8_t>> scored;  ///< for each record: ≠ 0 for the ticks that count
  EstimatorSetup setup;  ///< including limits and largest line error where known
  bool limits_known = true;
  bool ideal_edges = true;                         ///< the lines are where they should be
  double target_velocity_mm_s = online::kNoBound;  ///< RMS for `kalman`; infinite = none
  double target_acceleration_mm_s2 = online::kNoBound;
  bool has_peer = false;  ///< LinuxCNC's encoder also runs on it
};

struct SceneChoice {
  std::string name;    ///< `clock-10ns`
  std::string family;  ///< `clock`: a user may name either
  std::string what;    ///< one sentence
  std::function<kernel::outcome::Result<BenchScene>()> make;
};

struct SceneConfig {
  std::filesystem::path recorded_folder;  ///< empty: without the recorded logs
  int phases = 6;                         ///< starts within a count for `s-curve`
};

/// In the order of the table.
[[nodiscard]] std::vector<SceneChoice> bench_scenes(const SceneConfig& config);

/// A motion at constant speed as recorded for the benchmark; longer at low speed.
[[nodiscard]] BenchScene cruise(double speed_mm_s, const Recording& how, double max_jerk_mm_s3);

}  // namespace steadyrest::motion::offline
