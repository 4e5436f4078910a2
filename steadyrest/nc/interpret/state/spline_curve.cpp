// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <steadyrest/nc/interpret/state/spline_curve.hpp>

namespace steadyrest::nc::interpret {
namespace {

constexpr std::size_t kMostOrder = 8;

}  // namespace

int spline_spans(std::span<const SplinePoint> points, int order) noexcept {
  return static_cast<int>(points.size()) - order + 1;
}

// De Boor's algorithm on the knots 0 … 0 1 2 … n … n, so the curve begins and ends on its first and
// last control points. In homogeneous coordinates (x·w, y·w, w) a rational curve is an ordinary
// one; the division comes last.
SplinePoint spline_at(std::span<const SplinePoint> points, int order, double u) noexcept {
  const int spans = spline_spans(points, order);
  const auto knot = [&](int i) { return std::clamp(i - order + 1, 0, spans); };
  const int span = std::clamp(static_cast<int>(std::floor(u)), 0, spans - 1);
  struct Homogeneous {
    double x, y, w;
  };
  std::array<Homogeneous, kMostOrder> d{};
  for (int i = 0; i < order; ++i) {
    const SplinePoint& p = points[static_cast<std::size_t>(span) + static_cast<std::size_t>(i)];
    d[static_cast<std::size_t>(i)] = {p.x_mm * p.weight, p.y_mm * p.weight, p.weight};
  }
  for (int level = 1; level < order; ++level) {
    for (int i = order - 1; i >= level; --i) {
      // low ≤ span < span + 1 ≤ high: no division by zero.
      const double low = knot(span + i);
      const double high = knot(span + i + order - level);
      const double t = (u - low) / (high - low);
      auto& to = d[static_cast<std::size_t>(i)];
      const auto& from = d[static_cast<std::size_t>(i) - 1];
      to = {(1.0 - t) * from.x + t * to.x, (1.0 - t) * from.y + t * to.y,
            (1.0 - t) * from.w + t * to.w};
    }
  }
  const Homogeneous& end = d[static_cast<std::size_t>(order) - 1];
  return {.x_mm = end.x / end.w, .y_mm = end.y / end.w, .weight = end.w};
}

}  // namespace steadyrest::nc::interpret
