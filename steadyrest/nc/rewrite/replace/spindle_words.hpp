// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/nc/interpret/state/config.hpp>
#include <steadyrest/nc/rewrite/replace/replace.hpp>

namespace steadyrest::nc::rewrite {

/// A line with a word whose value may change.
struct ValueLine {
  std::uint32_t line = 0;
  double value = 0.0;  ///< as written
};

/// What a program does from one S word to the next.
struct SpindleSpan {
  ValueLine speed;              ///< line 0: before the first S word
  std::string stays;            ///< why S must stay as it is; empty: it may change
  bool surface_speed = false;   ///< it cuts under G96: the speed follows the radius
  std::int64_t tool = 0;        ///< in the spindle at the first cut
  std::uint32_t first_cut = 0;  ///< line; 0: it does not cut
  std::uint32_t last_cut = 0;
  double most_feed_mm_s = 0.0;   ///< of its feeds per minute
  std::vector<ValueLine> feeds;  ///< its F words, in G94
  double carried_feed = 0.0;     ///< F of an earlier span that its first cut uses; 0: none
  bool line_fixed = false;       ///< not even an F can be added to the line of its S word
};

/// Runs the program once. Refuses what the interpreter refuses.
[[nodiscard]] kernel::outcome::Result<std::vector<SpindleSpan>> spindle_spans(
    const std::string& program, const interpret::Config& config);

/// Undoes the changes that would leave their F to a span that cannot have another: such a span gets
/// ratio 1, and `stays` says why. `ratio`: of S, by span.
void keep_carried_feeds(std::vector<SpindleSpan>& spans, std::vector<double>& ratio);

/// The lines with S and F multiplied by the ratio of their span; a feed per revolution stays.
[[nodiscard]] kernel::outcome::Result<NewLines> speed_lines(const std::string& program,
                                                            read::Dialect dialect,
                                                            const std::vector<SpindleSpan>& spans,
                                                            const std::vector<double>& ratio);

}  // namespace steadyrest::nc::rewrite
