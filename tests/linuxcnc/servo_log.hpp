// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace steadyrest::linuxcnc_test {

/// A servo cycle of the log that lag_log.hal writes.
struct ServoRow {
  double tick = 0.0;
  double speed_mm_s = 0.0;
  double ratio = 0.0;  ///< that the layer lets through
  double beat = 0.0;
  double alive = 0.0;
  double z_mm = 0.0;
};

/// Whole rows; a line that halsampler has cut off is left out.
inline std::vector<ServoRow> servo_log(const std::string& file) {
  std::ifstream in(file);
  std::vector<ServoRow> rows;
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    double number = 0.0;
    ServoRow row;
    if (words >> number >> row.tick >> row.speed_mm_s >> row.ratio >> row.beat >> row.alive >>
        row.z_mm) {
      rows.push_back(row);
    }
  }
  return rows;
}

}  // namespace steadyrest::linuxcnc_test
