// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include <steadyrest/chatter/offline/plan/drive_limits.hpp>
#include <steadyrest/chatter/offline/test/cuts.hpp>

namespace steadyrest::chatter::offline::test {
namespace {

using kernel::machine::Machine;
using online::Law;

constexpr double kSpeed = 5000.0 / 60.0;

/// A spindle that can do nearly everything; each test removes one ability.
Machine strong_machine() {
  Machine m;
  m.spindle.max_rev_s = 500.0;
  m.spindle.acceleration_rev_s2 = 1e4;
  m.spindle.inertia_kg_m2 = 1e-4;
  m.spindle.rated_power_w = 1e5;
  m.spindle.max_torque_n_m = 1e3;
  m.spindle.speed_tolerance_ratio = 0.0;
  m.envelope.spindle_slew_1_s = 1e3;
  m.spindle_override.scan_period_s = 0.001;
  for (int percent = 50; percent <= 120; percent += 5) {
    m.spindle_override.ratio.push_back(0.01 * percent);
    m.spindle_override.code.push_back(static_cast<std::uint32_t>(percent));
  }
  return m;
}

DriveLimits limits_of(const Machine& machine, const DriveLimits::Options& options = {}) {
  return {machine, benchmark_cut(1.0, Direction::up), 1.0, options};
}

/// The only limit that is violated.
void expect_only(const DriveDemand& demand, DriveLimit limit) {
  ASSERT_EQ(demand.violations.size(), 1U);
  EXPECT_EQ(demand.violations[0].limit, limit) << demand.violations[0].reason;
  EXPECT_FALSE(demand.violations[0].reason.empty());
}

/// Both sides of the bound.
TEST(DriveLimits, TriangleNeedsRvaTimesRvfTimesSquareOverFifteen) {
  Machine m = strong_machine();
  const Modulation law{Law::triangle, 0.2, 0.1, 1};
  // 4·RVA·f·N₀ with f = RVF·N₀/60 per second: RVA·RVF·N₀²/15.
  const double need_rpm_s = 0.2 * 0.1 * 5000.0 * 5000.0 / 15.0;
  EXPECT_NEAR(60.0 * limits_of(m).modulated(kSpeed, law).acceleration_rev_s2, need_rpm_s, 1e-6);
  m.spindle.acceleration_rev_s2 = 1.001 * need_rpm_s / 60.0;
  EXPECT_TRUE(limits_of(m).modulated(kSpeed, law).possible());
  m.spindle.acceleration_rev_s2 = 0.999 * need_rpm_s / 60.0;
  expect_only(limits_of(m).modulated(kSpeed, law), DriveLimit::acceleration);
  EXPECT_NEAR(*limits_of(m).most_rvf(kSpeed, law, 0.001, 0.5), 0.0999, 1e-6);
}

TEST(DriveLimits, SineNeedsTwoPi) {
  const DriveDemand demand =
      limits_of(strong_machine()).modulated(kSpeed, {Law::sine, 0.2, 0.1, 1});
  EXPECT_NEAR(demand.acceleration_rev_s2, 2.0 * std::numbers::pi * 0.2 * 0.1 * kSpeed * kSpeed,
              1e-6);
}

/// J·ω·dω/dt of a sine: its greatest is found where (1 + A·sin)·cos is; to A² it is 1 + A²/2.
TEST(DriveLimits, PowerTorqueAndHeatOfASine) {
  Machine m = strong_machine();
  const double a = 0.1;
  const Modulation law{Law::sine, a, 0.1, 1};
  const DriveLimits drive = limits_of(m);
  // ω = w·(1 + a·sin), so dω/dt = w·2π·f·a·cos with f = 0.1·kSpeed: `swing` is the greatest torque
  // of it.
  const double w = 2.0 * std::numbers::pi * kSpeed;
  const double swing = m.spindle.inertia_kg_m2 * 2.0 * std::numbers::pi * a * 0.1 * kSpeed * w;
  const DriveDemand demand = drive.modulated(kSpeed, law);
  EXPECT_NEAR(demand.power_w - drive.cutting_power_w(kSpeed), swing * w * (1.0 + 0.5 * a * a),
              1e-4 * swing * w);
  const double cut = drive.cutting_power_w(kSpeed) / w;
  EXPECT_NEAR(demand.torque_n_m, swing + cut, 1e-9);
  EXPECT_NEAR(demand.rms_torque_n_m, std::hypot(swing / std::numbers::sqrt2, cut), 1e-9);

  m.spindle.rated_torque_n_m = 0.99 * demand.rms_torque_n_m;
  expect_only(limits_of(m).modulated(kSpeed, law), DriveLimit::heat);
  m.spindle.rated_torque_n_m = 1.01 * demand.rms_torque_n_m;
  EXPECT_TRUE(limits_of(m).modulated(kSpeed, law).possible());
  m.spindle.rated_power_w = 0.99 * demand.power_w;
  expect_only(limits_of(m).modulated(kSpeed, law), DriveLimit::power);
}

/// Slot of the diameter D: Kt times the volume removed in a second, D·a·fz·teeth·n.
TEST(DriveLimits, CuttingPowerIsTheVolumeTimesKt) {
  const Process slot = benchmark_cut(1.0, Direction::up);
  const double volume_mm3_s =
      slot.tool.diameter_mm * 1.0 * slot.cut.feed_per_tooth_mm * 2.0 * kSpeed;
  // 600 N/mm² are 0.6 W for each mm³/s.
  EXPECT_NEAR(limits_of(strong_machine()).cutting_power_w(kSpeed), 0.6 * volume_mm3_s, 1e-9);
}

TEST(DriveLimits, JumpsMayRampForAFifthOfTheShortestPart) {
  Machine m = strong_machine();
  const double jump = 0.2 * kSpeed;  // ±10 %
  // A square dwells for half a period on each side.
  const double part_s = 0.5 / (0.05 * kSpeed);
  const Modulation law{Law::square, 0.1, 0.05, 1};
  m.spindle.acceleration_rev_s2 = 1.001 * jump / (0.2 * part_s);
  EXPECT_TRUE(limits_of(m).modulated(kSpeed, law).possible());
  m.spindle.acceleration_rev_s2 = 0.999 * jump / (0.2 * part_s);
  expect_only(limits_of(m).modulated(kSpeed, law), DriveLimit::ramp);
}

TEST(DriveLimits, OverrideMustWriteTheLaw) {
  Machine m = strong_machine();
  const DriveDemand fine = limits_of(m).modulated(kSpeed, {Law::triangle, 0.2, 0.1, 1});
  EXPECT_TRUE(fine.possible());
  ASSERT_EQ(fine.written_ratio.size(), 9U);
  EXPECT_DOUBLE_EQ(fine.written_ratio.front(), 0.8);
  EXPECT_DOUBLE_EQ(fine.written_ratio.back(), 1.2);
  // ±5 % in steps of 5 % is not a sweep but a square with three levels.
  expect_only(limits_of(m).modulated(kSpeed, {Law::sine, 0.05, 0.1, 1}), DriveLimit::levels);
  EXPECT_TRUE(limits_of(m).modulated(kSpeed, {Law::square, 0.05, 0.1, 1}).possible());
  // The envelope clips the table.
  m.envelope.max_spindle_ratio = 1.1;
  expect_only(limits_of(m).modulated(kSpeed, {Law::triangle, 0.2, 0.1, 1}), DriveLimit::levels);
  // So does the spindle.
  // 105 % would be too fast: 100 % remains as the greatest.
  m.spindle.max_rev_s = 1.02 * kSpeed;
  EXPECT_DOUBLE_EQ(limits_of(m).writable(kSpeed).back(), 1.0);
}

TEST(DriveLimits, AnEightfoldScanIsNeeded) {
  Machine m = strong_machine();
  const Modulation law{Law::triangle, 0.1, 0.1, 1};
  m.spindle_override.scan_period_s = 0.999 / (8.0 * 0.1 * kSpeed);
  EXPECT_TRUE(limits_of(m).modulated(kSpeed, law).possible());
  m.spindle_override.scan_period_s = 1.001 / (8.0 * 0.1 * kSpeed);
  expect_only(limits_of(m).modulated(kSpeed, law), DriveLimit::scan);
}

TEST(DriveLimits, EnvelopesSlewAndAWalkedWordCountLikeAnAcceleration) {
  Machine m = strong_machine();
  const Modulation law{Law::triangle, 0.2, 0.1, 1};
  // d(ratio)/dt = RVA·f·max|S′| with max|S′| = 4.
  const double rate_1_s = 4.0 * 0.2 * 0.1 * kSpeed;
  m.envelope.spindle_slew_1_s = 0.99 * rate_1_s;
  expect_only(limits_of(m).modulated(kSpeed, law), DriveLimit::slew);
  m.envelope.spindle_slew_1_s = 1.01 * rate_1_s;
  m.spindle_override.latched_word = false;
  m.spindle_override.scan_period_s = 0.05 / (1.01 * rate_1_s);
  EXPECT_TRUE(limits_of(m).modulated(kSpeed, law).possible());
  m.spindle_override.scan_period_s = 0.05 / (0.99 * rate_1_s);
  expect_only(limits_of(m).modulated(kSpeed, law), DriveLimit::walk);
}

TEST(DriveLimits, SpeedMonitorSeesStepsAndJumps) {
  Machine m = strong_machine();
  m.spindle.speed_tolerance_ratio = 0.10;
  // Swept: off by one step of 5 % over the lowest speed of 80 %.
  const DriveDemand swept = limits_of(m).modulated(kSpeed, {Law::triangle, 0.2, 0.05, 1});
  EXPECT_TRUE(swept.possible());
  EXPECT_NEAR(swept.off_ratio, 0.05 / 0.8, 1e-9);
  const Modulation square{Law::square, 0.1, 0.05, 1};
  expect_only(limits_of(m).modulated(kSpeed, square), DriveLimit::monitor);
  EXPECT_TRUE(limits_of(m, {.keep_speed_band = false}).modulated(kSpeed, square).possible());
  m.spindle.speed_tolerance_ratio = 0.0;  // the control watches nothing
  EXPECT_TRUE(limits_of(m).modulated(kSpeed, square).possible());
}

TEST(DriveLimits, ConstantSpeedMustBeOneOfTheSpindle) {
  Machine m = strong_machine();
  m.spindle.max_rev_s = 1.05 * kSpeed;
  EXPECT_TRUE(limits_of(m).constant(kSpeed, 1.05).possible());
  expect_only(limits_of(m).constant(kSpeed, 1.1), DriveLimit::speed);
  m.spindle.rated_power_w = 0.5 * limits_of(m).cutting_power_w(kSpeed);
  expect_only(limits_of(m).constant(kSpeed, 1.0), DriveLimit::power);
}

TEST(DriveLimits, WhatIsPassedByLittleIsPrintedWithTheDigitsThatShowIt) {
  Machine m = strong_machine();
  const Modulation law{Law::sine, 0.1, 0.1, 1};
  const double needed = limits_of(m).modulated(kSpeed, law).torque_n_m;
  m.spindle.max_torque_n_m = needed * (1.0 - 1e-6);
  m.spindle.rated_torque_n_m = 1e3;
  const DriveDemand demand = limits_of(m).modulated(kSpeed, law);
  expect_only(demand, DriveLimit::torque);
  const std::string& said = demand.violations[0].reason;
  const std::size_t comma = said.find(", the drive delivers ");
  ASSERT_NE(comma, std::string::npos) << said;
  EXPECT_NE(said.substr(6, comma - 6), said.substr(comma + 18)) << said;
}

}  // namespace
}  // namespace steadyrest::chatter::offline::test
