// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/motion/offline/log/edge_log.hpp>

namespace steadyrest::motion::offline {

enum class LogInput {
  edges,  ///< every row is one edge: the count after it, with the time of the edge
  ticks,  ///< every row is one control cycle: the count that it saw
};

/// The refusal of a log that is plainly of the other kind; none where the rows do not tell, or are
/// fewer than 20.
///
/// Given as edges, a log of ticks has rows evenly apart (nine steps of ten within a tenth of their
/// median P) of which more than one in fifty is no step by one count, and either rows that keep the
/// count, which no edge does; or nine stamps of ten at multiples of P; or counts that were rounded
/// at the rows' times: |Δc − v·Δt| above 0.35 RMS, v the mean speed of the steps before and behind.
/// A recorder that keeps one latched edge of each cycle has Δt in proportion to Δc, and is none.
///
/// Given as ticks, a log of edges steps by one count in nine rows of ten, and less than half of the
/// steps are within a tenth of the cycle.
[[nodiscard]] std::optional<kernel::outcome::Refusal> other_kind(const EdgeLog& log, LogInput input,
                                                                 double cycle_hz);

}  // namespace steadyrest::motion::offline
