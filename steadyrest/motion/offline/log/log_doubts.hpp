// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <optional>
#include <vector>

#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/motion/offline/log/edge_log.hpp>
#include <steadyrest/motion/offline/log/log_kind.hpp>

/// Checks a log against its description: estimates from a wrong cycle, or across a jump of the
/// count, look sensible but are wrong.
namespace steadyrest::motion::offline {

struct LogClaims {
  LogInput input = LogInput::edges;
  double cycle_hz = 1000.0;
  double max_speed_counts_s = std::numeric_limits<double>::infinity();
};

/// Warnings, with numbers and what to check:
/// - `ticks` whose rows are not a cycle apart: the median step is off by more than a tenth;
/// - a step of the count that its neighbours contradict: 50 counts or more, and 20 times as fast as
///   the steps before and after it, as far as they go the same way. No axis starts and stops within
///   a step. With a largest speed the reader checks this instead.
[[nodiscard]] std::vector<kernel::outcome::Refusal> doubts(const EdgeLog& log,
                                                           const LogClaims& claims);

/// A log of `ticks` in which no estimate can build on the previous row: the median step exceeds ten
/// cycles.
[[nodiscard]] std::optional<kernel::outcome::Refusal> no_cycles(const EdgeLog& log,
                                                                const LogClaims& claims);

}  // namespace steadyrest::motion::offline
