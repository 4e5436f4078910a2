// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <random>

#include <gtest/gtest.h>

#include <steadyrest/kernel/testing/cases.hpp>
#include <steadyrest/nc/plan/path/corner.hpp>

namespace steadyrest::nc::plan {
namespace {

using kernel::signal::Geometry;
using kernel::signal::PathSegment;
using kernel::testing::kSanitized;

struct Vec {
  double x = 0.0;
  double y = 0.0;
};
double across(Vec a, Vec b) {
  return a.x * b.y - a.y * b.x;
}
double along(Vec a, Vec b) {
  return a.x * b.x + a.y * b.y;
}

/// A line or arc through the origin, where the corner is.
struct Leg {
  bool arc = false;
  double turn = 1.0;  ///< 1 bends to the left
  double radius = 1.0;
  Vec tangent{1.0, 0.0};

  [[nodiscard]] Vec centre() const {
    return {-turn * radius * tangent.y, turn * radius * tangent.x};
  }
  [[nodiscard]] PathSegment segment() const {
    PathSegment out;
    if (arc) {
      out.geometry = Geometry::arc;
      out.axis = {0.0, 0.0, turn};
      out.radius_mm = out.radius_end_mm = radius;
    }
    return out;
  }
};

struct Corner {
  Leg before;
  Leg after;
  CornerRequest request;
};

/// The radius of the one circle that touches the first leg `back_mm` before the corner and is
/// tangent to the second, on the left of both, if it meets the request.
std::optional<double> radius_at(const Corner& corner, double back_mm) {
  const Leg& a = corner.before;
  const Leg& b = corner.after;
  Vec touch{-back_mm, 0.0};
  Vec tangent = a.tangent;
  if (a.arc) {
    const double angle = back_mm / a.radius;
    touch = {-a.radius * std::sin(angle),
             2.0 * a.turn * a.radius * std::pow(std::sin(0.5 * angle), 2)};
    tangent = {std::cos(angle), -a.turn * std::sin(angle)};
  }
  const Vec normal{-tangent.y, tangent.x};
  // 1 − cos of the angle between the tangents, without cancellation.
  const Vec between{b.tangent.x - tangent.x, b.tangent.y - tangent.y};
  const double apart = 0.5 * along(between, between);
  const auto centre_of = [&](double r) {
    return Vec{touch.x + r * normal.x, touch.y + r * normal.y};
  };
  double r = 0.0;
  double taken = 0.0;
  if (b.arc) {
    // |touch + r·normal − c|² = (R − o·r)² with |c| = R: R² and r² cancel.
    const Vec c = b.centre();
    r = (2.0 * along(touch, c) - along(touch, touch)) /
        (2.0 * (along(touch, normal) + b.turn * b.radius * apart));
    const Vec out{centre_of(r).x - c.x, centre_of(r).y - c.y};
    const Vec start{-c.x, -c.y};
    taken = b.turn * b.radius * std::atan2(across(start, out), along(start, out));
    if (b.radius - b.turn * r <= 0.0) {
      return std::nullopt;
    }
  } else {
    // The centre lies r to the left of the line.
    r = across(b.tangent, touch) / apart;
    taken = along(centre_of(r), b.tangent);
  }
  const Vec centre = centre_of(r);
  const bool fits = r > 0.0 && (!a.arc || a.radius - a.turn * r > 0.0) && taken > 0.0 &&
                    taken <= corner.request.room_after_mm &&
                    std::hypot(centre.x, centre.y) - r <= corner.request.tolerance_mm &&
                    r <= corner.request.most_radius_mm;
  return fits ? std::optional(r) : std::nullopt;
}

/// Marches back from the corner until nothing fits. Legs that bend towards each other meet again,
/// so the radius may peak on the way.
double largest_by_marching(const Corner& corner) {
  double good = 0.0;
  double bad = corner.request.room_before_mm;
  double best = 0.0;
  double at_best = 0.0;
  for (double back = 1e-7 * bad; back <= corner.request.room_before_mm; back *= 1.02) {
    const auto r = radius_at(corner, back);
    if (!r) {
      bad = back;
      break;
    }
    good = back;
    if (*r > best) {
      best = *r;
      at_best = back;
    }
  }
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (good + bad);
    (radius_at(corner, middle) ? good : bad) = middle;
  }
  for (int i = -100; i <= 100; ++i) {
    const double back = std::min(good, at_best * (1.0 + 2e-4 * i));
    best = std::max(best, radius_at(corner, back).value_or(0.0));
  }
  return std::max(best, radius_at(corner, good).value_or(0.0));
}

class Draw {
 public:
  Corner corner() {
    Corner out;
    // Small turns as well as sharp ones.
    const double turn_rad = share() < 0.4 ? decades(-3.0, 0.0) : 0.02 + 3.0 * share();
    out.before = leg();
    out.after = leg();
    out.before.arc = out.before.arc || !out.after.arc;  // two lines are a closed form
    out.after.tangent = {std::cos(turn_rad), std::sin(turn_rad)};
    out.request = {.tolerance_mm = decades(-4.0, 0.0),
                   .room_before_mm = room(out.before),
                   .room_after_mm = room(out.after),
                   .most_radius_mm = decades(-1.0, 4.0)};
    return out;
  }

 private:
  double share() { return std::uniform_real_distribution<double>()(random_); }
  double decades(double from, double to) { return std::pow(10.0, from + (to - from) * share()); }
  Leg leg() {
    return {.arc = share() < 0.7, .turn = share() < 0.5 ? 1.0 : -1.0, .radius = decades(-1.0, 2.0)};
  }
  /// Up to half a turn of an arc.
  double room(const Leg& leg) {
    return leg.arc ? std::min(decades(-2.0, 1.0), 3.1 * leg.radius) : decades(-2.0, 1.0);
  }
  std::mt19937_64 random_{8};
};

std::optional<CornerArc> rounded(const Corner& corner) {
  const kernel::signal::Point in{1.0, 0.0, 0.0};
  const kernel::signal::Point out{corner.after.tangent.x, corner.after.tangent.y, 0.0};
  return round_corner(corner.before.segment(), corner.after.segment(), in, out,
                      bend_of(in, out).value(), corner.request);
}

TEST(RoundCorner, IsTheLargestCircleThatFits) {
  Draw draw;
  int wide = 0;
  for (int i = 0; i < (kSanitized ? 50 : 3000); ++i) {
    const Corner corner = draw.corner();
    const double want = largest_by_marching(corner);
    const auto arc = rounded(corner);
    ASSERT_TRUE(arc.has_value()) << i;
    EXPECT_NEAR(arc->radius_mm, want, 1e-4 * want) << i;
    EXPECT_LE(arc->taken_before_mm, corner.request.room_before_mm * (1.0 + 1e-6)) << i;
    EXPECT_LE(arc->taken_after_mm, corner.request.room_after_mm * (1.0 + 1e-6)) << i;
    EXPECT_LE(std::hypot(arc->centre_mm[0], arc->centre_mm[1]) - arc->radius_mm,
              corner.request.tolerance_mm * (1.0 + 1e-6))
        << i;
    wide += want > corner.before.radius && want > corner.after.radius ? 1 : 0;
  }
  EXPECT_GT(wide, kSanitized ? 0 : 100);
}

// Two circles that bend away from the corner have a common tangent within the tolerance: every
// radius fits, and the search must end.
TEST(RoundCorner, EndsWhereEveryRadiusFits) {
  Corner corner;
  corner.before = {.arc = true, .turn = -1.0, .radius = 1.0};
  corner.after = {.arc = true, .turn = -1.0, .radius = 1.0};
  corner.after.tangent = {std::cos(0.1), std::sin(0.1)};
  corner.request = {.tolerance_mm = 1.0,
                    .room_before_mm = 1.0,
                    .room_after_mm = 1.0,
                    .most_radius_mm = std::numeric_limits<double>::infinity()};
  const auto arc = rounded(corner);
  ASSERT_TRUE(arc.has_value());
  EXPECT_GT(arc->radius_mm, 1e6);
  EXPECT_TRUE(std::isfinite(arc->radius_mm));
  // Half the turn lies on either side, so each arc loses that much of its length.
  EXPECT_NEAR(arc->taken_before_mm, 0.05, 1e-5);
  EXPECT_NEAR(arc->taken_after_mm, 0.05, 1e-5);
}

}  // namespace
}  // namespace steadyrest::nc::plan
