// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>

#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/motion/offline/log/edge_log.hpp>
#include <steadyrest/motion/offline/log/log_kind.hpp>
#include <steadyrest/motion/offline/scene/scene.hpp>

/// Converts a log into an estimator's input.
namespace steadyrest::motion::offline {

struct LogRecordConfig {
  LogInput input = LogInput::edges;
  double count_mm = 0.001;
  double cycle_hz = 1000.0;       ///< of the ticks; with `ticks` the nominal one
  std::optional<double> clock_s;  ///< period of the time stamps, 0 = exact; none: found in the log,
                                  ///< at most the cycle
  std::size_t max_ticks = 100'000'000;
};

/// Cycles that edges may span: this many, and some more for each row.
inline constexpr double kFreeTicks = 1e6;
inline constexpr double kTicksPerRow = 1000.0;

/// `edges`: the first row only tells the cell in which the axis is. From c to c' > c the last line
/// passed is c', upwards; to c' < c it is c' + 1, downwards; |c' − c| − 1 edges before it are lost.
/// A row that does not change the count only tells that the axis was there. Ticks are at integer
/// multiples of 1/cycle_hz from the first row to the last; a row at exactly the time of a tick
/// comes before it.
///
/// `ticks`: no edges; a tick for each row at its own time.
///
/// Refused: count_mm or cycle_hz not finite and positive, clock_s negative, a log of the other kind
/// (other_kind), edges that span more cycles than their number warrants (a wrong time stamp), more
/// than max_ticks.
[[nodiscard]] kernel::outcome::Result<Record> record_of(const EdgeLog& log,
                                                        const LogRecordConfig& config);

}  // namespace steadyrest::motion::offline
