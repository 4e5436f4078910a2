// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/motion/offline/test/scenes.hpp>
#include <steadyrest/motion/online/bounded/motion_estimator.hpp>
#include <steadyrest/motion/online/line/line_table.hpp>

/// A table of lines that learns from recordings.
namespace steadyrest::motion::offline::test {

using online::LineTable;

// 5 % of a count in four phases and 2 % RMS at random; 8 s at 2 Hz pass each line 32 times.
inline const Record& long_sine() {
  static const Record record = offline::record(sine(1.0, 2.0, 8.0), line_errors());
  return record;
}
inline const Record& long_sine_ideal() {
  static const Record record = offline::record(sine(1.0, 2.0, 8.0), {});
  return record;
}

inline LineTable table_of(std::int64_t first, std::size_t lines, bool periodic = false) {
  return LineTable::make({.first_line = first, .lines = lines, .periodic = periodic}).value();
}

inline void learn(LineTable& table, const Record& record, int passes) {
  for (int i = 0; i < passes; ++i) {
    bool first = true;
    for (const Edge& edge : record.edges) {
      table.learn(edge.t_s, edge.line, edge.direction, first || edge.lost != 0);
      first = false;
    }
  }
}

}  // namespace steadyrest::motion::offline::test
