// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <optional>

#include <steadyrest/contour/offline/learn/learnt.hpp>
#include <steadyrest/math/geometry/vector.hpp>

namespace steadyrest::contour::offline {
namespace {

namespace geometry = math::geometry;
using kernel::signal::Point;

Point mixed(const Point& a, const Point& b, double share) noexcept {
  return geometry::add_scaled(a, geometry::subtract(b, a), share);
}

Learnt::Knot knot_at(const Learnt::Stretch& stretch, double at_mm) noexcept {
  const auto& knots = stretch.knots;
  const auto next = std::ranges::lower_bound(knots, at_mm, {}, &Learnt::Knot::at_mm);
  if (next == knots.begin()) {
    return knots.front();
  }
  if (next == knots.end()) {
    return knots.back();
  }
  const Learnt::Knot& a = *(next - 1);
  const Learnt::Knot& b = *next;
  const double share = (at_mm - a.at_mm) / (b.at_mm - a.at_mm);
  return {.at_mm = at_mm,
          .shift_mm = mixed(a.shift_mm, b.shift_mm, share),
          .unknown_mm = mixed(a.unknown_mm, b.unknown_mm, share),
          .weight = a.weight + share * (b.weight - a.weight)};
}

/// Nothing where no stretch is.
std::optional<Learnt::Knot> knot_of(const std::vector<Learnt::Stretch>& stretches,
                                    double at_mm) noexcept {
  const auto after = std::ranges::upper_bound(stretches, at_mm, {}, &Learnt::Stretch::from_mm);
  if (after == stretches.begin() || (after - 1)->to_mm < at_mm) {
    return std::nullopt;
  }
  return knot_at(*(after - 1), at_mm);
}

}  // namespace

Learnt::Knot Learnt::mean(double at_mm) const noexcept {
  Knot sum{.at_mm = at_mm, .weight = 0.0};
  for (const auto& stretches : parts_) {
    if (const auto one = knot_of(stretches, at_mm)) {
      sum.shift_mm = geometry::add_scaled(sum.shift_mm, one->shift_mm, one->weight);
      sum.unknown_mm = geometry::add_scaled(sum.unknown_mm, one->unknown_mm, one->weight);
      sum.weight += one->weight;
    }
  }
  // A single record's weight below 1 fades it out.
  const double share = 1.0 / std::max(1.0, sum.weight);
  sum.shift_mm = geometry::scale(sum.shift_mm, share);
  sum.unknown_mm = geometry::scale(sum.unknown_mm, share);
  return sum;
}

Point Learnt::shift_mm(double at_mm) const noexcept {
  Point sum = mean(at_mm).shift_mm;
  for (const auto& stretches : refinements_) {
    if (const auto one = knot_of(stretches, at_mm)) {
      sum = geometry::add_scaled(sum, one->shift_mm, one->weight);
    }
  }
  return sum;
}

Point Learnt::unknown_mm(double at_mm) const noexcept {
  return mean(at_mm).unknown_mm;
}

}  // namespace steadyrest::contour::offline
