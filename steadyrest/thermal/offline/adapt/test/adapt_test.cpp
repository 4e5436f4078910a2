// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <random>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <steadyrest/thermal/offline/adapt/adapt.hpp>
#include <steadyrest/thermal/offline/plan/curve.hpp>

namespace steadyrest::thermal::offline {
namespace {

const std::vector<double> kShares = {1.0, 0.7, 0.5, 0.35};

std::vector<PartError> parts(std::initializer_list<double> deviations_um) {
  std::vector<PartError> out;
  for (const double um : deviations_um) {
    out.push_back({.deviation_mm = um * 1e-3, .tolerance_mm = 0.010});
  }
  return out;
}

TEST(NextLevel, IsTheStricterOneWhereThePartsLeaveTheirShare) {
  const auto choice = next_level(kShares, 0, parts({4.0, -13.0, 8.0, 2.0, 1.0}), {});
  EXPECT_EQ(choice.level, 1U);
  EXPECT_EQ(choice.share, 0.7);
  EXPECT_EQ(choice.outside, 1U);
  EXPECT_NEAR(choice.largest_ratio, 1.3, 1e-12);
  EXPECT_EQ(next_level(kShares, 1, parts({8.5, 2.0}), {}).level, 2U) << "its share is 7 µm";
  EXPECT_EQ(next_level(kShares, 0, parts({8.5, 2.0}), {}).level, 0U) << "there it is 10 µm";
}

// Slower back than forward: five good parts for one step back, one bad part for one ahead.
TEST(NextLevel, GoesBackOneWhereAllAreWellInsideAndEnoughWereMeasured) {
  EXPECT_EQ(next_level(kShares, 2, parts({2.4, -1.0, 0.5, 2.0, 1.0}), {}).level, 1U);
  // Half of the share of 5 µm is 2.5.
  EXPECT_EQ(next_level(kShares, 2, parts({2.6, -1.0, 0.5, 2.0, 1.0}), {}).level, 2U);
  EXPECT_EQ(next_level(kShares, 2, parts({1.0, 1.0, 1.0, 1.0}), {}).level, 2U) << "four are few";
  EXPECT_EQ(next_level(kShares, 0, parts({0.0, 0.0, 0.0, 0.0, 0.0}), {}).level, 0U);
}

TEST(NextLevel, SaysWhenThereIsNoStricterOne) {
  const auto choice = next_level(kShares, 3, parts({9.0}), {});
  EXPECT_EQ(choice.level, 3U);
  EXPECT_TRUE(choice.exhausted);
}

TEST(NextLevel, DoesNotCountWhatMeasuringMayHaveAdded) {
  // Twice the measuring error of 0.5 µm next to a share of 10 µm: the border is at 11 µm.
  EXPECT_EQ(next_level(kShares, 0, parts({10.9}), {}).level, 0U);
  EXPECT_EQ(next_level(kShares, 0, parts({11.1}), {}).level, 1U);
  std::vector<PartError> many(40, PartError{.deviation_mm = 0.006, .tolerance_mm = 0.010});
  many[7].deviation_mm = 0.020;
  many[8].deviation_mm = 0.020;
  EXPECT_EQ(next_level(kShares, 0, many, {}).level, 0U) << "2 of 40 are a few";
  many[9].deviation_mm = 0.020;
  EXPECT_EQ(next_level(kShares, 0, many, {}).level, 1U);
}

kernel::machine::ThermalAxis axis() {
  kernel::machine::ThermalAxis axis;
  axis.mode.resize(2);
  axis.mode[0].tau_s = 900.0;
  axis.mode[0].speed_rev_s = {0.0, 100.0};
  axis.mode[0].level_mm = {0.0, 0.015};
  axis.mode[1].tau_s = 5400.0;
  axis.mode[1].polynomial_mm = {0.004, 0.0005};
  return axis;
}

Cyclogram work() {
  Cyclogram work;
  for (const double speed : {100.0, 20.0, 80.0}) {
    Transition transition;
    transition.seconds = 3600.0;
    transition.speed_rev_s = speed;
    transition.load = Load::running;
    work.transition.push_back(transition);
  }
  return work;
}

TEST(Predict, IsTheCurveOfThePlanAtAnyInstantInAnyOrder) {
  const auto model = online::ThermalModel::make(axis());
  ASSERT_TRUE(model);
  const Curve curve = curve_of(*model, work());
  const std::vector<double> times = {9000.0, 60.0, 3600.0, 10800.0, 3601.0, 0.0};
  const auto said = predict(*model, work(), {}, times);
  for (std::size_t i = 0; i < times.size(); ++i) {
    EXPECT_NEAR(said[i].displacement_mm, curve.at(times[i]), 1e-12) << times[i];
    EXPECT_NEAR(said[i].mode_mm[0] + said[i].mode_mm[1], said[i].displacement_mm, 1e-15);
  }
}

/// Measurements on a machine with other gains.
std::vector<Observation> measured(const std::vector<double>& gain, double bias_mm, double noise_mm,
                                  unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  const auto model = online::ThermalModel::make(axis());
  std::vector<double> times;
  for (int i = 1; i <= 30; ++i) {
    times.push_back(360.0 * i);
  }
  std::vector<Observation> out;
  for (const auto& said : predict(*model, work(), {}, times)) {
    out.push_back({.deviation_mm = (gain[0] - 1.0) * said.mode_mm[0] +
                                   (gain[1] - 1.0) * said.mode_mm[1] + bias_mm +
                                   noise_mm * normal(random),
                   .expected_mm = 0.0,
                   .mode_mm = said.mode_mm});
  }
  return out;
}

// Recursive least squares must end where the normal equations with the prior's precision do; an
// update in the wrong order or with the wrong sign does not.
TEST(LearnGains, IsRidgeRegressionInOneGo) {
  const auto observations = measured({1.1, 0.95}, 0.001, 0.0005, 1);
  const GainRule rule{.gate_sd = 1e3};
  const Gains gains = learn_gains(observations, rule);
  Eigen::MatrixXd a(observations.size(), 3);
  Eigen::VectorXd y(observations.size());
  for (std::size_t k = 0; k < observations.size(); ++k) {
    const auto row = static_cast<Eigen::Index>(k);
    a.row(row) << observations[k].mode_mm[0], observations[k].mode_mm[1], 1.0;
    y(row) = observations[k].deviation_mm;
  }
  const double r2 = rule.measuring_sd_mm * rule.measuring_sd_mm;
  Eigen::MatrixXd normal = a.transpose() * a / r2;
  normal(0, 0) += 1.0 / (rule.gain_sd_ratio * rule.gain_sd_ratio);
  normal(1, 1) += 1.0 / (rule.gain_sd_ratio * rule.gain_sd_ratio);
  normal(2, 2) += 1.0 / (rule.bias_sd_mm * rule.bias_sd_mm);
  const Eigen::VectorXd x = normal.ldlt().solve(a.transpose() * y / r2);
  EXPECT_NEAR(gains.gain[0], 1.0 + x(0), 1e-9);
  EXPECT_NEAR(gains.gain[1], 1.0 + x(1), 1e-9);
  EXPECT_NEAR(gains.bias_mm, x(2), 1e-12);
  EXPECT_NEAR(gains.gain_sd[0], std::sqrt(normal.inverse()(0, 0)), 1e-9);
}

TEST(LearnGains, FindsTheGainsOfAMachineThatIsTwentyPercentOff) {
  const Gains gains = learn_gains(measured({1.2, 0.8}, 0.001, 0.0005, 2), {});
  EXPECT_NEAR(gains.gain[0], 1.2, 4.0 * gains.gain_sd[0]);
  EXPECT_NEAR(gains.gain[1], 0.8, 4.0 * gains.gain_sd[1]);
  EXPECT_LT(gains.gain_sd[1], 0.05);
  EXPECT_TRUE(gains.fits);
  EXPECT_TRUE(gains.outlier.empty());
  EXPECT_GT(gains.rms_before_mm, 2.0 * gains.rms_after_mm);
  EXPECT_NEAR(gains.rms_after_mm, 0.0005, 0.00015);
}

TEST(LearnGains, LeavesOutliersAloneAlsoTheFirst) {
  // Only the wide prior judges the first part; only the second look at the end finds it.
  for (const std::size_t at : {std::size_t{0}, std::size_t{17}}) {
    auto observations = measured({1.1, 1.1}, 0.0, 0.0005, 3);
    observations[at].deviation_mm += 0.004;
    const Gains gains = learn_gains(observations, {});
    ASSERT_EQ(gains.outlier.size(), 1U) << at;
    EXPECT_EQ(gains.outlier[0], at);
    EXPECT_TRUE(gains.fits);
    EXPECT_NEAR(gains.gain[1], 1.1, 4.0 * gains.gain_sd[1]);
  }
}

TEST(LearnGains, OneOutlierOfThreeIsEnoughForNoFit) {
  auto observations = measured({1.0, 1.0}, 0.0, 0.0002, 6);
  observations.resize(3);
  Gains gains = learn_gains(observations, {});
  EXPECT_TRUE(gains.fits);
  EXPECT_TRUE(gains.few);
  observations[1].deviation_mm = 0.9;
  gains = learn_gains(observations, {});
  EXPECT_FALSE(gains.fits);
  EXPECT_EQ(gains.outlier.size(), 1U);
}

// With one outlier per round the rounds would grow with the parts, and the time with their square.
TEST(LearnGains, OfTwentyThousandPartsTheOutliersAreNamed) {
  const auto thirty = measured({1.1, 1.1}, 0.0, 0.0005, 7);
  std::vector<Observation> observations;
  for (std::size_t k = 0; k < 20'000; ++k) {
    observations.push_back(thirty[k % thirty.size()]);
    observations.back().deviation_mm = 1e-3 * (static_cast<double>(k % 7) - 3.0);
    observations.back().expected_mm = k % 100 < 50 ? 0.0 : 0.004;
  }
  const Gains gains = learn_gains(observations, {});
  EXPECT_GT(gains.outlier.size(), 1'000U);
  EXPECT_FALSE(gains.fits);
}

// Alternating +8 and −8 µm: no gain has that sign pattern, and clipping alone would hide it.
TEST(LearnGains, SaysWhenNoGainExplainsTheParts) {
  auto observations = measured({1.0, 1.0}, 0.0, 0.0005, 4);
  for (std::size_t k = 0; k < observations.size(); ++k) {
    observations[k].deviation_mm += k % 2 == 0 ? 0.008 : -0.008;
  }
  EXPECT_FALSE(learn_gains(observations, {}).fits);
  const Gains doubled = learn_gains(measured({3.0, 3.0}, 0.0, 0.0005, 5), {});
  EXPECT_FALSE(doubled.fits) << "beyond what gains may be";
  for (const double gain : doubled.gain) {
    EXPECT_LE(gain, 2.0);
    EXPECT_GE(gain, 0.5);
  }
}

TEST(LearnGains, SeldomSaysSoOfAMachineThatFits) {
  int wrong = 0;
  std::mt19937 random(11);
  std::normal_distribution<double> normal;
  for (unsigned seed = 0; seed < 300; ++seed) {
    const std::vector<double> gain = {1.0 + 0.15 * normal(random), 1.0 + 0.15 * normal(random)};
    wrong += learn_gains(measured(gain, 0.001, 0.0005, seed), {}).fits ? 0 : 1;
  }
  // The tests are at 0.1 % each; 2 % of 300 leave room for chance.
  EXPECT_LE(wrong, 6);
}

// Parameters in the passport's order: two levels, two coefficients, one gain; fifteen covariance
// entries.
TEST(ApplyGains, ScalesLevelsAndTheirCovariance) {
  auto one = axis();
  one.mode[0].feed_s = 0.001;
  one.ambient.push_back({.sensor = "room"});
  const std::size_t n = one.parameters();
  ASSERT_EQ(n, 5U);
  one.covariance.assign(n * (n + 1) / 2, 1.0);
  apply_gains(one, std::vector<double>{2.0, 0.5});
  EXPECT_DOUBLE_EQ(one.mode[0].level_mm[1], 0.030);
  EXPECT_DOUBLE_EQ(one.mode[0].feed_s, 0.002);
  EXPECT_DOUBLE_EQ(one.mode[1].polynomial_mm[0], 0.002);
  EXPECT_DOUBLE_EQ(one.covariance.front(), 4.0) << "level with itself";
  EXPECT_DOUBLE_EQ(one.covariance[3], 1.0) << "coefficient with level: 0.5·2";
  EXPECT_DOUBLE_EQ(one.covariance[5], 0.25) << "coefficient with itself";
  EXPECT_DOUBLE_EQ(one.covariance.back(), 1.0) << "the surroundings' gain";
}

}  // namespace
}  // namespace steadyrest::thermal::offline
