// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/motion/offline/bench/bench_scenes.hpp>
#include <steadyrest/motion/offline/scene/error_curve.hpp>

/// All estimators on all scenes, in one table.
namespace steadyrest::motion::offline {

/// Name of LinuxCNC's row among the estimators.
inline constexpr std::string_view kPeerName = "linuxcnc-encoder";

struct BenchConfig {
  std::vector<std::string> scenes;      ///< names or families; empty = all
  std::vector<std::string> estimators;  ///< empty = all
  std::filesystem::path recorded_folder;
  std::filesystem::path peer;  ///< the program that runs LinuxCNC's encoder; empty = left out
  int phases = 6;
  int repetitions = 3;  ///< of the time measurement
};

/// An estimator on a scene. Efficiency: RMS of the Landau–Kolmogorov bound at |v| > 1 mm/s ÷ RMS of
/// the bound given there; 1 = cannot be improved.
struct BenchRow {
  std::string scene;
  std::string estimator;
  bool limits = false;  ///< it knows the limits of the axis
  std::size_t ticks = 0;
  ErrorFigures velocity;       ///< mm/s
  ErrorFigures acceleration;   ///< mm/s²; NaN where the estimator gives none
  double velocity_gain = 0.0;  ///< RMS of the backward difference ÷ this RMS; NaN = not run
  double acceleration_gain = 0.0;
  double velocity_efficiency = 0.0;  ///< NaN without bounds or with line errors
  double acceleration_efficiency = 0.0;
  std::uint64_t contradictions = 0;  ///< ticks at which the limits did not explain the record
  double ns_per_tick = 0.0;          ///< median, on this machine; NaN = not measured
  double ns_per_edge = 0.0;
  double target_velocity_mm_s = online::kNoBound;  ///< infinite = none
  double target_acceleration_mm_s2 = online::kNoBound;
};

struct Benchmark {
  struct Scene {
    std::string name;
    std::string what;  ///< one sentence
  };
  std::vector<Scene> scenes;
  std::vector<BenchRow> rows;
  std::vector<std::string> notes;  ///< what was left out, and why
};

/// Called now and then with the share done and the current activity.
using BenchProgress = std::function<void(double share, std::string_view what)>;

/// Refused: unknown scenes or estimators, phases or repetitions below 1, a folder without the logs.
[[nodiscard]] kernel::outcome::Result<Benchmark> run_benchmark(const BenchConfig& config,
                                                               const BenchProgress& progress = {});

/// A row of CSV for each row, column names first. Unknown values are `nan`, missing bounds `inf`.
[[nodiscard]] std::string to_csv(const Benchmark& benchmark);

}  // namespace steadyrest::motion::offline
