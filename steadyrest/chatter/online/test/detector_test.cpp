// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include <steadyrest/chatter/online/detector.hpp>
#include <steadyrest/chatter/online/test/cut_signal.hpp>
#include <steadyrest/kernel/rt/testing/allocation_guard.hpp>
#include <steadyrest/kernel/testing/cases.hpp>

namespace steadyrest::chatter::online::test {
namespace {

using kernel::outcome::Reason;
using kernel::testing::cases;
using kernel::testing::kSanitized;

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

// When chatter was first reported and when the last report ended, with the first report's figures.
struct Heard {
  double first_s = -1.0;
  double end_s = -1.0;  ///< chatter was no longer reported
  double frequency_hz = 0.0;
  Detector::Kind kind = Detector::Kind::none;
  Detector::Output last;
};

Heard listen(const CutSignal& signal, std::size_t teeth, double noise, bool angle = false,
             unsigned seed = 5) {
  auto detector = Detector::make({.sample_rate_hz = signal.rate_hz, .teeth = teeth});
  EXPECT_TRUE(detector);
  std::mt19937_64 rng(seed);
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

// The truth comes from the simulation in cut_signal.hpp, which shares no code with the detector:
// when regeneration's part reaches a tenth of its final size. 0.15 s is the room's promise.
TEST(Detector, HearsTheSlotChatterInTimeAtFiveNoiseLevels) {
  const CutModel model = slot(0.6);
  const CutSignal signal = simulate(model, 2.0);
  const Truth truth = truth_of(model, signal);
  ASSERT_TRUE(truth.chatters);
  for (const double noise : cases({0.01, 0.05, 0.2, 0.5, 1.0})) {
    const Heard heard = listen(signal, 2, noise * truth.forced_rms);
    EXPECT_GT(heard.first_s, 0.2) << noise;
    EXPECT_LT(heard.first_s, truth.onset_s + 0.15) << noise;
    EXPECT_EQ(heard.kind, Detector::Kind::hopf) << noise;
    // Chatter of a Hopf lobe is a little above the natural 922 Hz.
    EXPECT_NEAR(heard.frequency_hz, 950.0, 50.0) << noise;
    EXPECT_EQ(heard.last.reason, Reason::chatter_detected);
  }
}

// 0.25 mm against a border of 0.4086: a false alarm here would slow down good cuts.
TEST(Detector, IsSilentInTheStableSlot) {
  const CutModel model = slot(0.25);
  const CutSignal signal = simulate(model, 3.0);
  const Truth truth = truth_of(model, signal);
  ASSERT_TRUE(truth.stable);
  for (const double noise : cases({0.01, 0.05, 0.2, 0.5})) {
    for (const bool angle : {false, true}) {
      const Heard heard = listen(signal, 2, noise * truth.forced_rms, angle);
      EXPECT_LT(heard.first_s, 0.0) << noise;
      EXPECT_EQ(heard.last.kind, Detector::Kind::forced) << noise;
    }
  }
}

// 0.3 mm is stable at constant speed, too; only the moving orders could be mistaken for lines.
TEST(Detector, IsSilentUnderModulation) {
  for (const Law law : {Law::sine, Law::triangle}) {
    CutModel model = slot(0.3);
    model.law = law;
    model.rva = 0.1;
    const CutSignal signal = simulate(model, 3.0);
    const Truth truth = truth_of(model, signal);
    ASSERT_TRUE(truth.stable);
    for (const double noise : cases({0.01, 0.05, 0.2})) {
      EXPECT_LT(listen(signal, 2, noise * truth.forced_rms).first_s, 0.0) << noise;
    }
  }
}

// Above the limit of both laws (1.45 and 1.00 mm at RVA 0.1, RVF 0.1, from the reference's table).
TEST(Detector, HearsChatterUnderModulationInTime) {
  for (const Law law : {Law::sine, Law::triangle}) {
    CutModel model = slot(1.8);
    model.law = law;
    model.rva = 0.1;
    const CutSignal signal = simulate(model, 1.5);
    const Truth truth = truth_of(model, signal);
    ASSERT_TRUE(truth.chatters);
    for (const double noise : cases({0.01, 0.2, 1.0})) {
      const Heard heard = listen(signal, 2, noise * truth.forced_rms);
      EXPECT_GT(heard.first_s, 0.2) << noise;
      EXPECT_LT(heard.first_s, truth.onset_s + 0.15) << noise;
    }
  }
}

// 0.05 mm is far below any border; the accelerometer makes the resonance as loud as it gets.
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
  EXPECT_GT(energy_ratio, 0.3);  // the energy ratio alone would call it chatter
  EXPECT_LT(free_ratio, 0.1);
}

TEST(Detector, IsSilentWhenTheToolEntersIntoNoiseAsLoudAsTheCut) {
  CutModel model = slot(0.49);  // two cuts whose entry at most doubles the energy
  model.accelerometer = true;
  model.frequency_hz = {670.0, 730.0};
  model.damping_ratio = {0.028, 0.025};
  model.stiffness_n_mm = {8700.0, 4000.0};
  model.immersion = 0.6;
  model.speed_rev_s = 70.0;
  CutModel other = model;
  other.up = false;
  other.teeth = 3;
  other.depth_mm = 0.34;
  other.frequency_hz = {460.0, 660.0};
  other.damping_ratio = {0.016, 0.016};
  other.stiffness_n_mm = {3200.0, 7600.0};
  other.immersion = 0.65;
  other.speed_rev_s = 68.0;
  for (const CutModel& cut : {model, other}) {
    const CutSignal signal = simulate(cut, 1.2);
    const Truth truth = truth_of(cut, signal);
    ASSERT_TRUE(truth.stable);
    for (unsigned seed = 1; seed <= (kSanitized ? 1U : 12U); ++seed) {
      EXPECT_LT(listen(signal, cut.teeth, truth.forced_rms, false, seed).first_s, 0.0) << seed;
    }
  }
}

/// In both, the modulation lets vibration grow for a while in each period.
TEST(Detector, IsSilentInCutsThatModulationKeepsStable) {
  CutModel triangle = slot(0.56);
  triangle.accelerometer = true;
  triangle.law = Law::triangle;
  triangle.rva = 0.13;
  triangle.rvf = 0.068;
  triangle.speed_rev_s = 195.0;
  triangle.teeth = 5;
  triangle.frequency_hz = {462.0, 585.0};
  triangle.damping_ratio = {0.012, 0.037};
  triangle.stiffness_n_mm = {7907.0, 7446.0};
  triangle.immersion = 0.64;
  CutModel sine = triangle;
  sine.depth_mm = 0.3;
  sine.law = Law::sine;
  sine.rva = 0.17;
  sine.rvf = 0.111;
  sine.speed_rev_s = 82.0;
  sine.teeth = 3;
  sine.frequency_hz = {1441.0, 718.0};
  sine.damping_ratio = {0.022, 0.014};
  sine.stiffness_n_mm = {9708.0, 8855.0};
  sine.immersion = 0.93;
  for (const CutModel& model : {triangle, sine}) {
    const CutSignal signal = simulate(model, 2.0);
    const Truth truth = truth_of(model, signal);
    ASSERT_TRUE(truth.stable);
    for (const double noise : cases({0.01, 0.05, 0.2, 0.5})) {
      EXPECT_LT(listen(signal, model.teeth, noise * truth.forced_rms).first_s, 0.0) << noise;
    }
  }
}

/// Rates over random cuts; bench/chatter/detector_hunt draws more of them.
TEST(Detector, HearsModulatedCutsDrawnByChanceInTime) {
  std::mt19937_64 rng(3);
  int chattering = 0;
  int in_time = 0;
  // Cuts that do not chatter, or too late for the record, are redrawn.
  constexpr int kCuts = kSanitized ? 1 : 15;
  while (chattering < kCuts) {
    CutModel model = random_cut(rng, true);
    model.air_s = 0.2;
    const CutSignal signal = simulate(model, 1.0);
    const Truth truth = truth_of(model, signal);
    if (!truth.chatters || truth.onset_s > 0.8) {
      continue;
    }
    ++chattering;
    for (const double noise : {0.05, 0.5}) {
      const Heard heard = listen(signal, model.teeth, noise * truth.forced_rms);
      in_time += heard.first_s >= 0.0 && heard.first_s <= truth.onset_s + 0.15 ? 1 : 0;
    }
  }
  EXPECT_GE(in_time, 2 * kCuts * 28 / 30);  // 95 % of 30 is 28.5
}

// The calm cut's entry is cut off, so that its quiet, not its entry, ends the alarm.
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
  // Fewer than four samples in a turn.
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
  EXPECT_FALSE(Detector::make({.speed_sd = 0.03}));
}

}  // namespace
}  // namespace steadyrest::chatter::online::test
