// SPDX-License-Identifier: Apache-2.0
// The leaping search against one that looks everywhere.
#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <steadyrest/contour/online/search/window_search.hpp>
#include <steadyrest/kernel/units/constants.hpp>
#include <steadyrest/math/geometry/test/segments.hpp>

namespace steadyrest::contour::online {
namespace {

namespace geometry = math::geometry;
using geometry::test::number;
using kernel::signal::Point;

/// A polyline by its corners; counts how many of its pieces were evaluated.
class Polyline {
 public:
  explicit Polyline(std::vector<Point> corner) : corner_(std::move(corner)), at_mm_{0.0} {
    for (std::size_t i = 1; i < corner_.size(); ++i) {
      at_mm_.push_back(at_mm_.back() + geometry::distance(corner_[i - 1], corner_[i]));
    }
  }
  [[nodiscard]] std::size_t size() const { return corner_.size() - 1; }
  [[nodiscard]] double begin_mm(std::size_t i) const { return at_mm_[i]; }
  [[nodiscard]] double end_mm(std::size_t i) const { return at_mm_[i + 1]; }
  [[nodiscard]] const Point& start(std::size_t i) const { return corner_[i]; }
  [[nodiscard]] const Point& end(std::size_t i) const { return corner_[i + 1]; }
  [[nodiscard]] double length_mm() const { return at_mm_.back(); }

  [[nodiscard]] Nearest foot(std::size_t i, const Point& query, double low, double high,
                             double /*guess*/) const {
    ++looks;
    const Point along = geometry::subtract(end(i), start(i));
    const double length = end_mm(i) - begin_mm(i);
    const double from = std::clamp((low - begin_mm(i)) / length, 0.0, 1.0);
    const double to = std::clamp((high - begin_mm(i)) / length, 0.0, 1.0);
    const double u = std::clamp(
        geometry::dot(geometry::subtract(query, start(i)), along) / (length * length), from, to);
    const Point point = geometry::add_scaled(start(i), along, u);
    return {i, begin_mm(i) + u * length, geometry::distance(point, query), u, point, true};
  }

  mutable int looks = 0;

 private:
  std::vector<Point> corner_;
  std::vector<double> at_mm_;
};

/// Steps of 0.05 … 3 mm in any direction: crosses itself, doubles back, turns by any angle.
Polyline random_line() {
  std::vector<Point> corner = {{0, 0, 0}};
  const int pieces = *rc::gen::inRange(1, 60);
  for (int i = 0; i < pieces; ++i) {
    const double angle = *number(0.0, kernel::units::kTurn);
    const double length = *number(0.05, 3.0);
    corner.push_back(geometry::add(
        corner.back(), {length * std::cos(angle), length * std::sin(angle), *number(-0.2, 0.2)}));
  }
  return Polyline(corner);
}

RC_GTEST_PROP(WindowSearch, FindsTheNearestPointOfTheWindowWhereverItBegins, ()) {
  const Polyline line = random_line();
  const double low = *number(0.0, line.length_mm());
  const double high = *number(low, line.length_mm());
  const Point query{*number(-4.0, 4.0), *number(-4.0, 4.0), 0.0};
  const auto hint = *rc::gen::inRange<std::size_t>(0, 2 * line.size());
  const double guess = *number(-5.0, line.length_mm() + 5.0);
  const Nearest found = nearest_in_window(line, query, low, high, hint, guess, 1000);
  double truth = kernel::units::kInfinity;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line.end_mm(i) >= low && line.begin_mm(i) <= high) {
      truth = std::min(truth, line.foot(i, query, low, high, guess).distance_mm);
    }
  }
  RC_ASSERT(found.complete);
  RC_ASSERT(std::abs(found.distance_mm - truth) <= 1e-9);
  RC_ASSERT(found.position_mm >= low - 1e-9);
  RC_ASSERT(found.position_mm <= high + 1e-9);
}

// Against the definition: the first piece whose end is not before the position.
RC_GTEST_PROP(WindowSearch, FindsThePieceOfAPositionFromAnyHint, ()) {
  const Polyline line = random_line();
  const double position = *number(-1.0, line.length_mm() + 1.0);
  const auto hint = *rc::gen::inRange<std::size_t>(0, 2 * line.size());
  const std::size_t found = find_piece(line, hint, position);
  RC_ASSERT(found < line.size());
  RC_ASSERT(found == 0 || line.begin_mm(found) <= position);
  RC_ASSERT(found + 1 == line.size() || line.end_mm(found) >= position);
}

/// A straight of `pieces` lines of 0.1 mm each.
Polyline straight(int pieces) {
  std::vector<Point> corner;
  for (int i = 0; i <= pieces; ++i) {
    corner.push_back({0.1 * i, 0.0, 0.0});
  }
  return Polyline(corner);
}

// Next to a foot every other piece is as far away as its distance along the path: each leap is as
// long as the way so far, and 200 pieces on either side take log₂ 200 < 8 of them.
TEST(WindowSearch, LeapsOverWhatCannotBeNearer) {
  const Polyline line = straight(400);
  const Nearest found = nearest_in_window(line, {20.03, 0.01, 0.0}, 0.0, 40.0, 200, 20.0, 160);
  EXPECT_TRUE(found.complete);
  EXPECT_NEAR(found.distance_mm, 0.01, 1e-12);
  EXPECT_LE(line.looks, 16);
}

// Seen from its centre a circle is equally near everywhere: nothing can be excluded, and the bound
// ends the search with the answer that it is not complete.
TEST(WindowSearch, SaysSoWhenItsBoundEndsIt) {
  std::vector<Point> corner;
  for (int i = 0; i <= 500; ++i) {
    const double angle = kernel::units::kTurn * i / 500.0;
    corner.push_back({10.0 * std::cos(angle), 10.0 * std::sin(angle), 0.0});
  }
  const Polyline circle(corner);
  const double whole = circle.length_mm();
  const Nearest cut_short = nearest_in_window(circle, {0, 0, 0}, 0.0, whole, 250, 31.0, 160);
  EXPECT_FALSE(cut_short.complete);
  EXPECT_LE(circle.looks, 160);
  EXPECT_NEAR(cut_short.distance_mm, 10.0, 0.001);
  EXPECT_TRUE(nearest_in_window(circle, {0, 0, 0}, 0.0, whole, 250, 31.0, 1200).complete);
}

}  // namespace
}  // namespace steadyrest::contour::online
