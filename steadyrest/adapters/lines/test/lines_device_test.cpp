// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <memory>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include <steadyrest/adapters/lines/lines_device.hpp>
#include <steadyrest/adapters/lines/spindle_watch.hpp>
#include <steadyrest/adapters/lines/testing/device_scene.hpp>

namespace steadyrest::adapters::lines {
namespace {

using kernel::machine::Wiring;
using testing::DeviceScene;
using testing::Held;
using testing::HeldWires;
using testing::kHalf;
using testing::lines_of;

class WithAWayBack : public ::testing::TestWithParam<Wiring> {};

TEST_P(WithAWayBack, WritesNothingUntilTheLayerActs) {
  DeviceScene scene(GetParam());
  scene.reads(20);
  scene.device.reset();
  EXPECT_TRUE(scene.held.written.empty());
}

TEST_P(WithAWayBack, TheMaskComesOffWhenNobodyOrdersAnyMore) {
  DeviceScene scene(GetParam());
  scene.acts(3);
  ASSERT_TRUE(scene.masks());
  scene.reads(3);
  ASSERT_TRUE(scene.masks());
  scene.reads(1);
  EXPECT_FALSE(scene.masks());
  const std::size_t written = scene.held.written.size();
  scene.reads(1);
  EXPECT_EQ(scene.held.written.size(), written) << "then it is silent";
}

TEST_P(WithAWayBack, ADeviceThatEndsTakesItsMaskOff) {
  DeviceScene scene(GetParam());
  scene.acts(3);
  ASSERT_TRUE(scene.masks());
  scene.device.reset();
  EXPECT_FALSE(scene.masks());
}

INSTANTIATE_TEST_SUITE_P(Wirings, WithAWayBack, ::testing::Values(Wiring::relay, Wiring::plc),
                         [](const auto& wiring) {
                           return wiring.param == Wiring::relay ? "relay" : "plc";
                         });

TEST(LinesDevice, TheHeartbeatChangesWithEachOrder) {
  DeviceScene scene(Wiring::plc);
  bool beat = false;
  for (int i = 0; i < 10; ++i) {
    scene.acts(1);
    beat = !beat;
    EXPECT_EQ(scene.held.outputs[4], beat);
  }
}

TEST(LinesDevice, ThroughPassesThePanelOnWhileTheLayerIsOff) {
  DeviceScene scene(Wiring::through);
  for (const unsigned code : {2U, 3U, 7U, 0U, 6U}) {
    scene.held.inputs = Levels(code);
    scene.reads(1);
    EXPECT_EQ(scene.held.outputs & Levels(7), Levels(code));
  }
}

// A module's watchdog counts writes: a panel that nobody turns must reach it all the same.
TEST(LinesDevice, ThroughWritesAtEachReadingThoughNothingTurns) {
  DeviceScene scene(Wiring::through);
  scene.reads(5);
  EXPECT_EQ(scene.held.written.size(), 5U);
}

TEST(LinesDevice, WhoOnlyLooksWritesNothing) {
  DeviceScene scene(Wiring::through, true, true);
  scene.reads(5);
  EXPECT_EQ(scene.sample.feed.panel_ratio, 1.0);
  EXPECT_TRUE(scene.held.written.empty());
}

// The module keeps its outputs; a relay that watches the heartbeat has let go meanwhile.
TEST(LinesDevice, AfterALongStandstillItBeginsWithoutMasks) {
  DeviceScene scene(Wiring::relay);
  scene.acts(5);
  ASSERT_TRUE(scene.masks());
  scene.held.cut = true;
  EXPECT_FALSE(scene.read());
  scene.held.cut = false;
  scene.held.now_s += 0.05;
  scene.acts(1);
  EXPECT_TRUE(scene.masks()) << "the machine has it still";
  scene.held.cut = true;
  EXPECT_FALSE(scene.read());
  scene.held.cut = false;
  scene.held.now_s += 0.5;
  scene.acts(1);
  EXPECT_FALSE(scene.masks());
  EXPECT_EQ(scene.held.outputs & Levels(7), Levels(2)) << "the panel's word";
}

// The link lives on, and the module has kept everything: before a reading, or after it.
TEST(LinesDevice, AfterAStandstillOfTheProcessItBeginsWithoutMasks) {
  for (const bool after_the_reading : {false, true}) {
    DeviceScene scene(Wiring::relay);
    scene.acts(5);
    ASSERT_TRUE(scene.masks());
    const std::size_t written = scene.held.written.size();
    if (after_the_reading) {
      scene.reads(1);
      scene.held.now_s += 0.5;
      ASSERT_TRUE(scene.device->write(kHalf));
      EXPECT_EQ(scene.held.written.size(), written) << "nothing goes out unseen";
    } else {
      scene.held.now_s += 0.5;
    }
    scene.acts(1);
    EXPECT_FALSE(scene.masks());
    EXPECT_EQ(scene.held.outputs & Levels(7), Levels(2)) << "the panel's word";
    scene.acts(5);
    EXPECT_TRUE(scene.masks());
  }
}

// `locked_inverted`, and the wire has broken.
TEST(LinesDevice, AMachineThatStandsIsNotHeld) {
  auto lines = lines_of(Wiring::plc);
  lines.locked = testing::kLocked;
  lines.locked_inverted = true;
  lines.running = 8;
  Held held;
  LinesDevice::Parts parts;
  parts.wires = std::make_unique<HeldWires>(held);
  LinesDevice device(lines, std::move(parts));
  LineSample sample;
  held.inputs.set(lines.running);
  ASSERT_TRUE(device.read(sample));
  EXPECT_TRUE(sample.in_thread);
  held.inputs.reset(lines.running);
  ASSERT_TRUE(device.read(sample));
  EXPECT_TRUE(sample.in_thread);
  held.now_s += lines.locked_hold_s;
  ASSERT_TRUE(device.read(sample));
  EXPECT_FALSE(sample.in_thread);
}

TEST(LinesDevice, AThreadLastsFromPassToPass) {
  DeviceScene scene(Wiring::relay);
  scene.reads(1);
  EXPECT_FALSE(scene.sample.in_thread);
  scene.held.inputs.set(testing::kLocked);
  scene.reads(1);
  EXPECT_TRUE(scene.sample.in_thread);
  scene.held.inputs.reset(testing::kLocked);
  const int readings = static_cast<int>(lines_of(Wiring::relay).locked_hold_s / Held::kCycle_s);
  scene.reads(readings - 1);
  EXPECT_TRUE(scene.sample.in_thread);
  scene.reads(2);
  EXPECT_FALSE(scene.sample.in_thread);
}

TEST(LinesDevice, AWatchdogMayTakeTheMaskAlone) {
  DeviceScene scene(Wiring::plc);
  for (int i = 0; i < 6; ++i) {
    scene.acts(5);
    ASSERT_TRUE(scene.masks());
    scene.held.outputs.reset(3);
    if (i % 2 == 0) {
      scene.held.outputs.reset(4);  // the heartbeat, too
    }
    scene.held.now_s += 0.15;  // the computer stood still
    ASSERT_TRUE(scene.read());
    const auto refused = scene.read();
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().what.find("let go"), std::string::npos) << "no other client";
  }
}

/// Counts how often it was read.
class CountedEncoders final : public EncoderSource {
 public:
  explicit CountedEncoders(int& readings) : readings_(readings) {}
  kernel::outcome::Result<EncoderReading> next() override {
    ++readings_;
    return EncoderReading();
  }

 private:
  int& readings_;
};

TEST(LinesDevice, EncodersAreReadWhileTheLinkIsCut) {
  Held held;
  int readings = 0;
  LinesDevice::Parts parts;
  parts.wires = std::make_unique<HeldWires>(held);
  parts.encoders = std::make_unique<CountedEncoders>(readings);
  LinesDevice device(lines_of(Wiring::plc), std::move(parts));
  LineSample sample;
  held.cut = true;
  for (int i = 0; i < 3; ++i) {
    const auto read = device.read(sample);
    ASSERT_FALSE(read);
    EXPECT_EQ(read.error().what, "the link is cut");
  }
  EXPECT_EQ(readings, 3) << "without them a gap would end the positions for good";
  held.cut = false;
  EXPECT_TRUE(device.read(sample));
}

TEST(LinesDevice, OutputsThatDifferTwiceAreALostLink) {
  DeviceScene scene(Wiring::plc);
  scene.acts(3);
  scene.held.outputs = {};  // a watchdog
  ASSERT_TRUE(scene.read()) << "a reading may fall between";
  const auto refused = scene.read();
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, kernel::outcome::Kind::unavailable);
  EXPECT_EQ(refused.error().what, "output 0 of the module is off, but on was written");
  EXPECT_EQ(scene.held.disconnected, 1) << "the next connection clears the watchdog";
  EXPECT_TRUE(scene.read()) << "and the layer begins again with what there is";
}

TEST(LinesDevice, OutputsThatDropAreNotPutBackInOneStep) {
  DeviceScene scene(Wiring::relay);
  scene.acts(5);
  ASSERT_TRUE(scene.masks());
  scene.held.outputs = {};  // a watchdog, while the layer goes on
  ASSERT_TRUE(scene.read());
  ASSERT_TRUE(scene.device->write(kHalf));
  EXPECT_TRUE(scene.held.outputs.none());
  EXPECT_FALSE(scene.read());
  ASSERT_TRUE(scene.read());
  ASSERT_TRUE(scene.device->write(kHalf));
  EXPECT_FALSE(scene.masks()) << "the panel's word settles first";
}

TEST(LinesDevice, AfterALostLinkItBeginsWithTheModulesOutputs) {
  DeviceScene scene(Wiring::plc);
  scene.acts(1);
  scene.held.cut = true;
  EXPECT_FALSE(scene.read());
  scene.held.outputs = {};
  scene.held.cut = false;
  ++scene.held.connections;
  scene.reads(3);
}

// Settled at 10 rev/s and 100 %, then modulated by ±20 %: the programmed speed stays.
TEST(SpindleWatch, KeepsTheProgrammedSpeedUnderModulation) {
  SpindleWatch watch(4096.0);
  double count = 0.0;
  double time_s = 0.0;
  const auto turn = [&](double rev_s, double ratio, double seconds) {
    for (const double end_s = time_s + seconds; time_s < end_s;) {
      time_s += 0.01;
      count += 4096.0 * rev_s * 0.01;
      watch.update(time_s, std::floor(count), ratio);
    }
  };
  turn(10.0, 1.0, 0.9);
  EXPECT_EQ(watch.programmed_rev_s(), 0.0) << "not settled for long enough";
  turn(10.0, 1.0, 0.6);
  EXPECT_NEAR(watch.programmed_rev_s(), 10.0, 0.01);
  EXPECT_NEAR(watch.actual_rev_s(), 10.0, 0.05);
  for (int i = 0; i < 20; ++i) {
    turn(8.0, 0.8, 0.5);
    turn(12.0, 1.2, 0.5);
  }
  EXPECT_NEAR(watch.programmed_rev_s(), 10.0, 0.01);
  turn(16.0, 0.8, 2.0);
  EXPECT_NEAR(watch.programmed_rev_s(), 20.0, 0.02);
}

}  // namespace
}  // namespace steadyrest::adapters::lines
