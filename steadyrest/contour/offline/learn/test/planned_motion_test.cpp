// SPDX-License-Identifier: Apache-2.0
// The planned motion as a table: when the command is where, and what the model expects there.
#include <gtest/gtest.h>

#include <steadyrest/contour/offline/learn/learnt.hpp>
#include <steadyrest/contour/offline/learn/planned_motion.hpp>

namespace steadyrest::contour::offline {
namespace {

using kernel::signal::Point;

ModelSample sample(double time_s, double position_mm, double speed_mm_s, double foot_mm,
                   const Point& off_mm, bool cuts = true) {
  ModelSample out;
  out.time_s = time_s;
  out.position_mm = position_mm;
  out.command_mm_s = speed_mm_s;
  out.foot_mm = foot_mm;
  out.off_mm = off_mm;
  out.cuts = cuts;
  return out;
}

/// 10 mm in 1 s, half a second of standing, 10 mm in 0.5 s.
PlannedMotion with_a_dwell() {
  PlannedMotion plan;
  plan.add(sample(0.0, 0.0, 10.0, 0.0, {0.0, 0.000, 0.0}));
  plan.add(sample(1.0, 10.0, 10.0, 9.8, {0.0, 0.004, 0.0}));
  plan.add(sample(1.5, 10.0, 0.0, 10.0, {0.0, 0.000, 0.0}));
  plan.add(sample(2.0, 20.0, 20.0, 19.6, {0.0, 0.008, 0.0}));
  return plan;
}

TEST(PlannedMotion, KnowsWhenTheCommandIsWhere) {
  const PlannedMotion plan = with_a_dwell();
  EXPECT_FALSE(plan.empty());
  EXPECT_NEAR(plan.stay(5.0).from_s, 0.5, 1e-5);
  EXPECT_NEAR(plan.stay(5.0).to_s, 0.5, 1e-5);
  EXPECT_NEAR(plan.stay(15.0).from_s, 1.75, 1e-5);
}

TEST(PlannedMotion, KnowsHowLongItStands) {
  const auto stay = with_a_dwell().stay(10.0);
  EXPECT_NEAR(stay.from_s, 1.0, 1e-5);
  EXPECT_NEAR(stay.to_s, 1.5, 1e-5);
}

TEST(PlannedMotion, InterpolatesSpeedAndErrorAndHoldsTheEnds) {
  const PlannedMotion plan = with_a_dwell();
  EXPECT_NEAR(plan.speed_mm_s(4.0), 10.0, 1e-12);
  EXPECT_NEAR(plan.speed_mm_s(15.0), 10.0, 1e-12);
  EXPECT_NEAR(plan.off_mm(4.9)[1], 0.002, 1e-12);
  EXPECT_NEAR(plan.off_mm(14.8)[1], 0.004, 1e-12);
  EXPECT_NEAR(plan.off_mm(-3.0)[1], 0.0, 1e-12);
  EXPECT_NEAR(plan.off_mm(99.0)[1], 0.008, 1e-12);
}

// Where nothing is cut no error counts, and a foot that stays at a corner counts once, the first.
TEST(PlannedMotion, TakesErrorsOfCutsAndTheFirstOfACorner) {
  PlannedMotion plan;
  plan.add(sample(0.0, 0.0, 10.0, 0.0, {0.5, 0.0, 0.0}, false));
  EXPECT_TRUE(plan.empty());
  plan.add(sample(1.0, 10.0, 10.0, 9.0, {0.001, 0.0, 0.0}));
  plan.add(sample(1.1, 10.5, 10.0, 9.0, {0.020, 0.0, 0.0}));
  plan.add(sample(2.0, 20.0, 10.0, 19.0, {0.003, 0.0, 0.0}));
  EXPECT_NEAR(plan.off_mm(9.0)[0], 0.001, 1e-12);
  EXPECT_NEAR(plan.off_mm(14.0)[0], 0.002, 1e-12);
}

TEST(PlannedMotion, OfNothingIsNothing) {
  const PlannedMotion plan;
  EXPECT_EQ(plan.stay(3.0).to_s, 0.0);
  EXPECT_EQ(plan.speed_mm_s(3.0), 0.0);
  EXPECT_EQ(plan.off_mm(3.0), Point{});
}

Learnt::Knot knot(double at_mm, double shift_mm, double weight = 1.0) {
  return {.at_mm = at_mm,
          .shift_mm = {shift_mm, 0.0, 0.0},
          .unknown_mm = {-shift_mm, 0.0, 0.0},
          .weight = weight};
}

TEST(Learnt, IsALineBetweenKnotsAndNothingOutsideItsStretches) {
  Learnt learnt;
  learnt.add({{.from_mm = 1.0, .to_mm = 9.0, .knots = {knot(2.0, 0.002), knot(8.0, 0.008)}},
              {.from_mm = 20.0, .to_mm = 30.0, .knots = {knot(25.0, 0.001)}}});
  EXPECT_NEAR(learnt.shift_mm(5.0)[0], 0.005, 1e-12);
  EXPECT_NEAR(learnt.unknown_mm(5.0)[0], -0.005, 1e-12);
  EXPECT_NEAR(learnt.shift_mm(1.2)[0], 0.002, 1e-12);  // the first knot holds to the corner
  EXPECT_NEAR(learnt.shift_mm(28.0)[0], 0.001, 1e-12);
  for (const double outside : {0.5, 9.5, 19.0, 31.0}) {
    EXPECT_EQ(learnt.shift_mm(outside), Point{}) << outside;
  }
}

// Where one part was disturbed the other counts; a single faded one fades.
TEST(Learnt, WeighsPartsByHowSureTheyAre) {
  Learnt learnt;
  learnt.add({{.from_mm = 0.0, .to_mm = 10.0, .knots = {knot(5.0, 0.002)}}});
  learnt.add({{.from_mm = 0.0, .to_mm = 10.0, .knots = {knot(5.0, 0.008, 0.5)}}});
  EXPECT_NEAR(learnt.shift_mm(5.0)[0], (0.002 + 0.5 * 0.008) / 1.5, 1e-12);
  Learnt faded;
  faded.add({{.from_mm = 0.0, .to_mm = 10.0, .knots = {knot(5.0, 0.008, 0.25)}}});
  EXPECT_NEAR(faded.shift_mm(5.0)[0], 0.002, 1e-12);
}

}  // namespace
}  // namespace steadyrest::contour::offline
