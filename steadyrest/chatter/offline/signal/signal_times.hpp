// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <steadyrest/chatter/offline/signal/signal_parts.hpp>

/// Times of samples at an even rate, of which some may be missing.
///
/// Each step is one step of the clock within 25 %, or k of them within the same and k steps ≤ 1 s:
/// then k − 1 samples are missing. The clock's step is the mean of the single steps, which the
/// stamps' rounding moves least. At most half of the samples may be missing.
namespace steadyrest::chatter::offline {

struct EvenTimes {
  double start_s = 0.0;
  double rate_hz = 0.0;
  std::size_t samples = 0;
  std::vector<std::size_t> place;  ///< of each row among the samples; empty: none is missing
  std::vector<std::string> notes;
};

/// `lines` are the rows', `name` the column's, `row` in refusals. Refused: fewer than two rows,
/// other steps, and a rate outside 1 kHz … 1 MHz.
[[nodiscard]] OrFault<EvenTimes> even_times(const std::vector<double>& time_s,
                                            const std::vector<std::size_t>& lines,
                                            std::string_view name);

/// Puts NaN where samples are missing.
void spread(const EvenTimes& times, std::vector<double>& values);

}  // namespace steadyrest::chatter::offline
