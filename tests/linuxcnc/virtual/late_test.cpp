// SPDX-License-Identifier: Apache-2.0
// A layer that is late, and one that is dead, on LinuxCNC's own components connected by layer.hal:
// what the feed, the spindle and the offsets in force are in each servo cycle. The port is the real
// one; time is the servo thread's count.
#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>
#include <tests/linuxcnc/virtual/virtual_hal.hpp>

#include <steadyrest/adapters/linuxcnc/linuxcnc_port.hpp>
#include <steadyrest/kernel/file/testing/own_folder.hpp>

namespace steadyrest {
namespace {

using adapters::linuxcnc::LinuxCncPort;
using test::linuxcnc::VirtualHal;

constexpr double kHeld = 0.13;    ///< of the feed: what 10 µm ask for on a circle of 10 mm
constexpr double kSpindle = 0.8;  ///< likewise
constexpr int kLate = 21;         ///< servo cycles until the watchdog has found it
constexpr double kRounding = 1e-9;

/// Of one process: the components cannot be loaded twice.
VirtualHal* the_hal() {
  static const std::unique_ptr<VirtualHal> kHal = []() -> std::unique_ptr<VirtualHal> {
    auto hal = std::make_unique<VirtualHal>();
    const std::string folder = STEADYREST_SOURCE_DIR "/steadyrest/adapters/linuxcnc/";
    try {
      hal->load(kernel::file::testing::text_of_file(folder + "layer.hal"));
      hal->load(kernel::file::testing::text_of_file(folder + "layer_offsets.hal"));
    } catch (const std::runtime_error&) {
      return nullptr;
    }
    return hal;
  }();
  return kHal.get();
}

class Late : public testing::Test {
 protected:
  void SetUp() override {
    if (the_hal() == nullptr) {
      GTEST_SKIP() << "LinuxCNC is not installed";
    }
    hal_ = the_hal();
    hal_->hold_s = 1.0;
    hal_->rise_1_s = 2.0;
    hal_->set("motion.motion-type", 3.0);
    hal_->set("motion.motion-enabled", 1.0);
    hal_->set("halui.mode.is-auto", 1.0);
    hal_->set("halui.program.is-running", 1.0);
    hal_->set("halui.spindle.0.override.value", 1.0);
    panel(1.0);
    for (int i = 0; i < 12000; ++i) {
      hal_->cycle();  // nothing is left of an earlier layer
    }
    port_ = LinuxCncPort::make({.units = {.servo_period_s = VirtualHal::kPeriod_s}}, *hal_).value();
    command_.feed_masks_panel = command_.spindle_masks_panel = command_.write = true;
    command_.feed_ratio = kHeld;
    command_.spindle_ratio = kSpindle;
    run(100);
    ASSERT_NEAR(feed(), kHeld, kRounding);
    ASSERT_EQ(hal_->get("layer-alive"), 1.0);
  }
  void TearDown() override {
    if (hal_ != nullptr) {
      panel(1.0);
    }
  }

  void panel(double ratio) {
    panel_ = ratio;
    hal_->set("halui.feed-override.value", ratio);
  }
  /// Layer and panel together: LinuxCNC multiplies.
  [[nodiscard]] double feed() const { return panel_ * hal_->get("motion.adaptive-feed"); }
  [[nodiscard]] double spindle() const { return hal_->get("layer-spindle-in-force"); }
  [[nodiscard]] double path_offset() const { return hal_->get("layer-path-z-in-force"); }

  /// Cycles of a layer that is in time.
  void run(int cycles) {
    for (int i = 0; i < cycles; ++i) {
      hal_->cycle();
      ASSERT_TRUE(port_->read().has_value());
      ASSERT_TRUE(port_->write(command_).has_value());
    }
  }

  VirtualHal* hal_ = nullptr;
  std::unique_ptr<LinuxCncPort> port_;
  kernel::signal::Command command_;
  double panel_ = 1.0;
};

TEST_F(Late, NeverRaisesTheFeedHoweverManyHeartbeatsAreLostWithinTheHold) {
  for (const int lost : {1, 2, 5, 19, 21, 22, 23, 60, 100, 250, 500, 900, 990, 998}) {
    for (int i = 0; i < lost; ++i) {
      hal_->cycle();
      ASSERT_LE(feed(), kHeld + kRounding) << lost << " lost, cycle " << i;
      ASSERT_NEAR(spindle(), kSpindle, kRounding) << lost << " lost, cycle " << i;
    }
    EXPECT_EQ(hal_->get("layer-alive"), lost > kLate ? 0.0 : 1.0) << lost;
    for (int i = 0; i < 100; ++i) {  // it goes on, and arms the watchdog again
      run(1);
      ASSERT_NEAR(feed(), kHeld, kRounding) << lost << " lost, then " << i;
      ASSERT_NEAR(spindle(), kSpindle, kRounding);
    }
    EXPECT_EQ(hal_->get("layer-alive"), 1.0) << lost;
  }
}

// The next stall begins before the watchdog of the last one is armed again.
TEST_F(Late, NeverRaisesTheFeedInAnyRowOfStalls) {
  std::mt19937 random(3);
  std::uniform_int_distribution<int> lost(1, 990);
  std::uniform_int_distribution<int> between(1, 80);
  for (int i = 0; i < 100; ++i) {
    const int stall = lost(random);
    for (int k = 0; k < stall; ++k) {
      hal_->cycle();
      ASSERT_LE(feed(), kHeld + kRounding) << "stall " << i;
    }
    for (int k = between(random); k > 0; --k) {
      run(1);
      ASSERT_LE(feed(), kHeld + kRounding) << "after stall " << i;
    }
  }
}

TEST_F(Late, TheLayerGoesOnWithWhatItWantsNextWithoutAJump) {
  for (const double wanted : {0.05, 0.2, 0.9}) {
    const double before = feed();
    for (int i = 0; i < 300; ++i) {
      hal_->cycle();
      ASSERT_NEAR(feed(), before, kRounding);
    }
    command_.feed_ratio = wanted;
    double last = before;
    for (int i = 0; i < 600; ++i) {
      run(1);
      ASSERT_LE(feed() - last, 0.015 + kRounding);
      last = feed();
    }
    EXPECT_NEAR(feed(), wanted, kRounding);
  }
}

TEST_F(Late, TheOperatorsPanelWinsInTheHold) {
  for (int i = 0; i < 50; ++i) {
    hal_->cycle();
  }
  ASSERT_EQ(hal_->get("layer-alive"), 0.0);
  for (const double turned : {0.5, 0.1, 0.05, 0.0, 0.05, 0.3, 1.0, 2.0, 0.0, 1.2}) {
    panel(turned);
    hal_->cycle();
    EXPECT_NEAR(feed(), std::min(turned, kHeld), kRounding) << turned;
  }
}

TEST_F(Late, ADeadLayersWordEndsInTheStatedTimeByTheStatedRamp) {
  for (const double hold_s : {0.05, 0.3, 1.0}) {
    for (const double rise_1_s : {0.5, 2.0, 5.0}) {
      hal_->hold_s = hold_s;
      hal_->rise_1_s = rise_1_s;
      run(600);
      ASSERT_NEAR(feed(), kHeld, kRounding);
      const auto held = static_cast<int>(std::lround(1e3 * hold_s));
      const auto stated = held + static_cast<int>(std::lround(1e3 * (1.0 - kHeld) / rise_1_s)) + 2;
      int neutral = 0;
      double last = kHeld;
      double last_spindle = kSpindle;
      for (int i = 1; neutral == 0 && i <= stated; ++i) {
        hal_->cycle();
        if (i < held) {
          ASSERT_NEAR(feed(), kHeld, kRounding) << i;
        }
        ASSERT_LE(feed() - last, 1e-3 * rise_1_s + kRounding) << i;
        ASSERT_GE(feed(), last - kRounding) << i;
        ASSERT_LE(std::abs(spindle() - last_spindle), 1e-3 * rise_1_s + kRounding) << i;
        ASSERT_LE(feed(), spindle() + kRounding) << "feed per tooth rises";
        last = feed();
        last_spindle = spindle();
        neutral = feed() >= 1.0 - kRounding ? i : 0;
      }
      EXPECT_GE(neutral, stated - 5) << hold_s << " s, " << rise_1_s << " 1/s";
      EXPECT_NEAR(spindle(), 1.0, kRounding);
      run(1000);
    }
  }
}

// A process that was stopped for longer than the hold, and goes on while the HAL hands back.
TEST_F(Late, ALayerThatComesBackFromTheDeadDoesNotRaiseTheFeedFaster) {
  for (const int stopped : {1001, 1100, 1300, 1434, 1500, 3000}) {
    command_.feed_masks_panel = true;
    command_.feed_ratio = kHeld;
    run(1000);
    for (int i = 0; i < stopped; ++i) {
      hal_->cycle();
    }
    command_.feed_masks_panel = false;  // it begins at the panel
    command_.feed_ratio = 1.0;
    double last = feed();
    for (int i = 0; i < 800; ++i) {
      run(1);
      ASSERT_LE(feed() - last, 0.002 + kRounding) << stopped << ", then " << i;
      last = feed();
    }
    EXPECT_NEAR(feed(), 1.0, kRounding);
    EXPECT_EQ(hal_->get("layer-alive"), 1.0);
  }
}

TEST_F(Late, HandingBackOnPurposeIsNotHeld) {
  command_.feed_masks_panel = command_.spindle_masks_panel = false;
  run(59);  // 0.87 by 15 1/s
  EXPECT_NEAR(feed(), 1.0, kRounding);
  EXPECT_NEAR(spindle(), 1.0, kRounding);
}

// What HalProcess writes when it ends.
TEST_F(Late, AnEndInGoodOrderIsNotHeld) {
  hal_->write_pins({});
  double last = feed();
  int cycles = 0;
  for (; feed() < 1.0 - kRounding && cycles < 1000; ++cycles) {
    hal_->cycle();
    ASSERT_LE(feed() - last, 0.015 + kRounding);
    last = feed();
  }
  EXPECT_LE(cycles, 59) << "0.87 by 15 1/s";
}

// Turned by 60 degrees it would be worse than none.
TEST_F(Late, APathOffsetGoesAsSoonAsTheLayerIsLateAndComesBackWithIt) {
  command_.path_offset_mm[2] = 0.2;
  command_.offset_mm[2] = 0.01;
  run(400);
  ASSERT_NEAR(path_offset(), 0.2, kRounding);
  const double heat = hal_->get("layer-offset-2");
  for (int i = 1; i <= kLate + 41; ++i) {
    hal_->cycle();
    ASSERT_NEAR(path_offset(), std::clamp(0.2 - 0.005 * (i - kLate), 0.0, 0.2), 0.0051) << i;
    ASSERT_NEAR(feed(), kHeld, kRounding);
  }
  EXPECT_NEAR(path_offset(), 0.0, kRounding);
  EXPECT_EQ(hal_->get("layer-offset-2"), heat);
  run(400);
  EXPECT_NEAR(path_offset(), 0.2, kRounding);
}

// layer.hal is loaded, and no process has ever come.
TEST_F(Late, WithoutALayerTheFeedIsThePanels) {
  for (int i = 0; i < 3000; ++i) {
    hal_->cycle();
  }
  for (const double turned : {0.0, 0.05, 0.5, 1.0, 2.0}) {
    panel(turned);
    hal_->cycle();
    EXPECT_NEAR(feed(), turned, kRounding);
  }
}

}  // namespace
}  // namespace steadyrest
