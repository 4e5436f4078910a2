// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <fmt/core.h>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/motion/offline/log/log_record.hpp>

// A log has rows; an estimator needs edges and ticks. Ticks are made from edges, but edges never
// from ticks: nothing that the recorder did not see is invented.
namespace steadyrest::motion::offline {
namespace {

using kernel::outcome::bad_input;
using kernel::outcome::Refusal;

constexpr double kTickTolerance = 1e-6;  // of a cycle: the rounding of t·f

std::optional<Refusal> outside(const char* what, double value, bool zero_allowed) {
  if (std::isfinite(value) && (value > 0.0 || (zero_allowed && value == 0.0))) {
    return std::nullopt;
  }
  return bad_input(fmt::format("{} = {:.10g}; allowed: a finite number {} 0", what, value,
                               zero_allowed ? "from" : "above"),
                   "give a value in that range");
}

std::optional<Refusal> unfit(const LogRecordConfig& config) {
  if (auto refusal = outside("count in mm", config.count_mm, false)) {
    return refusal;
  }
  if (auto refusal = outside("control cycle in Hz", config.cycle_hz, false)) {
    return refusal;
  }
  return outside("period of the time stamps in s", config.clock_s.value_or(0.0), true);
}

online::Tick tick_in(double t_s, std::int64_t count, double count_mm) {
  const auto cell = static_cast<double>(count);
  return {t_s, count, cell * count_mm, (cell + 1.0) * count_mm};
}

/// The passage from one cell to another, seen as its last edge.
online::Edge edge_to(const LogRow& row, std::int64_t from, double count_mm) {
  const bool up = row.count > from;
  // Line k is the border between cells k − 1 and k.
  const std::int64_t line = up ? row.count : row.count + 1;
  const std::int64_t lost = std::abs(row.count - from) - 1;
  return {row.t_s, static_cast<double>(line) * count_mm, line,
          static_cast<std::int8_t>(up ? 1 : -1),
          static_cast<std::uint8_t>(std::min<std::int64_t>(lost, 255))};
}

// The first row only tells which cell the axis is in.
void add_edges(const EdgeLog& log, double count_mm, Record& out) {
  out.edges.reserve(log.rows.size());
  std::int64_t cell = log.rows.front().count;
  for (const LogRow& row : log.rows) {
    if (row.count != cell) {
      out.edges.push_back(edge_to(row, cell, count_mm));
      cell = row.count;
    }
  }
}

// One wrong stamp can make years of cycles; the refusal names the row with the longest step.
std::optional<Refusal> add_cycles(const EdgeLog& log, const LogRecordConfig& config, Record& out) {
  const double first = std::ceil(log.rows.front().t_s * config.cycle_hz - kTickTolerance);
  const double last = std::floor(log.rows.back().t_s * config.cycle_hz + kTickTolerance);
  const double allowed = std::min(static_cast<double>(config.max_ticks),
                                  kFreeTicks + kTicksPerRow * static_cast<double>(log.rows.size()));
  if (!(last - first < allowed)) {
    return bad_input(
        log.file, log.longest_step_line,
        fmt::format("{} rows span {:.6g} s, or {:.3g} control cycles; allowed: {:.3g}. "
                    "Time advances by {:.6g} s before this row",
                    log.rows.size(), log.rows.back().t_s - log.rows.front().t_s, last - first,
                    allowed, log.longest_step_s),
        "look for a wrong time stamp, or split the log");
  }
  if (last < first) {
    return std::nullopt;
  }
  out.ticks.reserve(static_cast<std::size_t>(last - first) + 1);
  std::size_t at = 0;
  for (double k = first; k <= last; k += 1.0) {
    const double t_s = k / config.cycle_hz;
    while (at + 1 < log.rows.size() && log.rows[at + 1].t_s <= t_s) {
      ++at;
    }
    // The count at a tick is that of the last edge before it.
    out.ticks.push_back(tick_in(t_s, log.rows[at].count, config.count_mm));
  }
  return std::nullopt;
}

}  // namespace

// The kind of log is checked first.
kernel::outcome::Result<Record> record_of(const EdgeLog& log, const LogRecordConfig& config) {
  if (auto refusal = unfit(config)) {
    return std::unexpected(std::move(*refusal));
  }
  Record out;
  out.name = log.file;
  out.how.count_mm = config.count_mm;
  out.how.cycle_hz = config.cycle_hz;
  // In a short log all stamps may happen to be round numbers; no clock is slower than the cycle.
  out.how.clock_s =
      config.clock_s ? *config.clock_s : std::min(clock_of(log), 1.0 / config.cycle_hz);
  if (log.rows.empty()) {
    return out;
  }
  if (auto refusal = other_kind(log, config.input, config.cycle_hz)) {
    return std::unexpected(std::move(*refusal));
  }
  if (config.input == LogInput::edges) {
    add_edges(log, config.count_mm, out);
    if (auto refusal = add_cycles(log, config, out)) {
      return std::unexpected(std::move(*refusal));
    }
    return out;
  }
  out.ticks.reserve(log.rows.size());
  for (const LogRow& row : log.rows) {
    out.ticks.push_back(tick_in(row.t_s, row.count, config.count_mm));
  }
  return out;
}

}  // namespace steadyrest::motion::offline
