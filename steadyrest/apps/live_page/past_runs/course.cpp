// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <steadyrest/apps/live_page/past_runs/course.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>

namespace steadyrest::apps::live_page::past_runs {
namespace {

using kernel::outcome::refuse;
using kernel::outcome::Result;

constexpr double kBlocksInInterval = 4.0;
constexpr double kNone = std::numeric_limits<double>::infinity();

struct Interval {
  CourseValues least;
  CourseValues most;
};

/// Equal intervals of time.
class Intervals {
 public:
  Intervals(double from_s, double to_s, std::size_t points)
      : from_s_(from_s), to_s_(to_s), step_s_((to_s - from_s) / static_cast<double>(points)) {
    Interval none{};
    none.least.fill(kNone);
    none.most.fill(-kNone);
    all_.assign(points, none);
  }

  [[nodiscard]] double step_s() const noexcept { return step_s_; }
  [[nodiscard]] bool overlaps(const Overview::Span& span) const noexcept {
    return span.last_s >= from_s_ && span.first_s <= to_s_;
  }
  void add(const Overview::Block& block) {
    if (overlaps(block.time)) {
      for (std::size_t i = index(block.time.first_s); i <= index(block.time.last_s); ++i) {
        widen(all_[i], block.least, block.most);
      }
    }
  }
  void add(double time_s, const CourseValues& values) {
    if (time_s >= from_s_ && time_s <= to_s_) {
      widen(all_[index(time_s)], values, values);
    }
  }

  /// Times from `first_s` on.
  [[nodiscard]] Json json(double first_s) const {
    Json times = Json::array();
    for (std::size_t i = 0; i < all_.size(); ++i) {
      times.push_back(from_s_ - first_s + step_s_ * (static_cast<double>(i) + 0.5));
    }
    Json columns = Json::object();
    for (std::size_t c = 0; c < kCourseNames.size(); ++c) {
      columns[kCourseNames[c]] = {{"min", values(c, &Interval::least)},
                                  {"max", values(c, &Interval::most)}};
    }
    return {{"t_s", std::move(times)}, {"columns", std::move(columns)}};
  }

 private:
  [[nodiscard]] std::size_t index(double time_s) const noexcept {
    const auto last = static_cast<double>(all_.size() - 1);
    return static_cast<std::size_t>(std::clamp((time_s - from_s_) / step_s_, 0.0, last));
  }

  template <class Values>
  static void widen(Interval& interval, const Values& least, const Values& most) {
    for (std::size_t c = 0; c < kCourseNames.size(); ++c) {
      interval.least[c] = std::min(interval.least[c], double{least[c]});
      interval.most[c] = std::max(interval.most[c], double{most[c]});
    }
  }

  [[nodiscard]] Json values(std::size_t column, CourseValues Interval::* of) const {
    Json out = Json::array();
    for (const Interval& interval : all_) {
      const double value = (interval.*of)[column];
      out.push_back(std::isfinite(value) ? Json(value) : Json());
    }
    return out;
  }

  double from_s_;
  double to_s_;
  double step_s_;
  std::vector<Interval> all_;
};

Result<void> add_samples(const std::string& file, const Overview& overview, Intervals& intervals,
                         const std::stop_token& stop) {
  auto reader = CourseReader::open(file);
  if (!reader) {
    return std::unexpected(std::move(reader.error()));
  }
  for (std::size_t chunk = 0; chunk < overview.chunks.size(); ++chunk) {
    if (!intervals.overlaps(overview.chunks[chunk])) {
      continue;
    }
    if (stop.stop_requested()) {
      return refuse("the page ends", "ask again when it runs");
    }
    if (auto read = reader->read(chunk); !read) {
      return read;
    }
    for (std::size_t i = 0; i < reader->samples(); ++i) {
      intervals.add(reader->time_s(i), reader->values(i));
    }
  }
  return {};
}

}  // namespace

Result<Json> course_of(const CourseAsked& asked, Overviews& overviews,
                       const std::stop_token& stop) {
  const auto found = overviews.of(asked.file, stop);
  if (!found) {
    return std::unexpected(found.error());
  }
  const Overview& overview = **found;
  const double first_s = overview.first_s();
  const double whole_s = std::max(0.0, overview.last_s() - first_s) + overview.cycle_s;
  const double from_s = first_s + std::clamp(asked.from_s, 0.0, whole_s);
  const double to_s = std::max(from_s + overview.cycle_s, first_s + std::min(asked.to_s, whole_s));
  Intervals intervals(from_s, to_s,
                      std::clamp<std::size_t>(asked.points, 1, CourseAsked::kMostPoints));
  const double block_s = overview.cycle_s * static_cast<double>(overview.block_samples);
  if (intervals.step_s() > kBlocksInInterval * block_s) {
    for (const Overview::Block& block : overview.blocks) {
      intervals.add(block);
    }
  } else if (auto added = add_samples(asked.file, overview, intervals, stop); !added) {
    return std::unexpected(std::move(added.error()));
  }
  return intervals.json(first_s);
}

}  // namespace steadyrest::apps::live_page::past_runs
