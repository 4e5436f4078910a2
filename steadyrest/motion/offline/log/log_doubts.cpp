// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstddef>

#include <fmt/core.h>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/motion/offline/log/log_doubts.hpp>

namespace steadyrest::motion::offline {
namespace {

using kernel::outcome::bad_input;
using kernel::outcome::Refusal;

constexpr double kOff = 0.1;         // of a cycle
constexpr double kGapCycles = 10.0;  // as online::CycleMonitor has it
constexpr double kLeastJump = 50.0;  // counts
constexpr double kUnsupported = 20.0;
constexpr double kLeastStep_s = 1e-9;  // rows of one stamp

double median_step_s(const EdgeLog& log) {
  std::vector<double> step_s;
  for (std::size_t i = 1; i < log.rows.size(); ++i) {
    step_s.push_back(log.rows[i].t_s - log.rows[i - 1].t_s);
  }
  const auto middle = step_s.begin() + static_cast<std::ptrdiff_t>(step_s.size() / 2);
  std::ranges::nth_element(step_s, middle);
  return *middle;
}

std::string apart(double median_s, double cycle_hz) {
  return fmt::format("rows are {:.6g} ms apart (median), but {:.6g} cycles a second are {:.6g} ms",
                     1e3 * median_s, cycle_hz, 1e3 / cycle_hz);
}

constexpr const char* kCheckCycle = "check --cycle-hz, and that t_s is in seconds";

double counts_s(const EdgeLog& log, std::size_t row) {
  const LogRow& from = log.rows[row - 1];
  const LogRow& to = log.rows[row];
  // As doubles: the difference of two counts may leave an integer.
  return (static_cast<double>(to.count) - static_cast<double>(from.count)) /
         std::max(to.t_s - from.t_s, kLeastStep_s);
}

/// Ratio of a step's speed to that of the step at `row`, if both go the same way.
double support(const EdgeLog& log, std::size_t row, double speed) {
  const double beside = row >= 1 && row < log.rows.size() ? counts_s(log, row) : 0.0;
  return std::max(0.0, speed > 0.0 ? beside : -beside);
}

}  // namespace

std::vector<Refusal> doubts(const EdgeLog& log, const LogClaims& claims) {
  std::vector<Refusal> out;
  if (log.rows.size() < 3) {
    return out;
  }
  const double median_s = median_step_s(log);
  if (claims.input == LogInput::ticks && std::abs(median_s * claims.cycle_hz - 1.0) > kOff) {
    out.push_back(bad_input(log.file, apart(median_s, claims.cycle_hz), kCheckCycle));
  }
  std::size_t jumps = 0;
  std::size_t largest = 0;
  const auto counts = [&log](std::size_t row) {
    return static_cast<double>(log.rows[row].count) - static_cast<double>(log.rows[row - 1].count);
  };
  for (std::size_t i = 1; i < log.rows.size() && std::isinf(claims.max_speed_counts_s); ++i) {
    const double speed = counts_s(log, i);
    if (std::abs(counts(i)) >= kLeastJump &&
        std::abs(speed) >=
            kUnsupported * std::max(support(log, i - 1, speed), support(log, i + 1, speed))) {
      largest = jumps++ == 0 || std::abs(counts(i)) > std::abs(counts(largest)) ? i : largest;
    }
  }
  if (jumps > 0) {
    out.push_back(bad_input(
        log.file,
        fmt::format(
            "the count jumps by {:.6g} in {:.6g} ms at t_s = {:.6g}, unlike the rows before "
            "and behind; {} such in {} rows",
            counts(largest), 1e3 * (log.rows[largest].t_s - log.rows[largest - 1].t_s),
            log.rows[largest].t_s, jumps, log.rows.size()),
        "check the encoder's cable and the recorder; --max-speed names the line of each jump"));
  }
  return out;
}

std::optional<Refusal> no_cycles(const EdgeLog& log, const LogClaims& claims) {
  if (claims.input == LogInput::edges || log.rows.size() < 2) {
    return std::nullopt;
  }
  const double median_s = median_step_s(log);
  if (median_s * claims.cycle_hz <= kGapCycles) {
    return std::nullopt;
  }
  return bad_input(log.file, apart(median_s, claims.cycle_hz) + ": nothing can be estimated",
                   kCheckCycle);
}

}  // namespace steadyrest::motion::offline
