// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include <steadyrest/chatter/online/detector.hpp>
#include <steadyrest/chatter/online/test/cut_signal.hpp>
#include <steadyrest/kernel/rt/testing/allocation_guard.hpp>

namespace steadyrest::chatter::online::test {
namespace {

using kernel::outcome::Reason;

/// The slot of the reference: its border at 5000 rpm is 0.4086 mm.
CutModel slot(double depth_mm) {
  CutModel m;
  m.depth_mm = depth_mm;
  m.frequency_hz = {922.0, 922.0};
  m.damping_ratio = {0.011, 0.011};
  m.stiffness_n_mm = {1340.05, 1e7};  // stiff in y: the mode in x alone
  m.air_s = 0.2;
  return m;
}

struct Heard {
  double first_s = -1.0;
  double end_s = -1.0;  ///< chatter was no longer told
  double frequency_hz = 0.0;
  Detector::Kind kind = Detector::Kind::none;
  Detector::Output last;
};

Heard listen(const CutSignal& signal, std::size_t teeth, double noise, bool angle = false) {
  auto detector = Detector::make({.sample_rate_hz = signal.rate_hz, .teeth = teeth});
  EXPECT_TRUE(detector);
  std::mt19937_64 rng(5);
  std::normal_distribution<double> gauss(0.0, noise > 0.0 ? noise : 1.0);
  Heard heard;
  const kernel::rt::testing::AllocationGuard guard;
  for (std::size_t i = 0; i < signal.value.size(); ++i) {
    const double t = static_cast<double>(i) / signal.rate_hz;
    Detector::Input input;
    input.value = signal.value[i] + (noise > 0.0 ? gauss(rng) : 0.0);
    input.speed_rev_s = signal.speed_rev_s[i];
    if (angle) {
      input.angle_rev = signal.angle_rev[i];
    }
    heard.last = detector->update(input);
    if (heard.last.chatter && heard.first_s < 0.0) {
      heard.first_s = t;
      heard.frequency_hz = heard.last.frequency_hz;
      heard.kind = heard.last.kind;
    }
    if (heard.first_s >= 0.0 && heard.last.chatter == (heard.end_s >= 0.0)) {
      heard.end_s = heard.last.chatter ? -1.0 : t;
    }
  }
  return heard;
}

TEST(Detector, HearsTheSlotChatterInTimeAtFiveNoiseLevels) {
  const CutModel model = slot(0.6);
  const CutSignal signal = simulate(model, 2.0);
  const Truth truth = truth_of(model, signal);
  ASSERT_TRUE(truth.chatters);
  for (const double noise : {0.01, 0.05, 0.2, 0.5, 1.0}) {
    const Heard heard = listen(signal, 2, noise * truth.forced_rms);
    EXPECT_GT(heard.first_s, 0.2) << noise;
    EXPECT_LT(heard.first_s, truth.onset_s + 0.15) << noise;
    EXPECT_EQ(heard.kind, Detector::Kind::hopf) << noise;
    EXPECT_NEAR(heard.frequency_hz, 950.0, 50.0) << noise;
    EXPECT_EQ(heard.last.reason, Reason::chatter_detected);
  }
}

TEST(Detector, IsSilentInTheStableSlot) {
  const CutModel model = slot(0.25);
  const CutSignal signal = simulate(model, 3.0);
  const Truth truth = truth_of(model, signal);
  ASSERT_TRUE(truth.stable);
  for (const double noise : {0.01, 0.05, 0.2, 0.5}) {
    for (const bool angle : {false, true}) {
      const Heard heard = listen(signal, 2, noise * truth.forced_rms, angle);
      EXPECT_LT(heard.first_s, 0.0) << noise;
      EXPECT_EQ(heard.last.kind, Detector::Kind::forced) << noise;
    }
  }
}

TEST(Detector, IsSilentUnderModulation) {
  for (const Law law : {Law::sine, Law::triangle}) {
    CutModel model = slot(0.3);
    model.law = law;
    model.rva = 0.1;
    const CutSignal signal = simulate(model, 3.0);
    const Truth truth = truth_of(model, signal);
    ASSERT_TRUE(truth.stable);
    for (const double noise : {0.01, 0.05, 0.2}) {
      EXPECT_LT(listen(signal, 2, noise * truth.forced_rms).first_s, 0.0) << noise;
    }
  }
}

TEST(Detector, HearsChatterUnderModulationInTime) {
  for (const Law law : {Law::sine, Law::triangle}) {
    CutModel model = slot(1.8);
    model.law = law;
    model.rva = 0.1;
    const CutSignal signal = simulate(model, 1.5);
    const Truth truth = truth_of(model, signal);
    ASSERT_TRUE(truth.chatters);
    for (const double noise : {0.01, 0.2, 1.0}) {
      const Heard heard = listen(signal, 2, noise * truth.forced_rms);
      EXPECT_GT(heard.first_s, 0.2) << noise;
      EXPECT_LT(heard.first_s, truth.onset_s + 0.15) << noise;
    }
  }
}

TEST(Detector, IsSilentWhereAToothOrderSweepsOverAResonance) {
  CutModel model = slot(0.05);
  model.accelerometer = true;
  model.law = Law::sine;
  model.rva = 0.15;
  const CutSignal signal = simulate(model, 3.0);
  ASSERT_TRUE(truth_of(model, signal).stable);
  auto detector = Detector::make({.sample_rate_hz = signal.rate_hz, .teeth = 2});
  ASSERT_TRUE(detector);
  double energy_ratio = 0.0;
  double free_ratio = 0.0;
  for (std::size_t i = 0; i < signal.value.size(); ++i) {
    const auto& out =
        detector->update({.value = signal.value[i], .speed_rev_s = signal.speed_rev_s[i]});
    EXPECT_FALSE(out.chatter);
    energy_ratio = std::max(energy_ratio, out.energy_ratio);
    free_ratio = std::max(free_ratio, out.free_ratio);
  }
  EXPECT_GT(energy_ratio, 0.3);  // the ratio of energies alone takes it for chatter
  EXPECT_LT(free_ratio, 0.1);
}

TEST(Detector, FallsSilentOnceTheChatterIsOver) {
  CutSignal signal = simulate(slot(0.6), 1.0);
  const CutSignal calm = simulate(slot(0.25), 2.0);
  signal.value.insert(signal.value.end(), calm.value.begin() + 4000, calm.value.end());
  signal.speed_rev_s.resize(signal.value.size(), signal.speed_rev_s.front());
  signal.angle_rev.resize(signal.value.size());
  const Heard heard = listen(signal, 2, 1e-4);
  EXPECT_GT(heard.first_s, 0.2);
  EXPECT_GT(heard.end_s, 1.0);
  EXPECT_LT(heard.end_s, 1.5);
}

TEST(Detector, UnfitInputIsSkippedWithItsReason) {
  auto detector = Detector::make({});
  ASSERT_TRUE(detector);
  EXPECT_EQ(detector->update({.value = std::nan(""), .speed_rev_s = 80.0}).reason,
            Reason::input_not_finite);
  EXPECT_EQ(detector->update({.value = 1.0, .speed_rev_s = 0.0}).reason,
            Reason::input_out_of_range);
  EXPECT_EQ(detector->update({.value = 1.0, .speed_rev_s = 1e9}).reason,
            Reason::input_out_of_range);
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(detector->update({.value = 1.0, .speed_rev_s = 80.0, .angle_rev = kInfinity}).reason,
            Reason::input_not_finite);
}

TEST(Detector, RefusesWhatIsOutOfRange) {
  EXPECT_FALSE(Detector::make({.sample_rate_hz = 60e3}));
  EXPECT_FALSE(Detector::make({.teeth = 0}));
  EXPECT_FALSE(Detector::make({.window_s = 0.0}));
  EXPECT_FALSE(Detector::make({.on_ratio = 0.5}));
  EXPECT_FALSE(Detector::make({.confirm = 0}));
  EXPECT_FALSE(Detector::make({.free_ratio = 2.0}));
}

}  // namespace
}  // namespace steadyrest::chatter::online::test
