// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <steadyrest/contour/offline/learn/path_follower.hpp>
#include <steadyrest/math/geometry/foot_point.hpp>
#include <steadyrest/math/geometry/path_pairing.hpp>
#include <steadyrest/math/geometry/segment.hpp>
#include <steadyrest/math/geometry/vector.hpp>

namespace steadyrest::contour::offline {
namespace {

namespace geometry = math::geometry;
using kernel::signal::PathSegment;
using kernel::signal::Point;

constexpr double kShare = 0.1;        ///< of the step, that the place may be off …
constexpr double kReserve_mm = 0.01;  ///< … and this
constexpr double kReserveShare = 0.05;
constexpr double kFar_mm = 5.0;  ///< second search
constexpr std::size_t kMostPatience = 512;

}  // namespace

PathFollower::Nearest PathFollower::nearest(const Point& point, double low_mm,
                                            double high_mm) const noexcept {
  Nearest best;
  for (std::size_t i = geometry::segment_at(path_, std::max(low_mm, 0.0));
       i < path_.size() && path_[i].position_mm <= high_mm; ++i) {
    const PathSegment& segment = path_[i];
    const double low = geometry::parameter_at(segment, low_mm - segment.position_mm);
    const double high = geometry::parameter_at(segment, high_mm - segment.position_mm);
    const auto foot = geometry::foot_point(segment, point, low, high, 0.5 * (low + high));
    if (foot.distance_mm < best.distance_mm) {
      best = {.position_mm = segment.position_mm + geometry::distance_at(segment, foot.u),
              .distance_mm = foot.distance_mm};
    }
  }
  return best;
}

bool PathFollower::follow(const Point& point, double moved_mm) noexcept {
  const double reserve = kReserve_mm + kReserveShare * moved_mm;
  Nearest found = nearest(point, position_mm_ + (1.0 - kShare) * moved_mm - reserve,
                          position_mm_ + (1.0 + kShare) * moved_mm + reserve);
  if (found.distance_mm > near_mm_) {
    found = nearest(point, position_mm_, position_mm_ + 2.0 * moved_mm + kFar_mm);
  }
  if (found.distance_mm > near_mm_) {
    return false;
  }
  position_mm_ = std::max(position_mm_, found.position_mm);
  return true;
}

/// The first place ahead that is near enough; within its segment the nearest.
bool PathFollower::find_ahead(const Point& point) noexcept {
  for (std::size_t i = geometry::segment_at(path_, position_mm_); i < path_.size(); ++i) {
    const PathSegment& segment = path_[i];
    const double low = geometry::parameter_at(segment, position_mm_ - segment.position_mm);
    const auto foot = geometry::foot_point(segment, point, low, 1.0, low);
    if (foot.distance_mm <= near_mm_) {
      position_mm_ = segment.position_mm + geometry::distance_at(segment, foot.u);
      return true;
    }
  }
  return false;
}

std::optional<double> PathFollower::next(const Point& command_mm) {
  const double moved = last_mm_ ? geometry::distance(*last_mm_, command_mm) : 0.0;
  last_mm_ = command_mm;
  if (on_path_ && follow(command_mm, moved)) {
    return position_mm_ - proof_from_mm_ >= kProof_mm ? std::optional(position_mm_) : std::nullopt;
  }
  if (on_path_) {
    on_path_ = false;
    // A place that did not prove itself: the search goes on from there.
    position_mm_ = std::max(proof_from_mm_, position_mm_ - kProof_mm);
    wait_ = 0;
  }
  if (wait_ > 0) {
    --wait_;
    return std::nullopt;
  }
  on_path_ = find_ahead(command_mm);
  proof_from_mm_ = position_mm_;
  patience_ = on_path_ ? 1 : std::min(2 * patience_, kMostPatience);
  wait_ = patience_;
  return std::nullopt;
}

}  // namespace steadyrest::contour::offline
