// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <steadyrest/contour/online/nominal_error.hpp>
#include <steadyrest/math/geometry/vector.hpp>

namespace steadyrest::contour::online {

namespace geometry = math::geometry;
using kernel::signal::Point;

// The paper's Ed: √(ex² + ey² + ez²). It grows with the contour error but is not one.
double nominal_error_mm(const kernel::signal::Frame& frame) noexcept {
  double squares = 0.0;
  for (std::size_t i = 0; i < std::min<std::size_t>(3, frame.axis_count); ++i) {
    squares += frame.axis[i].following_error_mm * frame.axis[i].following_error_mm;
  }
  return std::sqrt(squares);
}

// ε = R − √(R² − Ed²) for equal gains, without knowing them: command, actual point and centre form
// a right triangle with Ed as one leg. Beyond R it is meaningless and held at R.
double arc_identity_mm(double nominal_error_mm, double radius_mm) noexcept {
  const double r = std::abs(radius_mm);
  const double e = std::min(std::abs(nominal_error_mm), r);
  // R − √(R² − e²) without the cancellation of small errors on large radii.
  const double error = r > 0.0 ? e * e / (r + std::sqrt((r - e) * (r + e))) : 0.0;
  return std::copysign(error, radius_mm);
}

Point tangential_error_mm(const Point& error_mm, const Point& tangent) noexcept {
  return geometry::add_scaled(error_mm, tangent, -geometry::dot(error_mm, tangent));
}

Point corrected_offset_mm(const Point& error_mm, const Point& tangent,
                          const Point& curvature_1_mm) noexcept {
  const double along = geometry::dot(error_mm, tangent);
  const Point normal = tangential_error_mm(error_mm, tangent);
  // Over `along` backwards, the path leaves its tangent by along²/2·κ⃗ towards the centre.
  return geometry::add_scaled(geometry::scale(normal, -1.0), curvature_1_mm, -0.5 * along * along);
}

// Three points a fixed length apart define a circle: the turn from the first chord to the second,
// over half their length, is κ⃗. Spaced by distance, not by time, so that rounding does not
// dominate slow motion.
CommandedCurve::Output CommandedCurve::update(const Point& command_mm) noexcept {
  Output output;
  if (!geometry::is_finite(command_mm)) {
    return output;
  }
  const auto back = [this](std::size_t i) -> const Point& {
    return state_.point_mm[(state_.next + kPoints - 1 - i) % kPoints];
  };
  if (state_.count == 0 || geometry::distance(back(0), command_mm) > span_mm_ / (kPoints / 2.0)) {
    state_.point_mm[state_.next] = command_mm;
    state_.next = (state_.next + 1) % kPoints;
    state_.count = std::min(state_.count + 1, kPoints);
  }
  std::size_t middle = 0;
  std::size_t oldest = 0;
  for (std::size_t i = 1; i < state_.count; ++i) {
    const double away = geometry::distance(back(i), command_mm);
    if (middle == 0 && away >= 0.5 * span_mm_) {
      middle = i;
    }
    if (away >= span_mm_) {
      oldest = i;
      break;
    }
  }
  if (middle == 0 || oldest <= middle) {
    return output;
  }
  const Point first = geometry::subtract(back(middle), back(oldest));
  const Point second = geometry::subtract(command_mm, back(middle));
  const double l1 = geometry::norm(first);
  const double l2 = geometry::norm(second);
  const Point t1 = geometry::scale(first, 1.0 / l1);
  const Point t2 = geometry::scale(second, 1.0 / l2);
  output.valid = true;
  const Point turn = geometry::scale(geometry::subtract(t2, t1), 2.0 / (l1 + l2));
  // The chord's direction is the tangent half a chord ago.
  output.tangent = geometry::unit(geometry::add_scaled(t2, turn, 0.5 * l2));
  // The turn points to the centre as seen from the middle point: its direction advances with the
  // tangent, its size stays.
  const Point across =
      geometry::add_scaled(turn, output.tangent, -geometry::dot(turn, output.tangent));
  output.curvature_1_mm = geometry::scale(geometry::unit(across), geometry::norm(turn));
  return output;
}

}  // namespace steadyrest::contour::online
