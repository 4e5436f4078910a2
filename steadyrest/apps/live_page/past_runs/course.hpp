// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <stop_token>
#include <string>

#include <steadyrest/apps/live_page/desk.hpp>
#include <steadyrest/apps/live_page/past_runs/overview.hpp>
#include <steadyrest/kernel/outcome/result.hpp>

namespace steadyrest::apps::live_page::past_runs {

/// A stretch of a record, thinned: the least and the largest value of each column in `points` equal
/// intervals of time. Times count from the record's first sample.
struct CourseAsked {
  static constexpr std::size_t kMostPoints = 4000;
  std::string file;
  double from_s = 0.0;
  double to_s = 1e18;
  std::size_t points = 1000;  ///< 1 … kMostPoints
};

/// `t_s`, and each of `columns` with `min` and `max`; null where an interval has no sample.
///
/// Intervals of more than four blocks of the overview are made from it, so that an interval takes
/// in up to one block (0.26 s at 1 kHz) beyond each of its ends; shorter ones sample by sample,
/// from the chunks that hold them.
[[nodiscard]] kernel::outcome::Result<Json> course_of(const CourseAsked& asked,
                                                      Overviews& overviews,
                                                      const std::stop_token& stop = {});

}  // namespace steadyrest::apps::live_page::past_runs
