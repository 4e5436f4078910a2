// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>

#include <Eigen/QR>

#include <steadyrest/motion/offline/log/recorded_axis.hpp>

// A servo axis recorded with a very fine encoder, used twice: divided by 64 it is the coarse
// encoder under test, whole it is the truth.
namespace steadyrest::motion::offline {
namespace {

namespace fs = std::filesystem;

// Division rounded down for negative counts as well.
std::int64_t coarse(std::int64_t fine, std::int64_t per_count) {
  return fine >= 0 ? fine / per_count : -((per_count - 1 - fine) / per_count);
}

/// Adds the edges between two rows.
/// The speed is assumed constant between two rows; a fine count is 1/64 of a coarse one, so the
/// instant is good to a fraction of a fine count. Fine count n covers n − ½ … n + ½.
void add_edges(const LogRow& from, const LogRow& to, const RecordedAxisConfig& config,
               std::vector<online::Edge>& out) {
  const std::int64_t first = coarse(from.count, config.fine_counts);
  const std::int64_t last = coarse(to.count, config.fine_counts);
  const bool up = last > first;
  const double rate = (to.t_s - from.t_s) / static_cast<double>(to.count - from.count);
  for (std::int64_t cell = first; cell != last; cell += up ? 1 : -1) {
    const std::int64_t line = up ? cell + 1 : cell;
    const double level = static_cast<double>(line * config.fine_counts) - 0.5;
    out.push_back({from.t_s + rate * (level - static_cast<double>(from.count)),
                   static_cast<double>(line) * config.count_mm, line,
                   static_cast<std::int8_t>(up ? 1 : -1), 0});
  }
}

/// The least-squares cubic through the rows around row i; fewer at the ends of the log.
/// Nine rows: long enough to average the fine count, short enough that a cubic follows the motion.
/// Scaled to the span and solved by QR: powers of seconds would lose the digits.
MotionState truth_at(const std::vector<LogRow>& rows, std::size_t i,
                     const RecordedAxisConfig& config) {
  const std::size_t begin = i - std::min(i, config.truth_samples);
  const std::size_t end = std::min(rows.size(), i + config.truth_samples + 1);
  const auto n = static_cast<Eigen::Index>(end - begin);
  const double span_s = std::max(1e-9, rows[end - 1].t_s - rows[begin].t_s);
  Eigen::MatrixXd powers(n, 4);
  Eigen::VectorXd counts(n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const LogRow& row = rows[begin + static_cast<std::size_t>(k)];
    const double u = (row.t_s - rows[i].t_s) / span_s;
    powers.row(k) << 1.0, u, u * u, u * u * u;
    counts(k) = static_cast<double>(row.count - rows[i].count);
  }
  const Eigen::VectorXd c = powers.colPivHouseholderQr().solve(counts);
  const double fine_mm = config.count_mm / config.fine_counts;
  return {(static_cast<double>(rows[i].count) + 0.5) * fine_mm, c(1) / span_s * fine_mm,
          2.0 * c(2) / (span_s * span_s) * fine_mm};
}

/// Which truths can be trusted. Where counts are missing the fit jumps: |a| beyond the axis'
/// ability marks such places and their neighbourhood.
std::vector<std::uint8_t> trusted(const Record& record, const RecordedAxisConfig& config) {
  const std::size_t n = record.ticks.size();
  std::vector<std::uint8_t> out(n, 1);
  std::fill_n(out.begin(), std::min(n, config.run_in), std::uint8_t{0});
  for (std::size_t i = 0; i < n; ++i) {
    const bool gap = i > 0 && record.ticks[i].t_s - record.ticks[i - 1].t_s > config.max_gap_s;
    if (gap || !(std::abs(record.truth[i].acceleration_mm_s2) <= config.glitch_mm_s2)) {
      const std::size_t begin = i - std::min(i, config.around);
      std::fill(out.begin() + static_cast<std::ptrdiff_t>(begin),
                out.begin() + static_cast<std::ptrdiff_t>(std::min(n, i + config.around + 1)),
                std::uint8_t{0});
    }
  }
  return out;
}

// For the shell: a path may have blanks and quotes.
std::string quoted(const std::string& path) {
  std::string out = "'";
  for (const char c : path) {
    out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  }
  return out + "'";
}

struct ClosePipe {
  void operator()(std::FILE* pipe) const noexcept { pclose(pipe); }
};

}  // namespace

// Ticks and truth for every row, edges only where the count moved without a gap.
RecordedAxis recorded_axis(const EdgeLog& log, const RecordedAxisConfig& config) {
  RecordedAxis out;
  Record& record = out.record;
  record.name = fs::path(log.file).stem().stem().string();
  record.how.count_mm = config.count_mm;
  record.how.cycle_hz = config.cycle_hz;
  record.how.clock_s = 0.0;
  std::uint8_t lost = 0;
  for (std::size_t i = 0; i < log.rows.size(); ++i) {
    const LogRow& row = log.rows[i];
    const std::size_t before = record.edges.size();
    if (i > 0 && row.count != log.rows[i - 1].count) {
      add_edges(log.rows[i - 1], row, config, record.edges);
    }
    if (i > 0 && row.t_s - log.rows[i - 1].t_s > config.max_gap_s) {
      // Edges across a gap are dropped and reported as lost with the next one.
      record.edges.resize(before);
      lost = 1;
    } else if (record.edges.size() > before) {
      record.edges[before].lost = lost;
      lost = 0;
    }
    const std::int64_t cell = coarse(row.count, config.fine_counts);
    const double low_mm = static_cast<double>(cell) * config.count_mm;
    record.ticks.push_back({row.t_s, cell, low_mm, low_mm + config.count_mm});
    record.truth.push_back(truth_at(log.rows, i, config));
  }
  out.scored = trusted(record, config);
  return out;
}

EdgeLogResult read_recorded(const fs::path& folder, std::string_view name) {
  EdgeLogConfig config;
  config.max_step = 0;
  config.rising_time = true;
  const fs::path plain = folder / (std::string(name) + ".csv");
  const fs::path packed = plain.string() + ".gz";
  if (!fs::exists(packed) || fs::exists(plain)) {
    return read_edge_log(plain.string(), config);
  }
  // Unpacked by the system's zcat: the logs are compressed, and another library for a test would
  // not pay.
  EdgeLogReader reader(packed.string(), config);
  const std::unique_ptr<std::FILE, ClosePipe> pipe(
      popen(("zcat -- " + quoted(packed.string())).c_str(), "r"));
  std::array<char, 65536> block{};
  std::size_t got = 1;
  while (pipe != nullptr && got > 0) {
    got = std::fread(block.data(), 1, block.size(), pipe.get());
    if (got > 0 && !reader.take({block.data(), got})) {
      break;
    }
  }
  return reader.finish();
}

}  // namespace steadyrest::motion::offline
