// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <memory>
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

std::unique_ptr<LinesDevice> device_of(Held& held, Wiring wiring) {
  const auto lines = lines_of(wiring);
  LinesDevice::Parts parts;
  parts.wires = std::make_unique<HeldWires>(held);
  parts.feed =
      OverrideLine::make({.wires = lines.feed, .table = small_table(), .wiring = wiring}).value();
  return std::make_unique<LinesDevice>(lines, std::move(parts));
}

constexpr LineOrder kHalf{.feed = {.code = 3, .masks = true}, .spindle = {}};

TEST(LinesDevice, WritesNothingUntilTheLayerActs) {
  for (const Wiring wiring : {Wiring::relay, Wiring::plc}) {
    Held held;
    held.inputs = Levels(2);
    {
      const auto device = device_of(held, wiring);
      LineSample sample;
      for (int i = 0; i < 20; ++i) {
        ASSERT_TRUE(device->read(sample));
      }
    }
    EXPECT_TRUE(held.written.empty());
  }
}

TEST(LinesDevice, TheHeartbeatChangesWithEachOrder) {
  Held held;
  held.inputs = Levels(2);
  const auto device = device_of(held, Wiring::plc);
  LineSample sample;
  ASSERT_TRUE(device->read(sample));
  bool beat = false;
  for (int i = 0; i < 10; ++i) {
    ASSERT_TRUE(device->write(kHalf));
    beat = !beat;
    EXPECT_EQ(held.outputs[4], beat);
    ASSERT_TRUE(device->read(sample));
  }
}

TEST(LinesDevice, TheMaskComesOffWhenNobodyOrdersAnyMore) {
  for (const Wiring wiring : {Wiring::relay, Wiring::plc}) {
    Held held;
    held.inputs = Levels(2);
    const auto device = device_of(held, wiring);
    LineSample sample;
    for (int i = 0; i < 3; ++i) {
      ASSERT_TRUE(device->read(sample));
      ASSERT_TRUE(device->write(kHalf));
    }
    ASSERT_TRUE(held.outputs[3]);
    for (int i = 0; i < 3; ++i) {
      ASSERT_TRUE(device->read(sample));
      ASSERT_TRUE(held.outputs[3]);
    }
    ASSERT_TRUE(device->read(sample));
    EXPECT_FALSE(held.outputs[3]);
    const std::size_t written = held.written.size();
    ASSERT_TRUE(device->read(sample));
    EXPECT_EQ(held.written.size(), written) << "then it is silent";
  }
}

TEST(LinesDevice, ADeviceThatEndsTakesItsMaskOff) {
  Held held;
  held.inputs = Levels(2);
  {
    const auto device = device_of(held, Wiring::relay);
    LineSample sample;
    for (int i = 0; i < 3; ++i) {
      ASSERT_TRUE(device->read(sample));
      ASSERT_TRUE(device->write(kHalf));
    }
    ASSERT_TRUE(held.outputs[3]);
  }
  EXPECT_FALSE(held.outputs[3]);
}

TEST(LinesDevice, ThroughPassesThePanelOnWhileTheLayerIsOff) {
  Held held;
  const auto device = device_of(held, Wiring::through);
  LineSample sample;
  for (const unsigned code : {2U, 3U, 7U, 0U, 6U}) {
    held.inputs = Levels(code);
    ASSERT_TRUE(device->read(sample));
    EXPECT_EQ(held.outputs & Levels(7), Levels(code));
  }
}

TEST(LinesDevice, OutputsThatDifferTwiceAreALostLink) {
  Held held;
  held.inputs = Levels(2);
  const auto device = device_of(held, Wiring::plc);
  LineSample sample;
  ASSERT_TRUE(device->read(sample));
  ASSERT_TRUE(device->write(kHalf));
  held.outputs = {};  // a watchdog
  ASSERT_TRUE(device->read(sample)) << "a reading may fall between";
  const auto refused = device->read(sample);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, kernel::outcome::Kind::unavailable);
  EXPECT_EQ(refused.error().what, "output 0 of the module is off, but on was written");
  EXPECT_TRUE(device->read(sample)) << "and the layer begins again with what there is";
}

TEST(LinesDevice, AStuckOutputIsFoundAgainAndAgain) {
  Held held;
  held.inputs = Levels(2);
  held.stuck_on = Levels(4);
  const auto device = device_of(held, Wiring::plc);
  LineSample sample;
  int refused = 0;
  for (int i = 0; i < 12; ++i) {
    refused += device->read(sample) ? 0 : 1;
    ASSERT_TRUE(device->write(kHalf));
  }
  EXPECT_EQ(refused, 5) << "every second reading";
}

TEST(LinesDevice, AfterALostLinkItBeginsWithTheModulesOutputs) {
  Held held;
  held.inputs = Levels(2);
  const auto device = device_of(held, Wiring::plc);
  LineSample sample;
  ASSERT_TRUE(device->read(sample));
  ASSERT_TRUE(device->write(kHalf));
  held.cut = true;
  EXPECT_FALSE(device->read(sample));
  held.outputs = {};
  held.cut = false;
  ++held.connections;
  for (int i = 0; i < 3; ++i) {
    EXPECT_TRUE(device->read(sample));
  }
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
