// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

#include <steadyrest/apps/live_page/desk.hpp>
#include <steadyrest/kernel/outcome/result.hpp>

namespace steadyrest::apps::live_page {

/// A stretch of a record, thinned: the least and the largest value of each column in `points` equal
/// intervals of time. Times count from the record's first sample.
struct CourseAsked {
  std::string file;
  double from_s = 0.0;
  double to_s = 1e18;
  std::size_t points = 1000;  ///< at most 4000
};

/// `t_s`, and each of `columns` with `min` and `max`; null where an interval has no sample.
[[nodiscard]] kernel::outcome::Result<Json> course_of(const CourseAsked& asked);

}  // namespace steadyrest::apps::live_page
