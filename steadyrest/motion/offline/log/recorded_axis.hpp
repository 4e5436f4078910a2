// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/motion/offline/log/edge_log.hpp>
#include <steadyrest/motion/offline/scene/scene.hpp>

/// A finely counted log as the truth behind a coarse encoder.
namespace steadyrest::motion::offline {

struct RecordedAxis {
  Record record;
  std::vector<std::uint8_t> scored;  ///< ≠ 0: the truth at this tick can be trusted
};

struct RecordedAxisConfig {
  int fine_counts = 64;           ///< to one coarse count
  double count_mm = 0.001;        ///< assumed length of the coarse count
  double cycle_hz = 1000.0;       ///< nominal
  double max_gap_s = 0.05;        ///< longer: no edges in between, the next one reports the loss
  double glitch_mm_s2 = 500.0;    ///< more acceleration is a counter error
  std::size_t around = 15;        ///< samples on both sides of an error that are not scored
  std::size_t run_in = 20;        ///< samples at the start that are not scored
  std::size_t truth_samples = 4;  ///< on both sides, through which the truth is fitted
};

/// Each row is a tick. The fine count c represents its middle, c + ½; edges of the coarse encoder
/// lie where the straight line between two rows passes a multiple of `fine_counts`. Truth: velocity
/// and acceleration of the least-squares cubic through the fine counts around the tick (not
/// causal).
[[nodiscard]] RecordedAxis recorded_axis(const EdgeLog& log, const RecordedAxisConfig& config = {});

/// Reads FOLDER/NAME.csv, or FOLDER/NAME.csv.gz through zcat.
[[nodiscard]] EdgeLogResult read_recorded(const std::filesystem::path& folder,
                                          std::string_view name);

}  // namespace steadyrest::motion::offline
