// SPDX-License-Identifier: Apache-2.0
// Outputs that others change: a watchdog, a stuck line, another layer.
#include <memory>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include <steadyrest/adapters/lines/testing/device_scene.hpp>

namespace steadyrest::adapters::lines {
namespace {

using kernel::machine::Wiring;
using testing::DeviceScene;
using testing::HeldWires;
using testing::kHalf;
using testing::lines_of;
using testing::small_table;

/// Reads and orders until the layer lets go; how many readings were refused on the way.
int lets_go(DeviceScene& scene) {
  for (int refused = 1, i = 0; i < 100; ++i) {
    const auto read = scene.read();
    if (!read && read.error().what.find("has let go of the outputs") != std::string::npos) {
      return refused;
    }
    refused += read ? 0 : 1;
    EXPECT_TRUE(scene.device->write(kHalf));
  }
  return -1;
}

TEST(LinesDevice, AStuckOutputIsFoundThreeTimesThenTheLayerLetsGoForGood) {
  DeviceScene scene(Wiring::plc);
  scene.held.stuck_on = Levels(4);
  EXPECT_EQ(lets_go(scene), 3);
  EXPECT_FALSE(scene.masks());
  scene.held.stuck_on = {};
  const std::size_t written = scene.held.written.size();
  for (int i = 0; i < 10; ++i) {
    EXPECT_FALSE(scene.read());
    EXPECT_FALSE(scene.device->write(kHalf));
  }
  EXPECT_EQ(scene.held.written.size(), written);
}

TEST(LinesDevice, TwoLayersOnOneModuleBothLetGo) {
  DeviceScene scene(Wiring::plc);
  const auto lines = lines_of(Wiring::plc);
  LinesDevice::Parts parts;
  parts.wires = std::make_unique<HeldWires>(scene.held);
  parts.feed =
      OverrideLine::make({.wires = lines.feed, .table = small_table(), .wiring = Wiring::plc})
          .value();
  LinesDevice second(lines, std::move(parts));
  LineSample sample;
  constexpr LineOrder kFull{.feed = {.code = 2, .masks = true}, .spindle = {}};
  for (int i = 0; i < 100; ++i) {
    static_cast<void>(scene.read());
    static_cast<void>(scene.device->write(kHalf));
    static_cast<void>(second.read(sample));
    static_cast<void>(second.write(kFull));
  }
  const auto first = scene.read();
  const auto other = second.read(sample);
  ASSERT_TRUE(!first && !other);
  EXPECT_NE(first.error().what.find("has let go of the outputs"), std::string::npos);
  EXPECT_NE(other.error().what.find("has let go of the outputs"), std::string::npos);
  EXPECT_FALSE(scene.masks());
}

TEST(LinesDevice, ALayerDoesNotBeginWhileAnotherOnesHeartbeatBeats) {
  DeviceScene scene(Wiring::plc);
  scene.reads(3);
  for (int i = 0; i < 5; ++i) {
    scene.held.outputs = Levels(0b01010);
    scene.held.outputs[4] = i % 2 == 0;
    scene.reads(1);
    const auto refused = scene.device->write(kHalf);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().what,
              "output 4, the heartbeat, changes though this layer does not act: another one acts "
              "on this module");
  }
  EXPECT_TRUE(scene.held.written.empty());
  scene.reads(60);  // it has ended
  EXPECT_TRUE(scene.device->write(kHalf));
}

TEST(LinesDevice, ReadingBackAtAnotherAddressIsFound) {
  DeviceScene scene(Wiring::plc);
  scene.held.reads_back_nothing = true;
  EXPECT_EQ(lets_go(scene), 3);
}

TEST(LinesDevice, ThroughPassesThePanelOnAfterItHasLetGo) {
  DeviceScene scene(Wiring::through);
  scene.held.stuck_on = Levels(1U << 4U);  // the heartbeat
  ASSERT_EQ(lets_go(scene), 3);
  scene.held.inputs = Levels(3);
  EXPECT_FALSE(scene.read());
  EXPECT_EQ(scene.held.outputs & Levels(7), Levels(3));
}

// From 1 to 6 the bits in between may read as other positions.
TEST(LinesDevice, ThroughRisesToThePanelByWholeSteps) {
  for (const bool has_let_go : {false, true}) {
    DeviceScene scene(Wiring::through, false);
    scene.held.inputs = Levels(6);
    scene.reads(2);
    for (int i = 0; i < 4; ++i) {
      ASSERT_TRUE(scene.read());
      ASSERT_TRUE(scene.device->write({.feed = {.code = 1, .masks = true}, .spindle = {}}));
    }
    ASSERT_EQ(scene.held.outputs & Levels(7), Levels(1));
    if (has_let_go) {
      scene.held.stuck_on = Levels(1U << 4U);
      for (int i = 0;
           i < 100 && scene.device->write({.feed = {.code = 1, .masks = true}, .spindle = {}});
           ++i) {
        static_cast<void>(scene.read());
      }
    }
    for (int i = 0; i < 8; ++i) {
      static_cast<void>(scene.read());
    }
    EXPECT_EQ(scene.held.outputs & Levels(7), Levels(6));
    Levels before = scene.held.written.front();
    for (const Levels& written : scene.held.written) {
      EXPECT_LE(((written ^ before) & Levels(7)).count(), 1U) << "one wire at a time";
      before = written;
    }
  }
}

TEST(LinesDevice, AnAnswerThatIsLostLeavesMaskAndWordWhereTheyAre) {
  for (const Wiring wiring : {Wiring::plc, Wiring::relay}) {
    DeviceScene scene(wiring, false);
    scene.acts(6);
    ASSERT_TRUE(scene.masks());
    ASSERT_EQ(scene.held.outputs & Levels(7), Levels(3));
    scene.held.cut = true;
    ASSERT_FALSE(scene.read());
    ++scene.held.connections;
    scene.held.cut = false;
    for (int i = 0; i < 5; ++i) {
      scene.acts(1);
      EXPECT_TRUE(scene.masks());
      EXPECT_EQ(scene.held.outputs & Levels(7), Levels(3));
    }
  }
}

TEST(LinesDevice, AReleaseThatIsLostIsTriedAgain) {
  DeviceScene scene(Wiring::plc);
  scene.acts(3);
  ASSERT_TRUE(scene.masks());
  scene.reads(3);
  scene.held.write_fails = true;
  EXPECT_FALSE(scene.read());
  EXPECT_TRUE(scene.masks());
  scene.held.write_fails = false;
  scene.reads(1);
  EXPECT_FALSE(scene.masks());
}

TEST(LinesDevice, AWatchdogThatDropsWhatNobodyWritesAnyMoreIsNoFault) {
  DeviceScene scene(Wiring::relay);
  for (int i = 0; i < 5; ++i) {
    scene.acts(3);
    scene.reads(5);  // observe
    scene.held.outputs = {};
    scene.reads(5);
  }
}

TEST(LinesDevice, OutputsThatAWatchdogDropsAgainAndAgainAreNobodyElses) {
  DeviceScene scene(Wiring::plc);
  for (int i = 0; i < 5; ++i) {
    scene.acts(3);
    scene.held.outputs = {};
    ASSERT_TRUE(scene.read());
    EXPECT_FALSE(scene.read());
  }
  scene.acts(3);
  EXPECT_TRUE(scene.masks());
}

TEST(LinesDevice, FaultsThatAreFarApartAreLostLinksEach) {
  DeviceScene scene(Wiring::plc);
  for (int i = 0; i < 5; ++i) {
    scene.acts(2);
    scene.held.outputs = Levels(6);
    ASSERT_TRUE(scene.read());
    ASSERT_FALSE(scene.read());
    scene.held.now_s += 61.0;
  }
  scene.acts(2);
}

}  // namespace
}  // namespace steadyrest::adapters::lines
