// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include <steadyrest/contour/offline/predistort/polish/corner_legs.hpp>
#include <steadyrest/math/geometry/segment.hpp>
#include <steadyrest/math/geometry/vector.hpp>

namespace steadyrest::contour::offline {
namespace {

namespace geometry = math::geometry;
using kernel::signal::Point;

constexpr double kSamePlace_mm = 1e-6;
constexpr double kSameProgress_mm = 1e-3;
constexpr double kNearCorner_mm = 5.0;  ///< the last sample before a corner is nearer
constexpr double kStraight = 0.985;     ///< cosine of 10°
constexpr double kTurnsBack = 0.1;      ///< sine
constexpr double kSettled = 0.1;        ///< of the limit

bool is_corner(const Piece& before, const Piece& after) {
  return !after.joined && !after.passes &&
         geometry::distance(before.segment.end_mm, after.segment.start_mm) < kSamePlace_mm &&
         std::abs(before.progress_end_mm - after.progress_start_mm) < kSameProgress_mm;
}

}  // namespace

const CornerLegs::Leg* CornerLegs::leg_at(double at_mm) const {
  const auto found = std::ranges::lower_bound(legs_, at_mm - kSameProgress_mm, {}, &Leg::at_mm);
  return found != legs_.end() && found->at_mm < at_mm + kSameProgress_mm ? &*found : nullptr;
}

bool CornerLegs::update(std::span<const Piece> pieces, std::span<const BlockStart> starts) {
  bool moved = false;
  std::vector<Leg> fresh;
  for (std::size_t i = 1; i < pieces.size(); ++i) {
    const Piece& before = pieces[i - 1];
    const Piece& after = pieces[i];
    if (!is_corner(before, after)) {
      continue;
    }
    const Point from = geometry::station_at(before.segment, 1.0).tangent;
    const Point to = geometry::station_at(after.segment, 0.0).tangent;
    const double at_mm = after.progress_start_mm;
    const auto next =
        std::ranges::upper_bound(starts, at_mm + kSameProgress_mm, {}, &BlockStart::progress_mm);
    if (next == starts.begin() || std::prev(next)->progress_mm < at_mm - kNearCorner_mm ||
        geometry::dot(from, to) > kStraight) {
      continue;
    }
    // What the way that follows does not add to.
    const Point& behind = std::prev(next)->next_error_mm;
    const Point across = geometry::add_scaled(from, to, -geometry::dot(from, to));
    const double span = geometry::norm(across);
    if (span < kTurnsBack) {
      continue;
    }
    const double along_mm = geometry::dot(behind, across) / (span * span);
    const double across_mm = along_mm * span;
    if (const Leg* known = leg_at(at_mm)) {
      Leg& leg = legs_[static_cast<std::size_t>(known - legs_.data())];
      const double change = (along_mm - leg.last_behind_mm);
      if (std::abs(along_mm) < kSettled * config_.limit_mm || change == 0.0) {
        continue;
      }
      const double slope = change / (leg.beyond_mm - leg.last_mm);
      leg.last_mm = leg.beyond_mm;
      leg.last_behind_mm = along_mm;
      if (slope < 0.0) {
        leg.beyond_mm = std::clamp(leg.beyond_mm - along_mm / slope, 0.0, config_.most_mm);
      }
      moved = moved || leg.beyond_mm != leg.last_mm;
      continue;
    }
    if (across_mm > config_.limit_mm) {
      const double beyond_mm = before.segment.feed_mm_s * config_.lag_s * std::numbers::ln2;
      if (beyond_mm <= config_.most_mm) {
        fresh.push_back({.at_mm = at_mm, .beyond_mm = beyond_mm, .last_behind_mm = along_mm});
        moved = true;
      }
    }
  }
  legs_.insert(legs_.end(), fresh.begin(), fresh.end());
  std::ranges::sort(legs_, {}, &Leg::at_mm);
  return moved;
}

std::vector<Piece> CornerLegs::with_legs(std::span<const Piece> pieces) const {
  std::vector<Piece> out;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    if (i > 0 && is_corner(pieces[i - 1], pieces[i])) {
      const Leg* leg = leg_at(pieces[i].progress_start_mm);
      if (leg != nullptr && leg->beyond_mm > kSamePlace_mm) {
        const Piece before = out.back();
        const Point corner = before.segment.end_mm;
        const Point beyond = geometry::add_scaled(
            corner, geometry::station_at(before.segment, 1.0).tangent, leg->beyond_mm);
        const auto put = [&](const Point& start, const Point& end, bool joined) {
          Piece piece = before;
          piece.segment = line_segment(start, end);
          piece.segment.line = before.segment.line;
          piece.segment.motion = before.segment.motion;
          piece.segment.feed_mm_s = before.segment.feed_mm_s;
          piece.progress_start_mm = joined ? before.progress_start_mm : before.progress_end_mm;
          piece.begins_run = joined && before.begins_run;
          piece.joined = joined && before.joined;
          piece.passes = joined && before.passes;
          out.push_back(piece);
        };
        if (before.segment.geometry == kernel::signal::Geometry::line) {
          out.pop_back();
          put(before.segment.start_mm, beyond, true);
        } else {
          put(corner, beyond, false);
          out.back().joined = true;
        }
        put(beyond, corner, false);
      }
    }
    out.push_back(pieces[i]);
  }
  return out;
}

}  // namespace steadyrest::contour::offline
