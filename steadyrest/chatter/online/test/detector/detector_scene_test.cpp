// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <steadyrest/chatter/online/test/detector/line_scene.hpp>

// What counts as constant speed, where the spectrum is looked at, and what counts as the tool's
// entry. Each test bounds a constant of detector.cpp from both sides: README, "What the constants
// do".
namespace steadyrest::chatter::online::test {
namespace {

/// RMS over that of the line, of a line a tenth of an order beside the teeth's fifth. It passes a
/// filter that forgets in 4 revolutions and is halved by one that forgets in 0.7.
double left_of_a_near_line(double swing) {
  LineScene scene;
  scene.swing = swing;
  double energy = 0.0;
  double count = 0.0;
  for (const Judged& j : judge(scene, [](double, double angle) { return wave(10.1 * angle); })) {
    energy += j.t_s > 0.4 ? 2.0 * j.out.residual * j.out.residual : 0.0;
    count += j.t_s > 0.4 ? 1.0 : 0.0;
  }
  return std::sqrt(energy / count);
}

TEST(DetectorScene, ASpeedThatSwingsByTwoThousandthsIsConstantAndByFourAndAHalfIsNot) {
  EXPECT_GT(left_of_a_near_line(0.002), 0.85);
  EXPECT_LT(left_of_a_near_line(0.0045), 0.65);
}

/// Energy ratio of a line `beside_hz` above the teeth's fifth order, of half its amplitude: 0.2.
double ratio_of_a_line(double speed_rev_s, double beside_hz) {
  LineScene scene;
  scene.speed_rev_s = speed_rev_s;
  scene.detector.on_ratio = scene.detector.sure_ratio = 1.0;
  const auto judged = judge(scene, [&](double t, double angle) {
    return wave(10.0 * angle) + 0.5 * wave((10.0 * speed_rev_s + beside_hz) * t);
  });
  return mean(judged, &Detector::Output::energy_ratio, 0.5);
}

// A bin is 9.8 Hz.
// One within the guard is judged by its phase, once that has shown that it is not the order.
TEST(DetectorScene, SeesALineTwoAndAHalfBinsBesideAToothOrderAndOneBinBesideIt) {
  EXPECT_NEAR(ratio_of_a_line(80.0, 25.0), 0.2, 0.02);
  EXPECT_NEAR(ratio_of_a_line(80.0, 10.0), 0.2, 0.02);
  EXPECT_LT(ratio_of_a_line(80.0, 0.3), 0.06);
}

// Two teeth: the orders of the teeth are 60 and 100 Hz apart, 6 and 10 bins.
TEST(DetectorScene, LooksBesideToothOrdersThatAreSixBinsApartButNotTen) {
  EXPECT_NEAR(ratio_of_a_line(30.0, 10.0), 0.2, 0.02);
  EXPECT_LT(ratio_of_a_line(50.0, 0.3), 0.1);
}

/// Whether the rise of the first tooth order to `amplitude`, from 1 or from 0.1, counted as the
/// tool's entry: for 0.04 s after an entry the free share is not known. Loud imbalance hides the
/// rise from the energy of the whole signal; a line beside the orders has some free share at all
/// other times.
bool enters(double amplitude, bool cut_before) {
  LineScene scene;
  scene.seconds = cut_before ? 1.4 : 1.0;
  const double at_s = scene.seconds - 0.3;
  const auto judged = judge(scene, [&](double t, double angle) {
    const double before = cut_before && t < 0.5 ? 0.1 : 1.0;
    return 6.0 * wave(angle) + 0.8 * wave(933.0 * t) +
           (t < at_s ? before : amplitude) * wave(2.0 * angle);
  });
  EXPECT_LT(alarm_s(judged), 0.0);
  return std::ranges::any_of(
      judged, [&](const Judged& j) { return j.t_s > at_s + 0.01 && j.out.free_ratio == 0.0; });
}

// The filter learns the rise over some revolutions, so the energies are compared while both change:
// threefold the amplitude counts as some 2.5 times the energy, fivefold as some five times.
TEST(DetectorScene, OfTheFirstCutAToothOrderThatTreblesIsAnEntryAndOneOfSeventyPercentMoreIsNot) {
  EXPECT_TRUE(enters(3.2, false));
  EXPECT_FALSE(enters(1.7, false));
}

TEST(DetectorScene, OfALaterCutAToothOrderSixTimesAsStrongIsAnEntryAndOneThreeTimesIsNot) {
  EXPECT_TRUE(enters(5.7, true));
  EXPECT_FALSE(enters(3.0, true));
}

}  // namespace
}  // namespace steadyrest::chatter::online::test
