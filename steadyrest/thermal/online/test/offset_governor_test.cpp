// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>

#include <steadyrest/kernel/rt/testing/allocation_guard.hpp>
#include <steadyrest/kernel/units/constants.hpp>
#include <steadyrest/thermal/online/test/governed.hpp>

namespace steadyrest::thermal::online {
namespace {

using kernel::outcome::Reason;
using kernel::signal::Motion;
using kernel::units::kNan;
using test::Governed;
using test::kLevel_mm;
using test::kTau_s;
using test::kX;
using test::kZ;
using test::mill;

TEST(OffsetGovernor, StandsAgainstWhatTheSpindleHasDone) {
  Governed on;
  const auto out = on.seconds(1200.0);
  // Half the speed of the table is half the level: G·(1 − e^(−t/τ)).
  const double grown = 0.5 * kLevel_mm * (1.0 - std::exp(-1200.0 / kTau_s));
  EXPECT_NEAR(out.displacement_mm[kZ], grown, 1e-5 * kLevel_mm + kLevel_mm / kTau_s);
  EXPECT_NEAR(out.offset_mm[kZ], -grown, 1e-4);
  EXPECT_EQ(out.request.reason, Reason::thermal_correcting);
  EXPECT_EQ(out.request.room, kernel::signal::Room::thermal);
}

// 0.004 rev/s is the noise of a stationary encoder and must not keep the spindle "turning".
TEST(OffsetGovernor, APauseOfTheJobIsAPauseOfItsHeat) {
  Governed on;
  on.seconds(900.0);
  on.frame.spindle_actual_rev_s = 0.004;
  on.frame.motion = Motion::idle;
  const double warm = on.governor.output().displacement_mm[kZ];
  const auto out = on.seconds(600.0);
  EXPECT_NEAR(out.displacement_mm[kZ], warm * std::exp(-600.0 / kTau_s), 1e-4);
  EXPECT_NEAR(out.offset_mm[kZ], -out.displacement_mm[kZ], 1e-4);
}

// Levels are linear in this passport, so alternating 40 and 60 rev/s heat like 50.
TEST(OffsetGovernor, ASpeedThatSwingsCountsWithItsMean) {
  Governed swings;
  Governed constant;
  for (int i = 0; i < 6000; ++i) {
    swings.frame.spindle_actual_rev_s = i % 2 == 0 ? 40.0 : 60.0;
    swings.cycle();
    constant.cycle();
  }
  EXPECT_NEAR(swings.governor.output().displacement_mm[kZ],
              constant.governor.output().displacement_mm[kZ], 1e-4 * kLevel_mm);
}

// X has no mode, only the room: it shows the sensor alone.
TEST(OffsetGovernor, FollowsTheRoomByItsSensor) {
  Governed on;
  on.frame.temperature_c[0] = 23.0;
  const auto out = on.seconds(60.0);
  // 3 K over the reference at 2 µm/K.
  EXPECT_NEAR(out.displacement_mm[kX], 0.006, 1e-12);
  EXPECT_NEAR(out.offset_mm[kX], -0.006, 1e-12);
  EXPECT_EQ(out.displacement_mm[1], 0.0) << "Y has no passport";
}

// A thread is recut on the same lead, and a probe measures with the offset that it began with.
TEST(OffsetGovernor, HoldsStillInThreadsTapsAndProbing) {
  for (const Motion motion : {Motion::thread, Motion::tap, Motion::probe}) {
    Governed on;
    const double before = on.seconds(100.0).offset_mm[kZ];
    on.frame.motion = motion;
    const auto out = on.seconds(30.0);
    EXPECT_EQ(out.offset_mm[kZ], before);
    EXPECT_EQ(out.request.reason, Reason::thermal_held);
    EXPECT_GT(out.displacement_mm[kZ], -before) << "the heat goes on";
  }
}

// At 100 rev/s the level is 40 µm against a clamp of 30.
TEST(OffsetGovernor, GoesNoFurtherThanTheClampAndSaysSo) {
  Governed on;
  on.frame.spindle_actual_rev_s = 100.0;
  const auto out = on.seconds(3600.0);
  EXPECT_EQ(out.offset_mm[kZ], -0.030);
  EXPECT_EQ(out.request.reason, Reason::thermal_clamped);
}

TEST(OffsetGovernor, HoldsAboveTheSpeedsThatWereFitted) {
  Governed on;
  const double before = on.seconds(100.0).offset_mm[kZ];
  // The passport was fitted up to 100 rev/s; a fifth more is allowed.
  on.frame.spindle_actual_rev_s = 121.0;
  EXPECT_EQ(on.seconds(20.0).request.reason, Reason::thermal_beyond_speed);
  EXPECT_EQ(on.offset_mm()[kZ], before);
}

TEST(OffsetGovernor, UnfitFramesMoveNothing) {
  Governed on;
  const auto before = on.seconds(100.0).offset_mm;
  on.unfit = Reason::input_stale;
  EXPECT_EQ(on.seconds(10.0).request.reason, Reason::input_stale);
  EXPECT_EQ(on.offset_mm(), before);
  on.unfit = Reason::none;
  on.frame.time_s = kNan;
  EXPECT_EQ(on.cycle().request.reason, Reason::input_not_finite);
  EXPECT_EQ(on.offset_mm(), before);
}

TEST(OffsetGovernor, AReadingIsOfWhatIsLeftAndCorrectsTheModel) {
  Governed on;
  on.seconds(1200.0);
  const double offset = on.offset_mm()[kZ];
  const auto verdict = on.governor.measure(kZ, {.displacement_mm = 0.002});
  EXPECT_EQ(verdict.reason, Reason::thermal_reading_taken);
  EXPECT_NEAR(verdict.innovation_mm, 0.002, 1e-4);
  EXPECT_NEAR(on.seconds(30.0).offset_mm[kZ], offset - 0.002, 3e-4);
  EXPECT_EQ(on.governor.measure(1, {.displacement_mm = 0.002}).reason, Reason::none);
}

TEST(OffsetGovernor, HoldsWhenTheReadingsNoLongerFit) {
  Governed on;
  on.seconds(1200.0);
  // At least four innovations are needed to condemn a model, and these are clipped at 3 each: 36 >
  // χ².
  for (int i = 0; i < 4; ++i) {
    on.seconds(60.0);
    on.governor.measure(kZ, {.displacement_mm = 0.040});
  }
  const double before = on.offset_mm()[kZ];
  EXPECT_EQ(on.seconds(60.0).request.reason, Reason::thermal_model_unfit);
  EXPECT_EQ(on.offset_mm()[kZ], before);
  on.governor.rezero(kZ, {.displacement_mm = 0.004, .sd_mm = 0.0005});
  EXPECT_NEAR(on.seconds(60.0).offset_mm[kZ], before - 0.004, 1e-3);
}

// The request was not in force: the reading is the whole displacement.
TEST(OffsetGovernor, RezeroCountsTheOffsetInForceNotTheOneAskedFor) {
  Governed on;
  on.seconds(1200.0);
  ASSERT_LT(on.offset_mm()[kZ], -0.015);
  on.written = false;
  on.frame.time_s += Governed::kCycle_s;
  on.look();
  on.governor.rezero(kZ, {.displacement_mm = 0.004, .sd_mm = 1e-6});
  EXPECT_NEAR(on.cycle().displacement_mm[kZ], 0.004, 1e-4);
}

TEST(OffsetGovernor, OutOfTheCutItMovesByTheRetractSlopeWhereThereIsOne) {
  // A reading asks for 4 µm; returns the time that the offset takes to get there.
  const auto walks_s = [](double retract_um_min, double slew_mm_s, bool in_cut, Motion motion) {
    auto machine = mill();
    machine.thermal.retract_slope_mm_s = retract_um_min * 1e-3 / 60.0;
    machine.envelope.offset_slew_mm_s = slew_mm_s;
    Governed on(machine);
    on.seconds(600.0);
    on.tool_in_cut = in_cut;
    on.frame.motion = motion;
    on.governor.rezero(kZ, {.displacement_mm = 0.004, .sd_mm = 0.0005});
    const double start_s = on.frame.time_s;
    while (on.cycle().request.reason == Reason::thermal_following &&
           on.frame.time_s < start_s + 60.0) {
    }
    return on.frame.time_s - start_s;
  };
  constexpr double kSlew_mm_s = 0.05;
  EXPECT_NEAR(walks_s(0.0, kSlew_mm_s, false, Motion::rapid), 24.0, 2.0) << "10 µm/min";
  EXPECT_NEAR(walks_s(120.0, kSlew_mm_s, false, Motion::rapid), 2.0, 0.2);
  EXPECT_NEAR(walks_s(120.0, kSlew_mm_s, false, Motion::dwell), 2.0, 0.2);
  EXPECT_NEAR(walks_s(120.0, kSlew_mm_s, true, Motion::feed), 24.0, 2.0);
  EXPECT_NEAR(walks_s(120.0, kSlew_mm_s, true, Motion::idle), 24.0, 2.0) << "still in the cut";
  EXPECT_NEAR(walks_s(120.0, kSlew_mm_s, false, Motion::feed), 24.0, 2.0) << "it feeds";
  EXPECT_NEAR(walks_s(60'000.0, 0.001, false, Motion::rapid), 4.0, 0.3) << "the envelope's slew";
}

TEST(OffsetGovernor, AfterTheZeroWasSetOnlyWhatChangesIsCorrected) {
  Governed on;
  on.seconds(1200.0);
  const double offset = on.offset_mm()[kZ];
  const double grown = on.governor.output().displacement_mm[kZ];
  on.governor.zero_here();
  EXPECT_NEAR(on.seconds(1.0).offset_mm[kZ], offset, 1e-4);
  const auto out = on.seconds(1800.0);
  // δ has moved by δ − δ₀ since, and only that is taken off.
  EXPECT_NEAR(out.offset_mm[kZ] - offset, -(out.displacement_mm[kZ] - grown), 1e-4);
}

TEST(OffsetGovernor, AGapCountsAsStandstill) {
  Governed on;
  const double warm = on.seconds(1200.0).displacement_mm[kZ];
  // Longer than a minute: the machine counts as stopped, and the mode decays by e^(−t/τ).
  on.frame.time_s += 900.0;
  EXPECT_NEAR(on.cycle().displacement_mm[kZ], warm * std::exp(-900.0 / kTau_s), 1e-5);
}

TEST(OffsetGovernor, AGapBelowAMinuteIsNone) {
  const auto risen_mm = [](double gap_s) {
    Governed on;
    const double before = on.seconds(100.0).displacement_mm[kZ];
    on.frame.time_s += gap_s;
    return std::abs(on.cycle().displacement_mm[kZ]) - std::abs(before);
  };
  EXPECT_GT(risen_mm(55.0), 0.0);
  EXPECT_LT(risen_mm(65.0), 0.0);
}

TEST(OffsetGovernor, RefusesWhatItCannotDo) {
  auto machine = mill();
  machine.thermal.axis[0].mode[0].tau_s = -1.0;
  EXPECT_FALSE(OffsetGovernor::make(machine));
  machine = mill();
  for (int i = 0; i < 17; ++i) {
    machine.thermal.axis.emplace_back();
    machine.thermal.axis.back().name = "ch" + std::to_string(i);
    machine.thermal.axis.back().ambient = {{.sensor = "t" + std::to_string(i)}};
  }
  EXPECT_FALSE(OffsetGovernor::make(machine));
}

TEST(OffsetGovernor, DoesNotAllocateInTheCycle) {
  Governed on;
  const kernel::rt::testing::AllocationGuard guard;
  on.seconds(30.0);
  on.governor.measure(kZ, {.displacement_mm = 0.001});
  on.governor.zero_here();
  on.governor.restore(on.governor.state());
  EXPECT_EQ(guard.allocations(), 0U);
}

}  // namespace
}  // namespace steadyrest::thermal::online
