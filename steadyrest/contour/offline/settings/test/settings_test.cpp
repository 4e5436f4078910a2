// SPDX-License-Identifier: Apache-2.0
// What a setting of the control would leave of the error. Truth: the closed form of a circle under
// a first-order servo with feed-forward, R·(1 − √((k² + a²ω²)/(k² + ω²))), and of a straight line
// under unequal gains.
#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/contour/offline/settings/settings.hpp>
#include <steadyrest/contour/offline/test/ideal_mill.hpp>

namespace steadyrest::contour::offline {
namespace {

using testing::HasSubstr;

constexpr double kCircle_mm = 10.0;
constexpr double kGain_1_s = 30.0;

const std::string kTurns = "G0 X10 Y0\nG4 P1\nG3 X10 Y0 I-10 J0 F3000\nG3 X10 Y0 I-10 J0\n";

/// The radius that a circle at F3000 shrinks by.
double shrink_mm(double weight) {
  const double omega = 50.0 / kCircle_mm;
  return kCircle_mm * (1.0 - std::sqrt((kGain_1_s * kGain_1_s + weight * weight * omega * omega) /
                                       (kGain_1_s * kGain_1_s + omega * omega)));
}

TEST(Settings, FeedForwardLeavesWhatTheClosedFormSays) {
  const kernel::machine::Machine machine = test::ideal_mill(kGain_1_s);
  const auto path = test::planned_moves(machine, kTurns);
  const auto found = cheapest_settings(machine, path, 0.01);
  ASSERT_TRUE(found && !found->empty());
  bool forward = false;
  for (const Setting& setting : *found) {
    const double weight = setting.machine.axes[0].feed_forward;
    if (weight > 0.0) {
      forward = true;
      EXPECT_THAT(setting.what, HasSubstr("FF1 = 1 of the joints of X, Y, Z"));
      EXPECT_EQ(weight, 1.0);
      EXPECT_LT(setting.figures.nominal().rms_mm(), 0.02 * shrink_mm(0.0));
      EXPECT_EQ(setting.unsure_lag_s, 0.0);
    }
  }
  EXPECT_TRUE(forward);
}

// Without a lag in the machine file the weight must do for kτ = 0 and for 0.1: √(1 − 2kτ) is 1 and
// 0.894, and the one between them leaves a tenth of the error on both.
TEST(Settings, AnUnknownLagIsAllowedFor) {
  kernel::machine::Machine machine = test::ideal_mill(kGain_1_s);
  for (auto& axis : machine.axes) {
    axis.velocity_lag_known = false;
  }
  const auto path = test::planned_moves(machine, kTurns);
  const auto found = cheapest_settings(machine, path, 0.01);
  ASSERT_TRUE(found);
  ASSERT_EQ(found->size(), 1U) << "nothing is said of the gain where the lag is not known";
  const Setting& setting = found->front();
  EXPECT_EQ(setting.machine.axes[0].feed_forward, 0.95);
  EXPECT_EQ(setting.machine.axes[0].servo_gain_1_s, kGain_1_s);
  EXPECT_NEAR(setting.figures.nominal().rms_mm(), shrink_mm(0.95), 0.15 * shrink_mm(0.95));
  EXPECT_NEAR(setting.unsure_lag_s, 0.1 / kGain_1_s, 1e-12);
  EXPECT_LT(setting.unsure_rms_mm, 0.15 * shrink_mm(0.0));
}

TEST(Settings, UnequalGainsBecomeEqualOnALine) {
  kernel::machine::Machine machine = test::ideal_mill(50.0);
  machine.axes[1].servo_gain_1_s = 40.0;
  machine.control.dialect = kernel::machine::Dialect::sinumerik;
  const auto path = test::planned_moves(machine, "G0 X0 Y0\nG4 P1\nG1 X40 Y30 F3000\n");
  const auto found = cheapest_settings(machine, path, 0.01);
  ASSERT_TRUE(found && !found->empty());
  bool equal = false;
  for (const Setting& setting : *found) {
    if (setting.machine.axes[0].feed_forward == 0.0) {
      equal = true;
      EXPECT_THAT(setting.what, HasSubstr("MD32200 POSCTRL_GAIN = 2.4 on X, Y, Z"));
      EXPECT_LT(setting.figures.nominal().max_mm, 1e-4);
    }
    for (const auto& axis : setting.machine.axes) {
      EXPECT_LE(axis.servo_gain_1_s, 50.0) << "no gain rises where the lag is not known";
    }
  }
  EXPECT_TRUE(equal);
}

TEST(Settings, AGainRisesNoFurtherThanItsDampingAllows) {
  kernel::machine::Machine machine = test::ideal_mill(20.0);
  for (auto& axis : machine.axes) {
    axis.velocity_lag_s = 0.005;
  }
  const auto path = test::planned_moves(machine, kTurns);
  const auto found = cheapest_settings(machine, path, 0.01);
  ASSERT_TRUE(found);
  double highest = 0.0;
  for (const Setting& setting : *found) {
    highest = std::max(highest, setting.machine.axes[0].servo_gain_1_s);
  }
  EXPECT_NEAR(highest, 0.25 / 0.005, 1e-9);
}

TEST(Settings, NothingIsProposedWhereTheLimitIsKept) {
  const kernel::machine::Machine machine = test::ideal_mill(kGain_1_s);
  const auto path = test::planned_moves(machine, kTurns);
  const auto found = cheapest_settings(machine, path, 1.0);
  ASSERT_TRUE(found);
  EXPECT_TRUE(found->empty());
}

}  // namespace
}  // namespace steadyrest::contour::offline
