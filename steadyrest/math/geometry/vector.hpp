// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include <steadyrest/kernel/signal/path.hpp>

/// Arithmetic on points of the path. Free functions on a plain array, so that a point can be
/// logged, compared and restored like every other value of the kernel.
namespace steadyrest::math::geometry {

using kernel::signal::Point;

[[nodiscard]] constexpr Point add(const Point& a, const Point& b) noexcept {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
[[nodiscard]] constexpr Point subtract(const Point& a, const Point& b) noexcept {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
[[nodiscard]] constexpr Point scale(const Point& a, double factor) noexcept {
  return {a[0] * factor, a[1] * factor, a[2] * factor};
}
/// a + factor·b
[[nodiscard]] constexpr Point add_scaled(const Point& a, const Point& b, double factor) noexcept {
  return {a[0] + b[0] * factor, a[1] + b[1] * factor, a[2] + b[2] * factor};
}
[[nodiscard]] constexpr double dot(const Point& a, const Point& b) noexcept {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
[[nodiscard]] constexpr Point cross(const Point& a, const Point& b) noexcept {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
[[nodiscard]] constexpr double norm_squared(const Point& a) noexcept {
  return dot(a, a);
}
[[nodiscard]] inline double norm(const Point& a) noexcept {
  return std::sqrt(norm_squared(a));
}
[[nodiscard]] inline double distance(const Point& a, const Point& b) noexcept {
  return norm(subtract(a, b));
}
/// a/|a|; the zero vector stays zero.
[[nodiscard]] inline Point unit(const Point& a) noexcept {
  const double length = norm(a);
  return length > 0.0 ? scale(a, 1.0 / length) : Point{};
}
[[nodiscard]] inline bool is_finite(const Point& a) noexcept {
  return std::isfinite(a[0]) && std::isfinite(a[1]) && std::isfinite(a[2]);
}

}  // namespace steadyrest::math::geometry
