// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <fmt/core.h>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/motion/offline/scene/line_calibration.hpp>

// Several passes over one record: the table forgets, so each pass refines what the previous one
// learnt.
namespace steadyrest::motion::offline {
namespace {

using kernel::outcome::refuse;
using online::LineFit;
using online::LineTable;

constexpr std::uint32_t kMaxPasses = 1000;

// One revolution, the requested range, or the lines that the record passed.
kernel::outcome::Result<LineTable> table_for(const Record& record,
                                             const LineCalibrationConfig& config) {
  LineTable::Config out = config.learning;
  out.count_mm = record.how.count_mm;
  if (config.counts_per_rev > 0) {
    out.first_line = 0;
    out.lines = config.counts_per_rev;
    out.periodic = true;
    return LineTable::make(out);
  }
  const auto [low, high] = std::ranges::minmax_element(record.edges, {}, &online::Edge::line);
  const LineRange range = config.range.value_or(LineRange{low->line, high->line});
  // Unsigned: the two ends may lie farther apart than a signed number reaches.
  const std::uint64_t more =
      static_cast<std::uint64_t>(range.last) - static_cast<std::uint64_t>(range.first);
  if (range.last < range.first || more >= LineTable::kMaxLines) {
    return refuse(fmt::format("the table would go from line {} to line {}; allowed: 1 … {} lines",
                              range.first, range.last, LineTable::kMaxLines),
                  "give a range A:B of lines with A ≤ B, or the counts of one revolution");
  }
  out.first_line = range.first;
  out.lines = static_cast<std::size_t>(more) + 1;
  return LineTable::make(out);
}

/// RMS deviation of the lines from smooth motion. Before and after by the same measure, on the fits
/// from which the table learns.
double residual_mm(const Record& record, const LineTable& table) {
  LineFit fit(table.config().max_span_s);
  const double worst = table.config().max_rms_counts * record.how.count_mm;
  double sum2 = 0.0;
  double n = 0.0;
  for (const online::Edge& edge : record.edges) {
    if (fit.breaks(edge.t_s, edge.line, edge.direction, edge.lost != 0)) {
      fit.clear();
    }
    const auto r = fit.push(edge.t_s, table.position_mm(edge.line), edge.line, edge.direction);
    if (r.valid && r.rms_mm <= worst) {
      sum2 += r.error_mm * r.error_mm;
      n += 1.0;
    }
  }
  return n > 0.0 ? std::sqrt(sum2 / n) : 0.0;
}

std::size_t lines_learnt(const LineTable& table) {
  std::size_t out = 0;
  for (std::size_t i = 0; i < table.config().lines; ++i) {
    out += table.learnt(table.config().first_line + static_cast<std::int64_t>(i)) ? 1U : 0U;
  }
  return out;
}

}  // namespace

kernel::outcome::Result<LineCalibration> calibrate_lines(const Record& record,
                                                         const LineCalibrationConfig& config) {
  if (record.edges.empty()) {
    return refuse("the record has no edge", "record the axis while it moves");
  }
  if (config.passes < 1 || config.passes > kMaxPasses) {
    return refuse(fmt::format("passes = {}; allowed: 1 … {}", config.passes, kMaxPasses),
                  "give a value in that range");
  }
  auto table = table_for(record, config);
  if (!table) {
    return std::unexpected(table.error());
  }
  const double before = residual_mm(record, *table);
  // Passes are not joined: the record's end and start are not neighbours.
  for (std::uint32_t pass = 0; pass < config.passes; ++pass) {
    bool first = true;  // nothing precedes it, however the previous pass ended
    for (const online::Edge& edge : record.edges) {
      table->learn(edge.t_s, edge.line, edge.direction, first || edge.lost != 0);
      first = false;
    }
  }
  // The common error of all lines of a phase belongs to the phase; see LineTable.
  table->settle();
  const double after = residual_mm(record, *table);
  const std::size_t learnt = lines_learnt(*table);
  return LineCalibration{std::move(*table), record.edges.size(), learnt, before, after};
}

// The ticks' cells end at the same lines as the edges.
void apply_lines(const LineTable& table, Record& record) noexcept {
  for (online::Edge& edge : record.edges) {
    edge.position_mm = table.position_mm(edge.line);
    edge.sigma_mm = table.sigma_mm(edge.line);
  }
  for (online::Tick& tick : record.ticks) {
    tick.low_mm = table.position_mm(tick.count);
    tick.high_mm = table.position_mm(tick.count + 1);
  }
}

}  // namespace steadyrest::motion::offline
