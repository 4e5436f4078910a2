// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <string>

#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/record/column_reader.hpp>

namespace steadyrest::apps::live_page::past_runs {

/// What a course shows, in the order of CourseValues.
inline constexpr std::array<const char*, 8> kCourseNames = {
    "feed_percent",  "feed_effective_percent",
    "panel_percent", "path_speed_mm_min",
    "following_um",  "spindle_rpm",
    "offset_x_um",   "offset_z_um"};
/// `following_um` is the largest of the first three axes'.
using CourseValues = std::array<double, kCourseNames.size()>;

/// The values of a course, sample by sample, from any chunk of a record.
class CourseReader {
 public:
  static kernel::outcome::Result<CourseReader> open(const std::string& file);

  [[nodiscard]] std::size_t chunks() const noexcept { return columns_.chunks().size(); }
  [[nodiscard]] double cycle_s() const noexcept { return columns_.cycle_s(); }
  kernel::outcome::Result<void> read(std::size_t chunk) { return columns_.read(chunk); }
  /// Of the chunk that was read last.
  [[nodiscard]] std::size_t samples() const noexcept { return columns_.column(0).size(); }
  [[nodiscard]] double time_s(std::size_t sample) const noexcept {
    return columns_.column(0)[sample];
  }
  [[nodiscard]] CourseValues values(std::size_t sample) const noexcept;

 private:
  explicit CourseReader(record::ColumnReader columns) : columns_(std::move(columns)) {}

  record::ColumnReader columns_;
};

}  // namespace steadyrest::apps::live_page::past_runs
