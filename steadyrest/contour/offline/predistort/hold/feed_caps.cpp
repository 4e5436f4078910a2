// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <steadyrest/contour/offline/predistort/hold/feed_caps.hpp>
#include <steadyrest/math/geometry/path_pairing.hpp>

namespace steadyrest::contour::offline {
namespace {

constexpr double kCell_mm = 0.25;
constexpr double kSpare_mm = 0.25;     ///< beyond both ends of a stretch
constexpr double kAim = 0.95;          ///< of the limit
constexpr double kMostFall = 0.6;      ///< in one step
constexpr double kLeastPart_mm = 0.1;  ///< a part shorter than this keeps its piece whole
constexpr double kFalls = 0.999;
constexpr double kArcStep = 0.99;

double length_of(const nc::plan::PlannedPath& path) noexcept {
  return path.segments.empty() ? 0.0
                               : path.segments.back().position_mm + path.segments.back().length_mm;
}

/// The lowest or highest speed of the command between two places.
double speed_mm_s(const CommandSpeed& speed, double from_mm, double to_mm,
                  FeedCaps::Speed which) noexcept {
  auto at = static_cast<std::size_t>(std::ranges::lower_bound(speed.progress_mm, from_mm) -
                                     speed.progress_mm.begin());
  double out = at < speed.speed_mm_s.size() ? speed.speed_mm_s[at] : 0.0;
  for (; at < speed.progress_mm.size() && speed.progress_mm[at] <= to_mm; ++at) {
    out = which == FeedCaps::Speed::lowest ? std::min(out, speed.speed_mm_s[at])
                                           : std::max(out, speed.speed_mm_s[at]);
  }
  return out;
}

}  // namespace

FeedCaps::FeedCaps(const nc::plan::PlannedPath& path, double least_ratio)
    : path_(path),
      least_ratio_(least_ratio),
      ratio_(static_cast<std::size_t>(length_of(path) / kCell_mm) + 1, 1.0) {}

std::size_t FeedCaps::cell(double at_mm) const noexcept {
  return std::min(ratio_.size() - 1, static_cast<std::size_t>(std::max(0.0, at_mm) / kCell_mm));
}

double FeedCaps::feed_mm_s(double at_mm) const noexcept {
  return path_.segments[math::geometry::segment_at(path_.segments, at_mm)].feed_mm_s;
}

void FeedCaps::lower_arcs(const nc::plan::PathLimits& limits, double lag_s, double share) {
  for (const auto& arc : path_.segments) {
    if (arc.geometry != kernel::signal::Geometry::arc || !(arc.radius_mm > 0.0) ||
        arc.motion != kernel::signal::Motion::feed) {
      continue;
    }
    const auto plane = limits.plane(arc.axis);
    const auto is_possible = [&](double feed_mm_s) {
      const double longer = std::hypot(1.0, feed_mm_s * lag_s / arc.radius_mm);
      return feed_mm_s * longer <= share * limits.circle(arc.radius_mm * longer, plane).speed_mm_s;
    };
    double ratio = 1.0;
    while (ratio > least_ratio_ && !is_possible(ratio * arc.feed_mm_s)) {
      ratio = std::max(least_ratio_, kArcStep * ratio);
    }
    if (ratio < 1.0) {
      for (std::size_t i = cell(arc.position_mm); i <= cell(arc.position_mm + arc.length_mm); ++i) {
        ratio_[i] = std::min(ratio_[i], ratio);
      }
    }
  }
  unite();
}

bool FeedCaps::tighten(const std::vector<ErrorPlace>& places, const CommandSpeed& speed,
                       double limit_mm, Speed which) {
  const bool highest = which == Speed::highest;
  const double spare_mm = highest ? kSpare_mm : 0.0;
  const std::vector<double> before = ratio_;
  bool fallen = false;
  for (const ErrorPlace& place : places) {
    if (!(place.error_mm > limit_mm) || place.early) {
      continue;
    }
    const double from = place.foot_mm - kSpare_mm;
    const double to = std::max(place.foot_mm, place.progress_mm) + kSpare_mm;
    const double fall = std::max(kMostFall, std::sqrt(kAim * limit_mm / place.error_mm));
    const double most =
        fall * speed_mm_s(speed, place.foot_mm - spare_mm, place.progress_mm + spare_mm, which);
    for (std::size_t i = cell(from); i <= cell(to); ++i) {
      const double feed = feed_mm_s((static_cast<double>(i) + 0.5) * kCell_mm);
      // On an arc the command is faster than its feed.
      const double now = highest ? fall * before[i] : 1.0;
      const double ratio = std::max(least_ratio_, feed > 0.0 ? std::min(now, most / feed) : 1.0);
      if (ratio < kFalls * ratio_[i]) {
        ratio_[i] = ratio;
        fallen = true;
      }
    }
  }
  unite();
  return fallen;
}

void FeedCaps::unite() {
  stretches_.clear();
  for (std::size_t i = 0; i < ratio_.size();) {
    if (ratio_[i] >= 1.0) {
      ++i;
      continue;
    }
    Stretch stretch{.from_mm = static_cast<double>(i) * kCell_mm};
    for (; i < ratio_.size() && ratio_[i] < 1.0; ++i) {
      stretch.ratio = std::min(stretch.ratio, ratio_[i]);
    }
    stretch.to_mm = static_cast<double>(i) * kCell_mm;
    stretches_.push_back(stretch);
  }
}

std::vector<Piece> FeedCaps::apply(std::vector<Piece> pieces) const {
  if (stretches_.empty()) {
    return pieces;
  }
  std::vector<Piece> out;
  out.reserve(pieces.size());
  auto next = stretches_.begin();
  for (const Piece& piece : pieces) {
    const double start = piece.progress_start_mm;
    const double span = piece.progress_end_mm - start;
    while (next != stretches_.end() && next->to_mm <= start) {
      ++next;
    }
    if (!(span > 0.0)) {
      out.push_back(piece);
      continue;
    }
    double at = 0.0;  // of the piece, 0 … 1
    const double least = kLeastPart_mm / std::max(kLeastPart_mm, piece.segment.length_mm);
    // The part from `at` up to this parameter.
    const auto take = [&](double to, double ratio) {
      Piece part = at <= 0.0 && to >= 1.0 ? piece : part_of(piece, at, to);
      part.segment.feed_mm_s *= ratio;
      part.begins_run = piece.begins_run && at <= 0.0;
      part.joined = piece.joined || at > 0.0;
      part.passes = piece.passes && at <= 0.0;
      out.push_back(part);
      at = to;
    };
    for (auto one = next; one != stretches_.end() && one->from_mm < piece.progress_end_mm; ++one) {
      const double from = std::clamp((one->from_mm - start) / span, 0.0, 1.0);
      double to = std::clamp((one->to_mm - start) / span, 0.0, 1.0);
      to = to > 1.0 - least ? 1.0 : to;
      if (from > at + least) {
        take(from, 1.0);
      }
      if (to > at) {
        take(to, one->ratio);
      }
    }
    if (at < 1.0) {
      take(1.0, 1.0);
    }
  }
  return out;
}

}  // namespace steadyrest::contour::offline
