// SPDX-License-Identifier: Apache-2.0
// Ripple that repeats with position is found and predicted; without it nothing changes.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <steadyrest/kernel/rt/testing/allocation_guard.hpp>
#include <steadyrest/motion/offline/test/scenes.hpp>
#include <steadyrest/motion/online/bounded/ripple_estimator.hpp>

namespace steadyrest::motion::offline::test {
namespace {

using online::MotionEstimator;
using online::RippleEstimator;

constexpr double kAmplitude_mm = 0.034e-3;
constexpr double kLength_mm = 7.8125e-3;

/// A slow sine with a wave over the position on top.
Profile rippled(double duration_s) {
  Profile profile = sine(0.15, 0.9, duration_s);
  const auto smooth = profile.at;
  profile.at = [smooth](double t) {
    MotionState s = smooth(t);
    const double w = 2.0 * std::numbers::pi / kLength_mm;
    const double slope = kAmplitude_mm * w * std::cos(w * s.position_mm);
    const double bend = -kAmplitude_mm * w * w * std::sin(w * s.position_mm);
    s.acceleration_mm_s2 =
        s.acceleration_mm_s2 * (1.0 + slope) + bend * s.velocity_mm_s * s.velocity_mm_s;
    s.position_mm += kAmplitude_mm * std::sin(w * s.position_mm);
    s.velocity_mm_s *= 1.0 + slope;
    return s;
  };
  return profile;
}

TEST(Ripple, IsFoundWithItsLengthAndAmplitude) {
  const Record record = offline::record(rippled(4.0), {});
  RippleEstimator e = RippleEstimator::make({}).value();
  EXPECT_FALSE(run(e, record).empty());
  ASSERT_TRUE(e.ripple().active());
  EXPECT_NEAR(e.ripple().length(0), 7.8125, 0.05);
  EXPECT_NEAR(e.ripple().amplitude(0), 0.034, 0.004);
}

TEST(Ripple, ForeseenIsHalfOfTheError) {
  const Record record = offline::record(rippled(4.0), {});
  const double without = scored<MotionEstimator>({}, record, 0.0, 2.0).velocity_rms_mm_s;
  const double with = scored<RippleEstimator>({}, record, 0.0, 2.0).velocity_rms_mm_s;
  RecordProperty("without", std::to_string(without));
  RecordProperty("with", std::to_string(with));
  EXPECT_LT(with, 0.5 * without);
}

/// Line errors repeat with position too, but they are not motion.
TEST(Ripple, IsNotSeenInTheErrorsOfTheLines) {
  for (const Profile& profile : {sine(1.0, 2.0, 4.0), sine(0.2, 2.0, 20.0), sine(0.1, 1.0, 20.0),
                                 s_curve(), constant_speed(5.0, 4.0)}) {
    for (const Recording& how : {Recording{}, line_errors()}) {
      const Record record = offline::record(profile, how);
      EXPECT_EQ(scored<MotionEstimator>({}, record).velocity_rms_mm_s,
                scored<RippleEstimator>({}, record).velocity_rms_mm_s)
          << profile.name;
    }
  }
}

TEST(Ripple, DoesNotAllocate) {
  const Record record = offline::record(rippled(1.0), {});
  RippleEstimator e = RippleEstimator::make({}).value();
  std::size_t at = 0;
  const kernel::rt::testing::AllocationGuard guard;
  for (const Tick& tick : record.ticks) {
    for (; at < record.edges.size() && record.edges[at].t_s <= tick.t_s; ++at) {
      e.edge(record.edges[at]);
    }
    e.tick(tick);
  }
  EXPECT_EQ(guard.allocations(), 0U);
}

TEST(Ripple, GivesNoBoundsAndTakesUnfitInput) {
  RippleEstimator e = RippleEstimator::make({}).value();
  e.edge({std::nan(""), 0.0, 0, 1, 0});
  const Estimate out = e.tick({0.001, 0, 0.0, 0.001});
  EXPECT_FALSE(std::isfinite(out.velocity_bound_mm_s));
  EXPECT_TRUE(std::isfinite(out.velocity_mm_s));
  MotionEstimator::Config unfit;
  unfit.count_mm = -1.0;
  EXPECT_FALSE(RippleEstimator::make(unfit));
}

}  // namespace
}  // namespace steadyrest::motion::offline::test
