// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <steadyrest/chatter/online/test/detector/line_scene.hpp>

// What the free share alone gives: the evidence that it is summed up to, and when that is over.
// Each test bounds a constant of detector.cpp from both sides: README, "What the constants do".
namespace steadyrest::chatter::online::test {
namespace {

/// At constant speed, with the energy ratio's own alarms switched off.
double alarm_by_free_share(double amplitude) {
  LineScene scene;
  scene.seconds = 0.6;
  scene.detector.on_ratio = scene.detector.sure_ratio = 1.0;
  return alarm_s(judge(scene, [&](double t, double angle) {
    return t < 0.1 ? 0.0 : wave(2.0 * angle) + amplitude * beat(t);
  }));
}

// Free ratios of 0.17 and 0.31; 0.25 is the bound.
TEST(DetectorEvidence, AtConstantSpeedThreeTenthsOfTheEnergyFreeAreChatterAndASixthIsNot) {
  EXPECT_LT(alarm_by_free_share(0.45), 0.0);
  EXPECT_GT(alarm_by_free_share(0.7), 0.1);
}

/// At a speed that moves, chatter that falls to `amplitude` at 0.5 s.
bool still_chatters(double amplitude) {
  LineScene scene;
  scene.seconds = 1.2;
  scene.swing = 0.01;
  const auto judged = judge(scene, [&](double t, double angle) {
    return t < 0.1 ? 0.0 : wave(2.0 * angle) + (t < 0.5 ? 1.0 : amplitude) * beat(t);
  });
  EXPECT_GT(alarm_s(judged), 0.1);
  return judged.back().out.chatter;
}

// Free ratios of 0.04 and 0.08; 0.05, half of what makes an alarm, is the bound.
TEST(DetectorEvidence, WhileTheSpeedMovesChatterIsOverAtATwentyFifthOfTheEnergyNotAtATwelfth) {
  EXPECT_FALSE(still_chatters(0.19));
  EXPECT_TRUE(still_chatters(0.3));
}

/// Chatter in bursts of 20 ms, 30 ms apart, in a spectrum short enough to see the gaps.
double alarm_of_bursts(double amplitude) {
  LineScene scene;
  scene.swing = 0.01;
  scene.detector.window_s = 0.025;
  return alarm_s(judge(scene, [&](double t, double angle) {
    const bool burst = t > 0.28 && std::fmod(t - 0.28, 0.05) < 0.02;
    return t < 0.1 ? 0.0 : wave(2.0 * angle) + (burst ? amplitude * beat(t) : 0.0);
  }));
}

// A gap takes 0.1 of the evidence with each spectrum. The weaker bursts give less than that, the
// stronger ones more.
TEST(DetectorEvidence, BurstsMustGiveMoreThanTheGapsTake) {
  EXPECT_LT(alarm_of_bursts(0.6), 0.0);
  EXPECT_GT(alarm_of_bursts(0.67), 0.5);
}

/// A cut that slowly shows more and more free vibration, up to 0.27 of the energy, is quiet for
/// `quiet_s` and then suddenly shows a little more than before.
double alarm_after_quiet(double quiet_s) {
  LineScene scene;
  scene.seconds = 5.4 + quiet_s;
  scene.speed_rev_s = 100.0;
  scene.swing = 0.01;
  scene.detector.sample_rate_hz = 2e3;
  scene.detector.tooth_harmonics = 1;
  scene.detector.spindle_harmonics = 0;
  return alarm_s(judge(scene, [&](double t, double angle) {
    const double before = t < 5.0 ? 0.6 * std::exp(0.5 * std::min(0.0, t - 4.5)) : 0.0;
    const double amplitude = t < 5.0 + quiet_s ? before : 0.7;
    const double lines = wave(435.0 * t) + wave(465.0 * t);
    return t < 0.2 ? 0.0 : wave(2.0 * angle) + amplitude * lines;
  }));
}

// What the cut has shown counts as its own and fades over 30 s: to 0.65 and 0.46.
TEST(DetectorEvidence, WhatACutHasShownItMayShowAgainAfter13SecondsNotAfter23) {
  EXPECT_LT(alarm_after_quiet(13.0), 0.0);
  EXPECT_GT(alarm_after_quiet(23.0), 28.0);
}

}  // namespace
}  // namespace steadyrest::chatter::online::test
