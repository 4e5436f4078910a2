// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <steadyrest/kernel/rt/testing/allocation_guard.hpp>
#include <steadyrest/kernel/units/constants.hpp>
#include <steadyrest/thermal/online/test/governed.hpp>

// Probe readings that come in with the frames.
namespace steadyrest::thermal::online {
namespace {

using kernel::outcome::Reason;
using kernel::signal::ProbeReading;
using kernel::units::kNan;
using test::Governed;
using test::kX;
using test::kZ;

ProbeReading reading(std::uint64_t number, double displacement_mm) {
  return {.number = number, .axis = kZ, .displacement_mm = displacement_mm, .sd_mm = 0.0005};
}

std::size_t taken(const Governed& on) {
  return on.governor.state().axis[kZ].filter.readings;
}

// A port shows its last reading in every frame: taken each time, one reading would count hundreds
// of times.
TEST(FrameProbe, IsTakenOnceHoweverLongItStands) {
  Governed on;
  on.seconds(1200.0);
  const double offset = on.offset_mm()[kZ];
  EXPECT_EQ(on.governor.output().probed.reading.number, 0U);
  on.frame.probe = reading(1, 0.002);
  const auto probed = on.cycle().probed;
  EXPECT_EQ(probed.reading.number, 1U);
  EXPECT_EQ(probed.verdict.reason, Reason::thermal_reading_taken);
  EXPECT_NEAR(probed.verdict.innovation_mm, 0.002, 1e-4);
  EXPECT_NEAR(on.seconds(30.0).offset_mm[kZ], offset - 0.002, 3e-4);
  EXPECT_EQ(taken(on), 1U);
  EXPECT_EQ(on.governor.output().probed.verdict.reason, Reason::thermal_reading_taken)
      << "its verdict remains until the next";
  // 40 µm is far beyond three standard deviations of a model that has just been corrected.
  on.frame.probe = reading(2, 0.040);
  EXPECT_EQ(on.cycle().probed.verdict.reason, Reason::thermal_reading_outlier);
  EXPECT_EQ(taken(on), 2U);
}

TEST(FrameProbe, IsNotTakenWhereItStoodBeforeTheFirstFrame) {
  Governed on;
  on.frame.probe = reading(7, 0.002);
  on.seconds(10.0);
  EXPECT_EQ(taken(on), 0U);
  on.governor.restore(on.governor.state());
  on.frame.probe = reading(8, 0.002);
  on.seconds(10.0);
  EXPECT_EQ(taken(on), 0U) << "made while the layer was away, perhaps";
  on.frame.probe = reading(9, 0.002);
  on.cycle();
  EXPECT_EQ(taken(on), 1U);
  on.frame.probe = reading(1, 0.002);
  on.cycle();
  EXPECT_EQ(taken(on), 2U) << "a port that restarted its count";
}

// Neither lost nor taken with an unknown offset.
TEST(FrameProbe, WaitsForAFrameThatIsFit) {
  Governed on;
  on.seconds(10.0);
  on.frame.probe = reading(1, 0.002);
  on.unfit = Reason::input_stale;
  on.seconds(1.0);
  EXPECT_EQ(taken(on), 0U);
  on.unfit = Reason::none;
  on.cycle();
  EXPECT_EQ(taken(on), 1U);
}

// Each fault of a port, one at a time; none may change the estimate.
TEST(FrameProbe, SaysWhyItWasNotTaken) {
  Governed on;
  on.seconds(10.0);
  const double before = on.governor.output().displacement_mm[kZ];
  on.frame.probe = reading(1, kNan);
  EXPECT_EQ(on.look().probed.verdict.reason, Reason::input_not_finite);
  on.frame.probe = reading(2, 0.002);
  on.frame.probe.sd_mm = -1.0;
  EXPECT_EQ(on.look().probed.verdict.reason, Reason::input_not_finite);
  on.frame.probe = reading(3, 0.002);
  on.frame.probe.axis = 1;
  EXPECT_EQ(on.look().probed.verdict.reason, Reason::none) << "Y is not corrected";
  on.frame.probe = reading(4, 0.002);
  on.frame.probe.axis = on.frame.axis_count;
  EXPECT_EQ(on.look().probed.verdict.reason, Reason::input_out_of_range);
  EXPECT_EQ(taken(on), 0U);
  EXPECT_NEAR(on.governor.output().displacement_mm[kZ], before, 1e-4) << "but for a second's heat";
}

// Where nothing is written the offset asked for is not in force: the probe finds all of the growth.
TEST(FrameProbe, IsOfTheOffsetThatStandsOnTheMachine) {
  Governed on;
  on.seconds(1200.0);
  const double grown = on.governor.output().displacement_mm[kZ];
  on.written = false;
  on.frame.probe = reading(1, grown);
  const auto& out = on.look();
  EXPECT_EQ(out.probed.verdict.reason, Reason::thermal_reading_taken);
  // Nothing is written, so the probe finds the whole growth: the model is right, the innovation 0.
  EXPECT_NEAR(out.probed.verdict.innovation_mm, 0.0, 1e-5);
  on.governor.zero_here();
  EXPECT_NEAR(on.seconds(300.0).offset_mm[kZ], 0.0, 0.2 * grown)
      << "the zero was set without an offset and includes the growth";
}

TEST(FrameProbe, DoesNotAllocate) {
  Governed on;
  on.seconds(10.0);
  const kernel::rt::testing::AllocationGuard guard;
  for (std::uint64_t i = 1; i < 20; ++i) {
    on.frame.probe = reading(i, 0.001);
    on.frame.probe.axis = i % 2 == 0 ? kX : kZ;
    on.seconds(1.0);
  }
  EXPECT_EQ(guard.allocations(), 0U);
}

}  // namespace
}  // namespace steadyrest::thermal::online
