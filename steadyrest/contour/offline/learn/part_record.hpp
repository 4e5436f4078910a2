// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/kernel/signal/path.hpp>

namespace steadyrest::contour::offline {

/// What a control did while it cut one part: commanded positions and those by the encoders, in
/// machine coordinates.
struct PartRecord {
  std::string file;
  std::vector<double> time_s;  ///< rising
  std::vector<kernel::signal::Point> command_mm;
  std::vector<kernel::signal::Point> actual_mm;
  double period_s = 0.0;  ///< median step of the time

  [[nodiscard]] std::size_t size() const noexcept { return time_s.size(); }
};

/// Reads a table (room `table`) with the columns `t_s`, `x_cmd_mm`, `y_cmd_mm`, `z_cmd_mm`,
/// `x_act_mm`, `y_act_mm`, `z_act_mm`; other columns are ignored. The time may also be stamps.
///
/// Refused: a file that cannot be read, a column that is missing or there twice, a field that is no
/// finite number, a time that does not rise, fewer than 100 rows.
/// The file may be packed with gzip.
[[nodiscard]] kernel::outcome::Result<PartRecord> read_part_record(const std::string& file);
[[nodiscard]] kernel::outcome::Result<PartRecord> parse_part_record(std::string_view text,
                                                                    const std::string& file);

}  // namespace steadyrest::contour::offline
