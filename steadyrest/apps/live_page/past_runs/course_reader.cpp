// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <utility>

#include <steadyrest/apps/live_page/desk.hpp>
#include <steadyrest/apps/live_page/past_runs/course_reader.hpp>
#include <steadyrest/kernel/units/convert.hpp>

namespace steadyrest::apps::live_page::past_runs {
namespace {

using kernel::outcome::Result;
using kernel::units::um_from_mm;

enum Column : std::uint8_t {
  time_of,
  feed,
  effective,
  panel,
  speed,
  following_x,
  following_y,
  following_z,
  spindle,
  offset_x,
  path_offset_x,
  offset_z,
  path_offset_z
};
constexpr std::array<const char*, path_offset_z + 1> kColumns = {"time_s",
                                                                 "command.feed_ratio",
                                                                 "override.effective_ratio.0",
                                                                 "override.panel_ratio.0",
                                                                 "path_speed_mm_s",
                                                                 "axis.following_error_mm.0",
                                                                 "axis.following_error_mm.1",
                                                                 "axis.following_error_mm.2",
                                                                 "spindle_actual_rev_s",
                                                                 "command.offset_mm.0",
                                                                 "command.path_offset_mm.0",
                                                                 "command.offset_mm.2",
                                                                 "command.path_offset_mm.2"};

}  // namespace

Result<CourseReader> CourseReader::open(const std::string& file) {
  auto columns = record::ColumnReader::open(file, {kColumns.begin(), kColumns.end()});
  if (!columns) {
    return std::unexpected(std::move(columns.error()));
  }
  return CourseReader(std::move(*columns));
}

CourseValues CourseReader::values(std::size_t sample) const noexcept {
  const auto at = [this, sample](Column column) { return columns_.column(column)[sample]; };
  const double following_mm =
      std::max({std::abs(at(following_x)), std::abs(at(following_y)), std::abs(at(following_z))});
  return {kPercent * at(feed),
          kPercent * at(effective),
          kPercent * at(panel),
          kMinute_s * at(speed),
          um_from_mm(following_mm),
          kMinute_s * at(spindle),
          um_from_mm(at(offset_x) + at(path_offset_x)),
          um_from_mm(at(offset_z) + at(path_offset_z))};
}

}  // namespace steadyrest::apps::live_page::past_runs
