// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include <steadyrest/motion/online/line/stored_lines.hpp>

namespace steadyrest::motion::online {
namespace {

constexpr double kLeastStored = 1e-5;  ///< counts; the machine file rounds to it

}  // namespace

kernel::outcome::Result<LineTable> stored_lines(const kernel::machine::Encoder& encoder) {
  auto table = LineTable::make({.count_mm = encoder.count_au,
                                .first_line = encoder.line_table_first,
                                .lines = encoder.line_table_au.size(),
                                .periodic = encoder.line_table_periodic,
                                .learn = 0.0});
  if (table) {
    std::array<double, 4> phase_mm{};
    std::copy_n(encoder.phase_error_au.begin(),
                std::min<std::size_t>(encoder.phase_error_au.size(), 4), phase_mm.begin());
    table->restore(phase_mm, encoder.line_table_au);
  }
  return table;
}

void store_lines(const LineTable& table, kernel::machine::Encoder& encoder) {
  encoder.count_au = table.config().count_mm;
  encoder.line_table_first = table.config().first_line;
  encoder.line_table_periodic = table.config().periodic;
  encoder.phase_error_au.assign(table.phase_mm().begin(), table.phase_mm().end());
  encoder.line_table_au = table.error_mm();
  std::int64_t line = table.config().first_line;
  for (double& error_mm : encoder.line_table_au) {
    if (table.learnt(line++) && std::abs(error_mm) < kLeastStored * encoder.count_au) {
      error_mm = kLeastStored * encoder.count_au;  // 0 would mean "not known"
    }
  }
  if (!table.in_use()) {  // it would contain no more than the fits' errors
    std::ranges::fill(encoder.phase_error_au, 0.0);
    std::ranges::fill(encoder.line_table_au, 0.0);
  }
}

}  // namespace steadyrest::motion::online
