// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <steadyrest/kernel/units/convert.hpp>
#include <steadyrest/thermal/offline/log/lagged.hpp>
#include <steadyrest/thermal/offline/log/level_table.hpp>

// The columns of the fit are the law's own responses: to a unit level of a power of the speed, to a
// unit state, to a temperature. walk() visits every row of the log, whichever rows are read, and
// restarts after each gap.
namespace steadyrest::thermal::offline {
namespace {

/// A log's steps usually have one period: keeps the exponential.
class Decay {
 public:
  double operator()(double elapsed_s, double tau_s) {
    if (elapsed_s != elapsed_s_ || tau_s != tau_s_) {
      elapsed_s_ = elapsed_s;
      tau_s_ = tau_s;
      factor_ = tau_s > 0.0 ? std::exp(-elapsed_s / tau_s) : 0.0;
    }
    return factor_;
  }

 private:
  double elapsed_s_ = -1.0;
  double tau_s_ = -1.0;
  double factor_ = 1.0;
};

/// Walks over the log; `step(row)` comes before the contents of row `row` are taken, for row ≥ 1.
template <class Start, class Step, class Value>
Eigen::VectorXd walk(const Log& log, std::span<const std::size_t> rows, Start start, Step step,
                     Value value) {
  Eigen::VectorXd out(static_cast<Eigen::Index>(rows.size()));
  Eigen::Index taken = 0;
  auto gap = log.gap.begin();
  for (std::size_t row = 0; row < log.rows() && taken < out.size(); ++row) {
    if (row == 0 || (gap != log.gap.end() && *gap == row)) {
      gap += row == 0 ? 0 : 1;
      start(row);
    } else {
      step(row);
    }
    if (rows[static_cast<std::size_t>(taken)] == row) {
      out(taken++) = value();
    }
  }
  return out;
}

/// x' = (level(n) − x)/τ, n in rev/s.
template <class Level>
Eigen::VectorXd lagged_level(const Log& log, std::span<const std::size_t> rows, Level level_of,
                             double tau_s, double rest_tau_s) {
  double x = 0.0;
  double speed = -1.0;
  double level = 0.0;
  Decay turning;
  Decay standing;
  return walk(
      log, rows, [&](std::size_t) { x = 0.0; },
      [&](std::size_t row) {
        // A row's speed applies until the next row, as in the controller's frames.
        const double n = log.speed_rev_s[row - 1];
        // Test speeds are constant for hours, so a power or a table need not be computed for each
        // row.
        if (n != speed) {
          speed = n;
          level = level_of(n);
        }
        const double elapsed_s = log.time_s[row] - log.time_s[row - 1];
        const double keep = n == 0.0 && rest_tau_s > 0.0 ? standing(elapsed_s, rest_tau_s)
                                                         : turning(elapsed_s, tau_s);
        x = level + (x - level) * keep;
      },
      [&] { return x; });
}

}  // namespace

Eigen::VectorXd lagged_power(const Log& log, std::span<const std::size_t> rows, double power,
                             double tau_s, double rest_tau_s) {
  return lagged_level(
      log, rows, [power](double n) { return std::pow(n * kPer_rev_s, power); }, tau_s, rest_tau_s);
}

Eigen::VectorXd lagged_share(const Log& log, std::span<const std::size_t> rows,
                             std::span<const double> table_rev_s, std::size_t k, double tau_s,
                             double rest_tau_s) {
  return lagged_level(
      log, rows, [=](double n) { return table_share(table_rev_s, k, n); }, tau_s, rest_tau_s);
}

Eigen::VectorXd lagged_temperature(const Log& log, std::span<const std::size_t> rows,
                                   const LogChannel& channel, double tau_s) {
  // Before its first reading a sensor is assumed to have shown that reading.
  const auto first = std::ranges::find_if(channel.value, [](double v) { return std::isfinite(v); });
  double input = first != channel.value.end() ? *first : 0.0;
  double lagged = input;
  Decay decay;
  const auto take = [&](std::size_t row) {
    input = std::isfinite(channel.value[row]) ? channel.value[row] : input;
  };
  return walk(
      log, rows,
      [&](std::size_t row) {
        take(row);
        lagged = input;
      },
      [&](std::size_t row) {
        // The old reading acts up to this row; the new one from here on.
        lagged = input + (lagged - input) * decay(log.time_s[row] - log.time_s[row - 1], tau_s);
        take(row);
      },
      [&] { return lagged; });
}

Eigen::VectorXd fading(const Log& log, std::span<const std::size_t> rows, std::size_t start,
                       double tau_s, double rest_tau_s) {
  // The free decay of a state of 1 at `start`, and nothing in other stretches.
  double x = 0.0;
  Decay turning;
  Decay standing;
  return walk(
      log, rows, [&](std::size_t row) { x = row == start ? 1.0 : 0.0; },
      [&](std::size_t row) {
        const double elapsed_s = log.time_s[row] - log.time_s[row - 1];
        x *= log.speed_rev_s[row - 1] == 0.0 && rest_tau_s > 0.0 ? standing(elapsed_s, rest_tau_s)
                                                                 : turning(elapsed_s, tau_s);
      },
      [&] { return x; });
}

std::vector<std::size_t> stretches(const Log& log) {
  std::vector<std::size_t> out = {0};
  out.insert(out.end(), log.gap.begin(), log.gap.end());
  return out;
}

}  // namespace steadyrest::thermal::offline
