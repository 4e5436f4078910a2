// SPDX-License-Identifier: Apache-2.0
// The heart of the proof: where a changed program may move the tool, move by move.
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/nc/rewrite/prove/shifts.hpp>

namespace steadyrest::nc::rewrite {
namespace {

using interpret::Axes;
using interpret::Move;
using interpret::MoveKind;
using ::testing::HasSubstr;

constexpr std::size_t kX = 0;
constexpr std::size_t kZ = 2;

/// A plan that corrects Z.
Plan plan_of_z() {
  Plan plan;
  plan.axes.push_back(
      {.letter = 'Z', .index = kZ, .steps = {{.time_s = 0.0, .displacement_um = 10.0}}});
  return plan;
}

Move line(const Axes& start, const Axes& end, double offset_z_mm = 0.0,
          MoveKind kind = MoveKind::linear) {
  Move move;
  move.kind = kind;
  move.start = start;
  move.end = end;
  move.offset[kZ] = offset_z_mm;
  move.normal = {0, 0, 1};
  return move;
}

/// A proof that is under way: pairs of moves whose changed one has the work coordinates of the
/// original and an offset of its own.
class ShiftsOfZ : public ::testing::Test {
 protected:
  /// The fault of a pair from `from` to `to`, whose changed move begins and ends shifted in Z.
  std::string pair(const Axes& from, const Axes& to, double start_mm, double end_mm,
                   const Frames& frames = {}, MoveKind kind = MoveKind::linear) {
    Move changed = line(from, to, 0.0, kind);
    changed.start[kZ] += start_mm;
    changed.end[kZ] += end_mm;
    return shifts_.pair(line(from, to, 0.0, kind), changed, frames);
  }
  Shifts shifts_{plan_of_z()};
};

TEST_F(ShiftsOfZ, AMoveEndsWhereThePlanSays) {
  EXPECT_EQ(pair({0, 0, 0}, {10, 0, -1}, 0.0, 0.0), "");
  shifts_.wanted[kZ] = -0.01;
  EXPECT_EQ(pair({10, 0, -1}, {20, 0, -2}, 0.0, -0.01), "");
  EXPECT_NEAR(shifts_.now(kZ), -0.01, 1e-15);
  EXPECT_TRUE(shifts_.any());
  // A nanometre is the limit: 1.1 nm is not the same place.
  EXPECT_EQ(pair({20, 0, -2}, {30, 0, -3}, -0.01, -0.01 + 0.9e-9), "");
  EXPECT_THAT(pair({30, 0, -3}, {40, 0, -4}, -0.01, -0.01 + 2.1e-9), HasSubstr("Z is off by"));
  EXPECT_NEAR(shifts_.largest_error_mm(), 0.9e-9, 1e-12);
}

TEST_F(ShiftsOfZ, TheSameShiftByTheOffsetIsTheSame) {
  shifts_.wanted[kZ] = -0.01;
  const Move before = line({0, 0, 5}, {0, 0, 2}, 100.0);
  // The machine's start is the same: the work position went the other way when the offset changed.
  Move after = line({0, 0, 5.01}, {0, 0, 2}, 99.99);
  EXPECT_EQ(shifts_.pair(before, after, {}), "");
  EXPECT_NEAR(shifts_.now(kZ), -0.01, 1e-12);
}

TEST_F(ShiftsOfZ, AMoveBeginsWhereTheOneBeforeEnded) {
  EXPECT_THAT(pair({0, 0, 0}, {10, 0, 0}, 0.005, 0.0), HasSubstr("begins where the one before"));
  shifts_.wanted[kZ] = -0.01;
  EXPECT_EQ(pair({0, 0, 0}, {0, 0, 1}, 0.0, -0.01), "");
  EXPECT_THAT(pair({0, 0, 1}, {0, 0, 2}, 0.0, -0.01), HasSubstr("begins where the one before"));
}

TEST_F(ShiftsOfZ, AnAxisWithoutAPlanStaysWhereItIs) {
  Move changed = line({0, 0, 0}, {10, 0, 0});
  changed.end[kX] = 10.001;
  EXPECT_THAT(shifts_.pair(line({0, 0, 0}, {10, 0, 0}), changed, {}),
              HasSubstr("X is off by 0.001000000 mm after this line; the plan has 0.000000 mm"));
}

// The correction waits for the next word of its axis: until then the old shift is right.
TEST_F(ShiftsOfZ, AnAxisThatIsNotProgrammedMayKeepItsShift) {
  shifts_.wanted[kZ] = -0.01;
  EXPECT_EQ(pair({0, 0, -1}, {10, 0, -1}, 0.0, 0.0), "");
  EXPECT_EQ(shifts_.now(kZ), 0.0);
  EXPECT_THAT(pair({10, 0, -1}, {20, 0, -1}, 0.0, -0.004), HasSubstr("Z is off by"));
  // Where it must act at once, keeping is a fault.
  EXPECT_THAT(pair({10, 0, -1}, {20, 0, -1}, 0.0, 0.0, {.acts_at_once = axis_bit(kZ)}),
              HasSubstr("Z is off by"));
}

TEST_F(ShiftsOfZ, IncrementsKeepTheShift) {
  shifts_.wanted[kZ] = -0.01;
  EXPECT_THAT(pair({0, 0, 0}, {0, 0, 1}, 0.0, 0.0), HasSubstr("Z is off by"));
  EXPECT_EQ(pair({0, 0, 0}, {0, 0, 1}, 0.0, 0.0, {.incremental = true}), "");
}

TEST_F(ShiftsOfZ, MachineCoordinatesHaveNoShift) {
  shifts_.wanted[kZ] = -0.01;
  EXPECT_EQ(pair({0, 0, 0}, {0, 0, 1}, 0.0, -0.01), "");
  EXPECT_EQ(pair({0, 0, 1}, {0, 0, 50}, -0.01, 0.0, {.machine = true}), "");
  EXPECT_FALSE(shifts_.any());
  EXPECT_THAT(pair({0, 0, 50}, {0, 0, 60}, 0.0, -0.005, {.machine = true}), HasSubstr("Z is off"));
}

TEST_F(ShiftsOfZ, NoCorrectionBeginsInACurve) {
  shifts_.wanted[kZ] = -0.01;
  for (const MoveKind kind : {MoveKind::arc, MoveKind::spline, MoveKind::thread, MoveKind::probe}) {
    EXPECT_THAT(pair({0, 0, 0}, {10, 0, -1}, 0.0, -0.01, {}, kind), HasSubstr("would bend it"));
  }
  // The whole curve shifted is the same curve.
  ASSERT_EQ(pair({0, 0, 0}, {0, 0, -1}, 0.0, -0.01), "");
  Move arc = line({0, 0, -1}, {10, 0, -2}, 0.0, MoveKind::arc);
  arc.centre_mm = {5, 0, -1};
  Move shifted = arc;
  shifted.offset[kZ] = -0.01;
  EXPECT_EQ(shifts_.pair(arc, shifted, {}), "");
}

TEST_F(ShiftsOfZ, ACentreIsWhereTheArcIs) {
  Move arc = line({0, 0, 0}, {10, 0, 0}, 0.0, MoveKind::arc);
  arc.centre_mm = {5, 0, 0};
  Move other = arc;
  other.centre_mm[1] = 0.002;
  EXPECT_THAT(shifts_.pair(arc, other, {}),
              HasSubstr("the centre of an arc is off by 0.002000000 mm in Y"));
  // Along the normal it has no meaning.
  other = arc;
  other.centre_mm[2] = 7.0;
  EXPECT_EQ(shifts_.pair(arc, other, {}), "");
}

TEST_F(ShiftsOfZ, PointsOfASplineAreTheOriginals) {
  const interpret::SplinePoint points[] = {{0, 0, 1}, {5, 5, 1}, {10, 0, 1}};
  const interpret::SplinePoint heavier[] = {{0, 0, 1}, {5, 5, 1.5}, {10, 0, 1}};
  const interpret::SplinePoint moved[] = {{0, 0, 1}, {5, 5.001, 1}, {10, 0, 1}};
  Move spline = line({0, 0, 0}, {10, 0, 0}, 0.0, MoveKind::spline);
  spline.spline = points;
  Move other = spline;
  EXPECT_EQ(shifts_.pair(spline, other, {}), "");
  other.spline = heavier;
  EXPECT_EQ(shifts_.pair(spline, other, {}), "the points of a spline differ");
  other.spline = moved;
  EXPECT_EQ(shifts_.pair(spline, other, {}), "the points of a spline differ");
}

// Work coordinates turned by 90°: a shift of the work's X moves the machine's Y.
TEST_F(ShiftsOfZ, AreThoseOfTheMachineWhateverTheRotation) {
  Move before = line({0, 0, 0}, {10, 0, -1});
  before.rotation_deg = 90.0;
  Move after = before;
  EXPECT_EQ(shifts_.pair(before, after, {}), "");
  after.start = before.end;
  Move next = before;
  next.start = before.end;
  next.end = {20, 0, -2};
  after.end = {20.5, 0, -2};
  EXPECT_THAT(shifts_.pair(next, after, {}), HasSubstr("Y is off by 0.5"));
}

TEST_F(ShiftsOfZ, AnInsertedMoveIsARapidOfAPlannedAxisAlone) {
  EXPECT_EQ(shifts_.add(line({0, 0, 0}, {0, 0, 0.01}, 0.0, MoveKind::rapid), 0.02), "");
  EXPECT_DOUBLE_EQ(shifts_.now(kZ), 0.01);
  EXPECT_THAT(shifts_.add(line({0, 0, 0}, {0, 0, 0.01}), 0.02), HasSubstr("not by a rapid"));
  EXPECT_THAT(shifts_.add(line({0, 0, 0}, {0, 0, 0.021}, 0.0, MoveKind::rapid), 0.02),
              HasSubstr("more than a correction"));
  EXPECT_THAT(shifts_.add(line({0, 0, 0}, {0.001, 0, 0}, 0.0, MoveKind::rapid), 0.02),
              HasSubstr("more than a correction"));
  EXPECT_EQ(shifts_.add(line({0, 0, 0}, {0, 0, -0.02}, 0.0, MoveKind::rapid), 0.02), "");
  EXPECT_DOUBLE_EQ(shifts_.now(kZ), -0.01);
}

}  // namespace
}  // namespace steadyrest::nc::rewrite
