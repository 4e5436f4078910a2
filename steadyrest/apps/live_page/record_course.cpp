// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include <steadyrest/apps/live_page/record_course.hpp>
#include <steadyrest/kernel/units/convert.hpp>
#include <steadyrest/record/record_reader.hpp>

namespace steadyrest::apps::live_page {
namespace {

using kernel::outcome::Result;
using record::Sample;

constexpr std::size_t kMostPoints = 4000;
constexpr double kNone = std::numeric_limits<double>::infinity();

/// A column and its value in a sample.
struct Column {
  const char* name;
  double (*of)(const Sample&) noexcept;
};

double following_um(const Sample& sample) noexcept {
  double most = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    most = std::max(most, std::abs(sample.frame.axis[i].following_error_mm));
  }
  return kernel::units::um_from_mm(most);
}

constexpr std::array<Column, 8> kColumns = {{
    {"feed_percent", [](const Sample& s) noexcept { return kPercent * s.command.feed_ratio; }},
    {"feed_effective_percent",
     [](const Sample& s) noexcept { return kPercent * s.frame.feed.effective_ratio; }},
    {"panel_percent", [](const Sample& s) noexcept { return kPercent * s.frame.feed.panel_ratio; }},
    {"path_speed_mm_min",
     [](const Sample& s) noexcept { return kMinute_s * s.frame.path_speed_mm_s; }},
    {"following_um", following_um},
    {"spindle_rpm",
     [](const Sample& s) noexcept { return kMinute_s * s.frame.spindle_actual_rev_s; }},
    {"offset_x_um",
     [](const Sample& s) noexcept {
       return kernel::units::um_from_mm(s.command.offset_mm[0] + s.command.path_offset_mm[0]);
     }},
    {"offset_z_um",
     [](const Sample& s) noexcept {
       return kernel::units::um_from_mm(s.command.offset_mm[2] + s.command.path_offset_mm[2]);
     }},
}};

struct Interval {
  std::array<double, kColumns.size()> least;
  std::array<double, kColumns.size()> most;
};

Json values(const std::vector<Interval>& intervals, std::size_t column,
            std::array<double, kColumns.size()> Interval::* of) {
  Json out = Json::array();
  for (const Interval& interval : intervals) {
    const double value = (interval.*of)[column];
    out.push_back(std::isfinite(value) ? Json(value) : Json());
  }
  return out;
}

Json json_of(const std::vector<Interval>& intervals, double from_s, double step_s) {
  Json times = Json::array();
  for (std::size_t i = 0; i < intervals.size(); ++i) {
    times.push_back(from_s + step_s * (static_cast<double>(i) + 0.5));
  }
  Json columns = Json::object();
  for (std::size_t c = 0; c < kColumns.size(); ++c) {
    columns[kColumns[c].name] = {{"min", values(intervals, c, &Interval::least)},
                                 {"max", values(intervals, c, &Interval::most)}};
  }
  return {{"t_s", std::move(times)}, {"columns", std::move(columns)}};
}

/// The time of the first sample; the record's length follows from its cycle.
Result<double> first_time(const std::string& file) {
  auto reader = record::RecordReader::open(file);
  const auto sample = std::make_unique<Sample>();
  if (!reader) {
    return std::unexpected(std::move(reader.error()));
  }
  const auto more = reader->next(*sample);
  if (!more) {
    return std::unexpected(more.error());
  }
  return *more ? sample->frame.time_s : 0.0;
}

}  // namespace

Result<Json> course_of(const CourseAsked& asked) {
  const auto first_s = first_time(asked.file);
  auto reader = record::RecordReader::open(asked.file);
  if (!first_s || !reader) {
    return std::unexpected(first_s ? reader.error() : first_s.error());
  }
  const double whole_s = static_cast<double>(reader->totals().samples) * reader->run().cycle_s;
  const double from_s = *first_s + std::max(asked.from_s, 0.0);
  const double to_s =
      std::max(from_s + reader->run().cycle_s, *first_s + std::min(asked.to_s, whole_s));
  const std::size_t points = std::clamp<std::size_t>(asked.points, 1, kMostPoints);
  const double step_s = (to_s - from_s) / static_cast<double>(points);
  Interval none{};
  none.least.fill(kNone);
  none.most.fill(-kNone);
  std::vector<Interval> intervals(points, none);
  const auto sample = std::make_unique<Sample>();
  for (;;) {
    const auto more = reader->next(*sample);
    if (!more) {
      return std::unexpected(more.error());
    }
    const double time_s = sample->frame.time_s;
    if (!*more || time_s > to_s) {
      break;
    }
    if (!(time_s >= from_s)) {
      continue;
    }
    Interval& interval =
        intervals[std::min(points - 1, static_cast<std::size_t>((time_s - from_s) / step_s))];
    for (std::size_t c = 0; c < kColumns.size(); ++c) {
      const double value = kColumns[c].of(*sample);
      interval.least[c] = std::min(interval.least[c], value);
      interval.most[c] = std::max(interval.most[c], value);
    }
  }
  return json_of(intervals, from_s - *first_s, step_s);
}

}  // namespace steadyrest::apps::live_page
