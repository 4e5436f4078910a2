// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <steadyrest/contour/offline/predistort/polish/chain_corner.hpp>

namespace steadyrest::contour::offline {
namespace {

constexpr double kLeastLeft_mm = 0.05;
constexpr double kLeastWay_mm = 0.02;  ///< across

}  // namespace

bool turn_corner(std::span<ChainPiece, 3> way, double beyond_mm, double on_mm) {
  ChainPiece& before = way[0];
  ChainPiece& across = way[1];
  ChainPiece& rest = way[2];
  before.arc.length_mm += beyond_mm;
  rest.height_mm += rest.slope * on_mm;
  rest.arc = {along(rest.arc, on_mm), rest.arc.curvature_1_mm, rest.arc.length_mm - on_mm};
  if (!(before.arc.length_mm >= kLeastLeft_mm) || !(rest.arc.length_mm >= kLeastLeft_mm)) {
    return false;
  }
  const Heading tip = along(before.arc, before.arc.length_mm);
  const double dx = rest.arc.start.x_mm - tip.x_mm;
  const double dy = rest.arc.start.y_mm - tip.y_mm;
  across.arc = {{tip.x_mm, tip.y_mm, std::atan2(dy, dx)}, 0.0, std::hypot(dx, dy)};
  if (!(across.arc.length_mm >= kLeastWay_mm)) {
    return false;
  }
  across.height_mm = before.height_mm + before.slope * before.arc.length_mm;
  across.slope = (rest.height_mm - across.height_mm) / across.arc.length_mm;
  return true;
}

}  // namespace steadyrest::contour::offline
