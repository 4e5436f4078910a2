// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/chatter/online/detector.hpp>
#include <steadyrest/kernel/units/constants.hpp>

/// What the detector says of a signal that is written down: lines, orders and noise of known size.
namespace steadyrest::chatter::online::test {

struct LineScene {
  Detector::Config detector;
  double seconds = 1.0;
  double speed_rev_s = 80.0;
  double swing = 0.0;       ///< the speed jumps 50 times a second between 1 − swing and 1 + swing
  double told_ratio = 1.0;  ///< speed that the detector is told, over the true one
};

/// One spectrum that was judged.
struct Judged {
  double t_s = 0.0;
  Detector::Output out;
};

/// `value(t_s, angle_rev)`, with noise of 0.001.
template <class Value>
std::vector<Judged> judge(const LineScene& scene, Value value) {
  auto detector = Detector::make(scene.detector);
  EXPECT_TRUE(detector);
  std::mt19937_64 rng(1);
  std::normal_distribution<double> noise(0.0, 1e-3);
  std::vector<Judged> judged;
  double angle_rev = 0.0;
  const double rate_hz = scene.detector.sample_rate_hz;
  const auto samples = static_cast<int>(scene.seconds * rate_hz);
  for (int i = 0; i < samples; ++i) {
    const double t = i / rate_hz;
    const bool fast = std::fmod(50.0 * t, 1.0) < 0.5;
    const double speed = scene.speed_rev_s * (1.0 + (fast ? scene.swing : -scene.swing));
    const auto& out = detector->update({.value = value(t, angle_rev) + noise(rng),
                                        .speed_rev_s = speed * scene.told_ratio,
                                        .angle_rev = angle_rev});
    if (out.fresh) {
      judged.push_back({.t_s = t, .out = out});
    }
    angle_rev += speed / rate_hz;
  }
  return judged;
}

/// When chatter was first told; −1: never.
inline double alarm_s(const std::vector<Judged>& judged) {
  const auto it = std::ranges::find_if(judged, [](const Judged& j) { return j.out.chatter; });
  return it == judged.end() ? -1.0 : it->t_s;
}

/// Over the spectra from a time on.
inline double mean(const std::vector<Judged>& judged, double Detector::Output::* what,
                   double from_s) {
  double sum = 0.0;
  double count = 0.0;
  for (const Judged& j : judged) {
    sum += j.t_s >= from_s ? j.out.*what : 0.0;
    count += j.t_s >= from_s ? 1.0 : 0.0;
  }
  EXPECT_GT(count, 0.0);
  return sum / count;
}

/// cos 2πx
inline double wave(double turns) {
  return std::cos(kernel::units::kTurn * turns);
}

/// Two lines of chatter that beat: no damped mode explains more than an eighth of them.
inline double beat(double t_s) {
  return wave(920.0 * t_s) + wave(950.0 * t_s);
}

}  // namespace steadyrest::chatter::online::test
