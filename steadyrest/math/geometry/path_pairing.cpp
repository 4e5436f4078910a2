// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <steadyrest/math/geometry/foot_point.hpp>
#include <steadyrest/math/geometry/path_pairing.hpp>
#include <steadyrest/math/geometry/segment.hpp>
#include <steadyrest/math/geometry/station_walk.hpp>
#include <steadyrest/math/geometry/vector.hpp>

// Stretch by stretch: stations on both paths, the best walk through them, and from it the knots of
// the map from one path length to the other.
namespace steadyrest::math::geometry {
namespace {

using kernel::signal::PathSegment;
using kernel::signal::PathView;
using kernel::signal::Point;

// A spike that is cut short skips two tubes of path; as much again for a walk that only later turns
// out to be better.
constexpr double kBandTubes = 4.0;

/// Segments first … last of a path.
struct Stretch {
  std::size_t first = 0;
  std::size_t last = 0;
};

double begin_mm(PathView path, const Stretch& stretch) {
  return path[stretch.first].position_mm;
}

double end_mm(PathView path, const Stretch& stretch) {
  return path[stretch.last].position_mm + path[stretch.last].length_mm;
}

std::vector<Stretch> cuts_of(PathView path) {
  std::vector<Stretch> out;
  bool cutting = false;
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (!kernel::signal::in_cut(path[i].motion)) {
      cutting = false;
    } else if (cutting) {
      out.back().last = i;
    } else {
      cutting = true;
      out.push_back({i, i});
    }
  }
  return out;
}

/// Points along a stretch, and where they are.
struct Stations {
  std::vector<Point> point_mm;
  std::vector<double> at_mm;
  std::vector<std::size_t> segment;
};

Stations stations_on(PathView path, const Stretch& stretch, double step_mm) {
  const double begin = begin_mm(path, stretch);
  const double length = end_mm(path, stretch) - begin;
  const auto count = static_cast<std::size_t>(length / step_mm);
  Stations out;
  std::size_t i = stretch.first;
  const auto add = [&](double at_mm) {
    while (i < stretch.last && path[i].position_mm + path[i].length_mm < at_mm) {
      ++i;
    }
    out.point_mm.push_back(point_at(path[i], parameter_at(path[i], at_mm - path[i].position_mm)));
    out.at_mm.push_back(at_mm);
    out.segment.push_back(i);
  };
  for (std::size_t k = 0; k <= count; ++k) {
    add(begin + static_cast<double>(k) * step_mm);
  }
  if (out.at_mm.back() < begin + length) {
    add(begin + length);
  }
  return out;
}

}  // namespace

std::size_t segment_at(PathView path, double position_mm) noexcept {
  const auto after = std::ranges::upper_bound(path, position_mm, {}, &PathSegment::position_mm);
  return after == path.begin() ? 0 : static_cast<std::size_t>(after - path.begin()) - 1;
}

double distance_to(PathView path, const Point& query, double low_mm, double high_mm) noexcept {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = segment_at(path, low_mm); i < path.size() && path[i].position_mm <= high_mm;
       ++i) {
    const double low = parameter_at(path[i], low_mm - path[i].position_mm);
    const double high = parameter_at(path[i], high_mm - path[i].position_mm);
    least = std::min(least, foot_point(path[i], query, low, high, 0.5 * (low + high)).distance_mm);
  }
  return least;
}

std::expected<PathPairing, PathPairing::Parting> PathPairing::make(PathView changed,
                                                                   PathView original,
                                                                   const Config& config) {
  std::vector<Stretch> cuts = cuts_of(changed);
  std::vector<Stretch> originals = cuts_of(original);
  if (cuts.size() != originals.size()) {
    cuts = {{0, changed.size() - 1}};
    originals = {{0, original.size() - 1}};
  }
  const double longest = std::max(end_mm(changed, {0, changed.size() - 1}),
                                  end_mm(original, {0, original.size() - 1}));
  const double step_mm =
      std::max(config.tube_mm / config.steps_per_tube, longest / config.most_stations);
  const StationWalk::Config walking{
      config.tube_mm,
      static_cast<std::size_t>(std::ceil(kBandTubes * config.tube_mm / step_mm)) + 2};

  PathPairing out;
  out.knots_.push_back({0.0, 0.0});
  for (std::size_t k = 0; k < cuts.size(); ++k) {
    const Stations p = stations_on(changed, cuts[k], step_mm);
    const Stations q = stations_on(original, originals[k], step_mm);
    const StationWalk walk(p.point_mm, q.point_mm, walking);
    if (!walk.found()) {
      const auto& stop = walk.stop();
      return std::unexpected(Parting{p.segment[stop.changed], q.segment[stop.original],
                                     distance(p.point_mm[stop.changed], q.point_mm[stop.original]),
                                     stop.at_end});
    }
    const auto ranges = walk.ranges();
    for (std::size_t i = 0; i < ranges.size(); ++i) {
      // Of the stations that belong to this one the nearest; the order remains.
      std::size_t j = ranges[i].first;
      for (std::size_t n = j; n <= ranges[i].last; ++n) {
        const double apart = distance(p.point_mm[i], q.point_mm[n]);
        out.slack_mm_ = std::max(out.slack_mm_, apart);
        j = apart < distance(p.point_mm[i], q.point_mm[j]) ? n : j;
      }
      out.knots_.push_back({p.at_mm[i], q.at_mm[j]});
      const double reach = std::max(2.0 * step_mm, distance(p.point_mm[i], q.point_mm[j]));
      const double apart =
          distance_to(original, p.point_mm[i], q.at_mm[j] - reach, q.at_mm[j] + reach);
      if (apart > out.farthest_.distance_mm) {
        out.farthest_ = {apart, p.segment[i], q.segment[j]};
      }
    }
  }
  out.knots_.push_back(
      {end_mm(changed, {0, changed.size() - 1}), end_mm(original, {0, original.size() - 1})});
  return out;
}

double PathPairing::original_mm(double changed_mm) const noexcept {
  const auto after = std::ranges::upper_bound(knots_, changed_mm, {}, &Knot::changed_mm);
  if (after == knots_.begin() || after == knots_.end()) {
    return after == knots_.end() ? knots_.back().original_mm : knots_.front().original_mm;
  }
  const Knot& a = *(after - 1);
  const Knot& b = *after;
  const double share = (changed_mm - a.changed_mm) / (b.changed_mm - a.changed_mm);
  return a.original_mm + (b.original_mm - a.original_mm) * share;
}

}  // namespace steadyrest::math::geometry
