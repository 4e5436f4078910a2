// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <steadyrest/apps/cli/shared/session.hpp>
#include <steadyrest/contour/offline/causes/causes.hpp>
#include <steadyrest/trial/cut/report_data.hpp>

/// What `cut` leads with: the best of the ways, and how to get it.
namespace steadyrest::apps::cli::cut {

/// In the program's own time, with 2 % to spare, and in any: the least time over the limit, then
/// the smallest RMS error, or the shortest cycle. A setting is apart: it changes the machine.
[[nodiscard]] trial::cut::BestWays best_of(const std::vector<trial::cut::WayFigures>& ways);

/// The keys `best` and `over_limit`; returns the lead of the answer for people.
[[nodiscard]] std::string put_best(Answer& answer, const trial::cut::BestWays& best,
                                   const trial::cut::Figures& now, double limit_mm);
/// What stays over the limit in the best way; returns its text.
[[nodiscard]] std::string put_over(Answer& answer,
                                   const std::vector<trial::cut::OverLimitLine>& over);

/// For report and answer: with the cure's price in words.
[[nodiscard]] trial::cut::OverLimitLine in_words(const contour::offline::OverLine& over,
                                                 double limit_mm);

}  // namespace steadyrest::apps::cli::cut
