// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/motion/offline/log/edge_log.hpp>

namespace steadyrest::motion::offline {

enum class LogInput {
  edges,  ///< every row is one edge: the count after it, with the time of the edge
  ticks,  ///< every row is one control cycle: the count it saw
};

/// The refusal of a log that is clearly of the other kind; none where the rows are inconclusive or
/// fewer than 20.
///
/// A log of ticks given as edges has evenly spaced rows (nine steps in ten within a tenth of their
/// median P), more than one in fifty of which is not a step by one count, and either rows that keep
/// the count, which no edge does; or nine stamps in ten at multiples of P; or counts rounded at the
/// rows' times: |Δc − v·Δt| above 0.35 RMS, v the mean speed of the steps before and after. A
/// recorder that keeps one latched edge per cycle has Δt proportional to Δc and is not such a log.
///
/// A log of edges given as ticks steps by one count in nine rows of ten, and less than half of the
/// steps are within a tenth of the cycle.
[[nodiscard]] std::optional<kernel::outcome::Refusal> other_kind(const EdgeLog& log, LogInput input,
                                                                 double cycle_hz);

}  // namespace steadyrest::motion::offline
