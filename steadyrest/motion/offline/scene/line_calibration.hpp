// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/motion/offline/scene/scene.hpp>
#include <steadyrest/motion/online/line/line_table.hpp>

/// Learns the encoder's lines from a record, and corrects the lines of a record.
namespace steadyrest::motion::offline {

struct LineRange {
  std::int64_t first = 0;
  std::int64_t last = 0;  ///< included
};

struct LineCalibrationConfig {
  std::uint32_t passes = 8;                       ///< over the whole record, 1 … 1000
  std::uint32_t counts_per_rev = 0;               ///< rotary: the table repeats; 0 = a scale
  std::optional<LineRange> range = std::nullopt;  ///< of a scale; none: all lines passed
  online::LineTable::Config learning{};           ///< count, range and period are filled in
};

struct LineCalibration {
  online::LineTable table;
  std::size_t edges = 0;
  std::size_t lines_learnt = 0;
  double residual_before_mm =
      0.0;  ///< RMS distance of a line from the cubic through its neighbours
  double residual_after_mm = 0.0;
};

/// Refused: a record without edges, a range that is empty or has more than LineTable::kMaxLines
/// lines, a revolution that is not a multiple of four counts, passes out of range.
[[nodiscard]] kernel::outcome::Result<LineCalibration> calibrate_lines(
    const Record& record, const LineCalibrationConfig& config);

/// Moves the lines of edges and ticks to the table's positions.
void apply_lines(const online::LineTable& table, Record& record) noexcept;

}  // namespace steadyrest::motion::offline
