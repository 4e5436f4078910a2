// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <memory>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include <steadyrest/adapters/lines/lines_device.hpp>
#include <steadyrest/adapters/lines/spindle_watch.hpp>
#include <steadyrest/adapters/lines/testing/held_wires.hpp>

namespace steadyrest::adapters::lines {
namespace {

using kernel::machine::Wiring;
using testing::Held;
using testing::HeldWires;

// Codes 1, 3, 2, 6: Gray, 0, 50, 100, 120 %.
kernel::machine::OverrideTable small_table() {
  kernel::machine::OverrideTable table;
  table.ratio = {0.0, 0.5, 1.0, 1.2};
  table.code = {1, 3, 2, 6};
  return table;
}

kernel::machine::Lines lines_of(Wiring wiring) {
  kernel::machine::Lines lines;
  lines.wiring = wiring;
  lines.feed.panel = {0, 1, 2};
  lines.feed.out = {0, 1, 2};
  lines.feed.mask = wiring == Wiring::through ? kernel::machine::kNoLine : 3;
  lines.heartbeat = 4;
  return lines;
}

constexpr LineOrder kHalf{.feed = {.code = 3, .masks = true}, .spindle = {}};

/// A device on wires that the test holds, the panel at 100 %.
class DeviceScene {
 public:
  explicit DeviceScene(Wiring wiring, bool latched = true) {
    auto table = small_table();
    table.latched_word = latched;
    const auto lines = lines_of(wiring);
    held.inputs = Levels(2);
    LinesDevice::Parts parts;
    parts.wires = std::make_unique<HeldWires>(held);
    parts.feed =
        OverrideLine::make({.wires = lines.feed, .table = table, .wiring = wiring}).value();
    device = std::make_unique<LinesDevice>(lines, std::move(parts));
  }
  kernel::outcome::Result<void> read() { return device->read(sample); }
  void reads(int times) {
    for (int i = 0; i < times; ++i) {
      ASSERT_TRUE(read());
    }
  }
  void acts(int cycles) {
    for (int i = 0; i < cycles; ++i) {
      ASSERT_TRUE(read());
      ASSERT_TRUE(device->write(kHalf));
    }
  }
  [[nodiscard]] bool masks() const { return held.outputs[3]; }

  Held held;
  LineSample sample;
  std::unique_ptr<LinesDevice> device;
};

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
