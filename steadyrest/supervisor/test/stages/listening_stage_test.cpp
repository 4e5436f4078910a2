// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/kernel/rt/testing/allocation_guard.hpp>
#include <steadyrest/supervisor/listening_stage.hpp>

namespace steadyrest::supervisor {
namespace {

using chatter::online::BetterSpeed;
using kernel::signal::Frame;
using kernel::signal::Motion;

constexpr double kRate_hz = 10e3;
constexpr double kFrame_s = 0.002;
constexpr double kSpeed_rev_s = 80.0;
constexpr std::size_t kTeeth = 2;

// At 80 rev/s of programmed speed the steps give 64, 72 and 80 rev/s; the table carries 1 mm of
// depth only at 72 rev/s, so the answer to chatter must be 0.9.
ListeningStage stage() {
  BetterSpeed::Config config;
  config.table.step_ratio = {0.8, 0.9, 1.0};
  config.table.max_ratio = 1.0;
  config.table.speed_rev_s = {60.0, 70.0, 72.0, 74.0, 100.0};
  config.table.limit_depth_mm = {0.1, 0.1, 2.0, 0.1, 0.1};
  config.detector.sample_rate_hz = kRate_hz;
  return ListeningStage::make({.better = config, .depth_mm = 1.0}).value();
}

/// Frames of a cut: tooth passing, and from 0.8 s on chatter that grows to full size.
class Cut {
 public:
  Frame frame() {
    samples_.clear();
    for (std::size_t i = 0; i < static_cast<std::size_t>(kFrame_s * kRate_hz + 0.5); ++i) {
      time_s_ += 1.0 / kRate_hz;
      const auto wave = [this](double hz) {
        return std::sin(2.0 * std::numbers::pi * hz * time_s_);
      };
      const double size = std::min(1.0, std::exp(40.0 * (time_s_ - 1.0)));
      samples_.push_back(wave(kTeeth * kSpeed_rev_s) +
                         (time_s_ > 0.8 ? 3.0 * size * wave(943.0) : 0.0));
    }
    Frame frame;
    frame.time_s = time_s_;
    frame.motion = Motion::feed;
    frame.spindle_programmed_rev_s = frame.spindle_actual_rev_s = kSpeed_rev_s;
    frame.vibration = samples_;
    frame.vibration_rate_hz = kRate_hz;
    return frame;
  }
  [[nodiscard]] double time_s() const { return time_s_; }

 private:
  double time_s_ = 0.0;
  std::vector<double> samples_;
};

// Two teeth at 80 rev/s pass at 160 Hz; 943 Hz is none of its multiples (6 · 160 = 960). The
// chatter grows by e^40 per second and reaches full size at 1 s: silence before 0.8 s, an answer
// within 0.3 s after full size.
TEST(ListeningStage, HearsChatterAndAsksForTheStepThatCarriesTheDepth) {
  auto listener = stage();
  Cut cut;
  double heard_s = 0.0;
  while (cut.time_s() < 1.5) {
    const auto& out = listener.update(cut.frame(), true);
    if (cut.time_s() < 0.8) {
      ASSERT_FALSE(out.chatter) << cut.time_s();
      ASSERT_EQ(out.request.ratio, 1.0);
    }
    if (heard_s == 0.0 && out.chatter) {
      heard_s = cut.time_s();
      EXPECT_DOUBLE_EQ(out.request.ratio, 0.9);
      EXPECT_NEAR(out.frequency_hz, 943.0, 10.0);
    }
  }
  EXPECT_GT(heard_s, 0.8);
  EXPECT_LT(heard_s, 1.3);
}

// The signal that the test above hears, spoiled in one respect each time.
TEST(ListeningStage, DoesNotListenToWhatIsNoCutOrNotFit) {
  const auto never = [](auto change, bool fit) {
    auto listener = stage();
    Cut cut;
    while (cut.time_s() < 1.5) {
      Frame frame = cut.frame();
      change(frame);
      ASSERT_FALSE(listener.update(frame, fit).chatter);
    }
  };
  never([](Frame&) {}, false);
  never([](Frame& f) { f.motion = Motion::tap; }, true);
  never([](Frame& f) { f.vibration_rate_hz = 5e3; }, true);
  never([](Frame& f) { f.vibration = {}; }, true);
}

TEST(ListeningStage, ForgetsWhenItIsReset) {
  auto listener = stage();
  Cut cut;
  while (cut.time_s() < 1.5) {
    listener.update(cut.frame(), true);
  }
  listener.reset();
  Frame frame = cut.frame();
  frame.vibration = {};
  const auto& out = listener.update(frame, true);
  EXPECT_FALSE(out.chatter);
  EXPECT_EQ(out.request.ratio, 1.0);
}

// The state is taken between the chatter's beginning and its detection, with every filter of the
// detector in mid-flight.
TEST(ListeningStage, ARestoredStateGoesOnAsItWouldHave) {
  auto listener = stage();
  Cut cut;
  while (cut.time_s() < 0.9) {
    listener.update(cut.frame(), true);
  }
  auto restored = stage();
  restored.restore(listener.state());
  bool heard = false;
  while (cut.time_s() < 1.5) {
    const Frame frame = cut.frame();
    const BetterSpeed::Output a = listener.update(frame, true);
    const BetterSpeed::Output& b = restored.update(frame, true);
    ASSERT_EQ(a.chatter, b.chatter);
    ASSERT_EQ(a.frequency_hz, b.frequency_hz);
    ASSERT_EQ(a.request.ratio, b.request.ratio);
    ASSERT_EQ(a.reason, b.reason);
    heard = heard || a.chatter;
  }
  EXPECT_TRUE(heard);
}

TEST(ListeningStage, TakesNoMemoryInTheCycle) {
  auto listener = stage();
  Cut cut;
  const Frame frame = cut.frame();
  const kernel::rt::testing::AllocationGuard guard;
  listener.update(frame, true);
}

}  // namespace
}  // namespace steadyrest::supervisor
