// SPDX-License-Identifier: Apache-2.0
// What a line that both programs execute may do otherwise: next to nothing. Each limit is tried
// from both sides.
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/nc/rewrite/tube/same_line.hpp>
#include <steadyrest/nc/rewrite/tube/test/made_moves.hpp>

namespace steadyrest::nc::rewrite {
namespace {

using interpret::Move;
using interpret::MoveKind;
using test::made_arc;
using test::made_line;
using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr double kLineTube_mm = 0.5;
constexpr double kLineRounding_mm = 5e-4;

std::string kept_difference_of(const Move& original, const Move& changed,
                               const Permitted& permitted = {.path = true}) {
  return line_difference(
      {.original = {&original, 1}, .changed = {&changed, 1}, .rounding_mm = kLineRounding_mm},
      permitted);
}

/// The same move with its start and end elsewhere in Y.
Move moved_in_y(Move move, double start_mm, double end_mm = 0.0) {
  move.start[1] += start_mm;
  move.end[1] += end_mm;
  return move;
}

TEST(SameLine, EndsWhereTheOriginalEnds) {
  const Move original = made_line({0, 0, 0}, {10, 5, 0});
  EXPECT_EQ(kept_difference_of(original, moved_in_y(original, 0.0, 0.9e-6)), "");
  EXPECT_EQ(kept_difference_of(original, moved_in_y(original, 0.0, 2e-6)),
            "ends 0.000002 mm from where the original's ends in Y");
  EXPECT_THAT(kept_difference_of(original, moved_in_y(original, 0.0, -0.25)),
              StartsWith("ends 0.250000 mm"));
}

// An axis that is not named goes on being where the rounding of a block before it has left it.
TEST(SameLine, CarriesTheRoundingOfAnAxisThatIsNotNamed) {
  const Move original = made_line({0, 5, 0}, {10, 5, 0});
  EXPECT_EQ(kept_difference_of(original, moved_in_y(original, 4e-4, 4e-4)), "");
  EXPECT_NE(kept_difference_of(original, moved_in_y(original, 4e-4, -4e-4)), "");
  EXPECT_NE(kept_difference_of(original, moved_in_y(original, 6e-4, 6e-4)), "");
}

// LinuxCNC accepts an arc whose radii differ by 0.00005 inch.
TEST(SameLine, StartsWithinTheTubeOrTheSlackOfAnArc) {
  constexpr double kLinuxcnc_mm = 0.00005 * 25.4;
  Move move = made_line({0, 0, 0}, {10, 5, 0});
  const auto starts_off = [&](double off_mm) {
    return kept_difference_of(move, moved_in_y(move, off_mm));
  };
  for (const MoveKind kind : {MoveKind::rapid, MoveKind::linear}) {
    move.kind = kind;
    EXPECT_EQ(starts_off(0.99 * kLineTube_mm), "");
    EXPECT_THAT(starts_off(1.01 * kLineTube_mm), HasSubstr("0.500000 mm are allowed"));
  }
  for (const MoveKind kind : {MoveKind::spline, MoveKind::probe, MoveKind::thread}) {
    move.kind = kind;
    EXPECT_EQ(starts_off(0.99 * kLineRounding_mm), "");
    EXPECT_THAT(starts_off(1.02 * kLineRounding_mm), StartsWith("starts "));
  }
  move = made_arc({0, 0, 0}, {10, 0, 0}, {5, 0, 0}, 1);
  EXPECT_EQ(starts_off(0.99 * kLinuxcnc_mm), "");
  EXPECT_THAT(starts_off(1.01 * kLinuxcnc_mm), StartsWith("starts "));
}

TEST(SameLine, MakesAsManyMovesInTheSameOffset) {
  const std::vector<Move> two(2, made_line({0, 0, 0}, {1, 0, 0}));
  EXPECT_THAT(line_difference({.original = two, .changed = {two.data(), 1}, .rounding_mm = 0.0},
                              Permitted{.path = true}),
              HasSubstr("more or fewer moves"));
  Move shifted = two[0];
  shifted.offset[0] = 2e-9;
  EXPECT_THAT(kept_difference_of(two[0], shifted), HasSubstr("in its offset"));
  Move machine = two[0];
  machine.machine_axes = 1;
  EXPECT_THAT(kept_difference_of(two[0], machine), HasSubstr("in its offset"));
}

}  // namespace
}  // namespace steadyrest::nc::rewrite
