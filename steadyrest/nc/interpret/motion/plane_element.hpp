// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include <steadyrest/nc/interpret/state/arc.hpp>
#include <steadyrest/nc/interpret/state/move.hpp>
#include <steadyrest/nc/interpret/state/state.hpp>

namespace steadyrest::nc::interpret {

/// A line or arc of the contour in the working plane, mm.
class PlaneElement {
 public:
  /// `move` is linear or an arc of at most one turn.
  PlaneElement(const Move& move, PlaneAxes axes) noexcept;

  /// Both ends are at one height, no other axis moves, and there is a way in the plane.
  [[nodiscard]] bool in_plane() const noexcept { return in_plane_; }
  [[nodiscard]] bool arc() const noexcept { return arc_; }
  [[nodiscard]] double length_mm() const noexcept;
  /// Unit vectors along the way.
  [[nodiscard]] PlanePoint start_tangent() const noexcept;
  [[nodiscard]] PlanePoint end_tangent() const noexcept;
  [[nodiscard]] PlanePoint start() const noexcept { return start_; }
  [[nodiscard]] PlanePoint end() const noexcept { return end_; }
  /// Its point nearest to `point`, on its line or whole circle; false where that lies outside.
  bool foot(PlanePoint point, PlanePoint& out) const noexcept;

  /// Points at the distance r to the left of this and of another element (r < 0: to the right): at
  /// most two. Returns how many.
  static std::size_t offset_crossings(const PlaneElement& a, const PlaneElement& b, double r_mm,
                                      std::array<PlanePoint, 2>& out) noexcept;

 private:
  [[nodiscard]] double offset_radius(double r_mm) const noexcept;

  PlanePoint start_;
  PlanePoint end_;
  PlanePoint centre_;
  double radius_ = 0.0;
  double turn_ = 1.0;  ///< +1 counter-clockwise, −1 clockwise
  bool arc_ = false;
  bool in_plane_ = false;
};

}  // namespace steadyrest::nc::interpret
