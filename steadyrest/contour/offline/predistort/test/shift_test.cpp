// SPDX-License-Identifier: Apache-2.0
// How far a command is from the path: circles, whose distance is the difference of their radii.
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/contour/offline/predistort/shift.hpp>
#include <steadyrest/contour/online/test/paths.hpp>

namespace steadyrest::contour::offline {
namespace {

using online::test::PathMaker;

/// A piece that is the only segment of a path, for this stretch of the original.
Piece shifted_piece(const PathMaker& made, double from_mm, double to_mm, std::uint32_t line = 1) {
  Piece piece;
  piece.segment = made.path().front();
  piece.segment.line = line;
  piece.progress_start_mm = from_mm;
  piece.progress_end_mm = to_mm;
  return piece;
}

// q = 0.4: the command of a circle of 10 mm runs on R·√(1 + q²).
TEST(ShiftOfACommand, OfAWiderCircleIsTheDifferenceOfTheRadii) {
  nc::plan::PlannedPath path;
  path.segments = PathMaker({10, 0, 0}, 50.0).arc({0, 0, 0}, 3.0).path();
  const double wider_mm = 10.0 * std::hypot(1.0, 0.4);
  const auto piece =
      shifted_piece(PathMaker({wider_mm, 0, 0}, 50.0).arc({0, 0, 0}, 3.0), 0.0, 30.0);
  const Shift shift = shift_of(path, {piece}, 0.5);
  EXPECT_NEAR(shift.largest_mm, wider_mm - 10.0, 1e-9);
  EXPECT_EQ(shift.too_far, (std::vector<std::uint32_t>{1}));
}

// A chord of an arc is nearest to it at its ends: the middle, where it sags, counts.
TEST(ShiftOfACommand, LooksBetweenTheEnds) {
  nc::plan::PlannedPath path;
  path.segments = PathMaker({20, 0, 0}, 50.0).arc({0, 0, 0}, 0.2).path();
  const auto end = path.segments.front().end_mm;
  const auto chord = shifted_piece(PathMaker({20, 0, 0}, 50.0).line_to(end), 0.0, 4.0);
  const Shift shift = shift_of(path, {chord}, 1.0);
  EXPECT_NEAR(shift.largest_mm, 20.0 * (1.0 - std::cos(0.1)), 1e-9);
  EXPECT_TRUE(shift.too_far.empty());
}

// The path comes back 0.2 mm beside itself: a command for the one way that runs on the other is a
// whole 0.2 mm off.
TEST(ShiftOfACommand, IsToThePlaceWhereThePieceBelongs) {
  nc::plan::PlannedPath path;
  path.segments = PathMaker({0, 0, 0}, 50.0)
                      .line_to({80, 0, 0})
                      .line_to({80, 0.2, 0})
                      .line_to({0, 0.2, 0})
                      .path();
  for (const double beside_mm : {0.0, 0.2}) {
    const PathMaker made = PathMaker({10, beside_mm, 0}, 50.0).line_to({12, beside_mm, 0});
    const auto out = shifted_piece(made, 10.0, 12.0);
    EXPECT_NEAR(shift_of(path, {out}, 0.1).largest_mm, beside_mm, 1e-9);
    const auto back = shifted_piece(made, 148.2, 150.2);
    EXPECT_NEAR(shift_of(path, {back}, 0.1).largest_mm, 0.2 - beside_mm, 1e-9);
  }
}

TEST(ShiftOfACommand, NamesALineOnceAndNoneWithinTheBound) {
  nc::plan::PlannedPath path;
  path.segments = PathMaker({0, 0, 0}, 50.0).line_to({30, 0, 0}).path();
  std::vector<Piece> pieces;
  for (const auto& [line, off_mm] : {std::pair{4U, 0.3}, {4U, 0.4}, {6U, 0.1}, {9U, 0.3}}) {
    const double from = 5.0 * static_cast<double>(pieces.size());
    pieces.push_back(
        shifted_piece(PathMaker({from, off_mm, 0}, 50.0).line_to({from + 5.0, off_mm, 0}), from,
                      from + 5.0, line));
  }
  const Shift shift = shift_of(path, pieces, 0.25);
  EXPECT_EQ(shift.too_far, (std::vector<std::uint32_t>{4, 9}));
  EXPECT_NEAR(shift.largest_mm, 0.4, 1e-9);
}

// A circle of 10 mm that reaches X489.9 … 499.9 of a travel to 500; its command runs on 10.7 mm.
TEST(TravelOfAPath, NamesTheLinesThatLeaveATravelWhichTheirPathKeeps) {
  nc::plan::PlannedPath path;
  path.segments = PathMaker({499.9, 0, 0}, 50.0).arc({489.9, 0, 0}, 6.28).path();
  const auto piece =
      shifted_piece(PathMaker({500.6, 0, 0}, 50.0).arc({489.9, 0, 0}, 6.28), 0.0, 62.0, 7);
  std::vector<kernel::machine::Axis> axes(3);
  EXPECT_TRUE(Travel(path, axes).left_by({piece}).empty());
  axes[0].max_au = 500.0;
  EXPECT_EQ(Travel(path, axes).left_by({piece}), (std::vector<std::uint32_t>{7}));
  axes[0].max_au = 500.599;
  EXPECT_EQ(Travel(path, axes).left_by({piece}), (std::vector<std::uint32_t>{7}));
  axes[0].max_au = 500.601;
  EXPECT_TRUE(Travel(path, axes).left_by({piece}).empty());
  axes[1].min_au = -10.701;
  EXPECT_TRUE(Travel(path, axes).left_by({piece}).empty());
  axes[1].min_au = -10.699;
  EXPECT_EQ(Travel(path, axes).left_by({piece}), (std::vector<std::uint32_t>{7}));
  axes[1].min_au = 0.0;  // the path itself leaves this travel
  axes[0].max_au = 1000.0;
  EXPECT_EQ(Travel(path, axes).left_by({piece}), (std::vector<std::uint32_t>{7}));
  const auto own =
      shifted_piece(PathMaker({499.9, 0, 0}, 50.0).arc({489.9, 0, 0}, 6.28), 0.0, 62.0);
  EXPECT_TRUE(Travel(path, axes).left_by({own}).empty());
}

}  // namespace
}  // namespace steadyrest::contour::offline
