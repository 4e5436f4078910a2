// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <steadyrest/contour/offline/feeds/feed_cells.hpp>
#include <steadyrest/math/geometry/segment.hpp>
#include <steadyrest/math/geometry/vector.hpp>

namespace steadyrest::contour::offline {
namespace {

using kernel::signal::Motion;
using kernel::signal::PathSegment;
using nc::plan::PlannedPath;
using nc::plan::SegmentPlan;

FeedKind kind_of(const PlannedPath& path, std::size_t i, const FeedRoom& room) noexcept {
  const SegmentPlan& plan = path.plans[i];
  const bool acts = path.segments[i].motion == Motion::feed && !plan.locked && !plan.rapid &&
                    plan.feed_mm_s > 0.0;
  if (!acts) {
    return FeedKind::fixed;
  }
  return i < room.kind.size() ? room.kind[i] : FeedKind::free;
}

/// Longest cell that keeps their number within the most.
double station_of(const PlannedPath& path, const FeedRoom& room) noexcept {
  double free_mm = 0.0;
  for (std::size_t i = 0; i < path.segments.size(); ++i) {
    free_mm += kind_of(path, i, room) == FeedKind::free ? path.segments[i].length_mm : 0.0;
  }
  // A path of more segments than that gets a quarter more cells.
  const std::size_t segments = path.segments.size();
  const std::size_t more = std::max(room.most_cells, segments + segments / 4 + 1) - segments;
  return std::max(room.station_mm, free_mm / static_cast<double>(more));
}

/// Where the cells of a segment begin and end, mm from its start.
void borders_of(const PathSegment& segment, FeedKind kind, const std::array<float, 2>& ends_mm,
                double station_mm, std::vector<double>& out) {
  const auto from = static_cast<double>(ends_mm[0]);
  const double to = segment.length_mm - static_cast<double>(ends_mm[1]);
  out.assign(1, 0.0);
  if (kind == FeedKind::free && to > from) {
    const double pieces = std::max(1.0, std::ceil((to - from) / station_mm - 1e-9));
    for (double j = from > 0.0 ? 0.0 : 1.0; j < pieces; ++j) {
      out.push_back(from + (to - from) * j / pieces);
    }
    if (to < segment.length_mm) {
      out.push_back(to);
    }
  }
  out.push_back(segment.length_mm);
}

}  // namespace

FeedCells feed_cells(const PlannedPath& path, const PathMap& map, const FeedRoom& room) {
  FeedCells cells;
  const double station = station_of(path, room);
  std::vector<double> borders;
  std::size_t event = 0;
  const auto pass_events = [&](std::size_t segment) {
    for (; event < path.events.size() && path.events[event].segment <= segment; ++event) {
      cells.path.events.push_back(path.events[event]);
      cells.path.events.back().segment = cells.path.segments.size();
    }
  };
  for (std::size_t i = 0; i < path.segments.size(); ++i) {
    pass_events(i);
    const PathSegment& segment = path.segments[i];
    const FeedKind kind = kind_of(path, i, room);
    borders_of(segment, kind, i < room.ends_mm.size() ? room.ends_mm[i] : std::array<float, 2>{},
               station, borders);
    const double map_mm = map.end_mm[i] - map.start_mm[i];
    const auto share = [&](double at_mm) {
      return segment.length_mm > 0.0 ? at_mm / segment.length_mm : 0.0;
    };
    for (std::size_t j = 0; j + 1 < borders.size(); ++j) {
      const bool last = j + 2 == borders.size();
      PathSegment part = borders.size() == 2
                             ? segment
                             : math::geometry::part_of(segment, borders[j], borders[j + 1]);
      SegmentPlan plan = path.plans[i];
      plan.length_mm = part.length_mm;
      if (!last) {
        part.exit_speed_limit_mm_s = plan.exit_speed_limit_mm_s = plan.speed_limit_mm_s;
      }
      cells.path.segments.push_back(part);
      cells.path.plans.push_back(plan);
      cells.map.start_mm.push_back(map.start_mm[i] + share(borders[j]) * map_mm);
      cells.map.end_mm.push_back(last ? map.end_mm[i]
                                      : map.start_mm[i] + share(borders[j + 1]) * map_mm);
      cells.of.push_back(static_cast<std::uint32_t>(i));
      cells.kind.push_back(kind);
      cells.from_mm.push_back(borders[j]);
      cells.ceiling.push_back(plan.feed_mm_s);
    }
  }
  pass_events(path.segments.size());
  return cells;
}

}  // namespace steadyrest::contour::offline
