// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <memory>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/adapters/linuxcnc/linuxcnc_port.hpp>
#include <steadyrest/adapters/linuxcnc/test/fake_hal.hpp>
#include <steadyrest/kernel/rt/testing/allocation_guard.hpp>

namespace steadyrest::adapters::linuxcnc {
namespace {

using kernel::outcome::Kind;
using kernel::signal::Command;
using test::cutting;
using test::FakeHal;
using testing::HasSubstr;

const LinuxCncPort::Config kMillPort{.units = {.servo_period_s = 0.001}};
const Command kHalf{.feed_ratio = 0.5, .feed_masks_panel = true, .write = true};

std::unique_ptr<LinuxCncPort> port_on(FakeHal& hal) {
  return std::move(LinuxCncPort::make(kMillPort, hal).value());
}

TEST(LinuxCncPort, RefusesAnUnknownServoPeriod) {
  FakeHal hal;
  const auto made = LinuxCncPort::make({}, hal);
  ASSERT_FALSE(made.has_value());
  EXPECT_EQ(made.error().kind, Kind::bad_input);
  EXPECT_THAT(made.error().to_do, HasSubstr("SERVO_PERIOD"));
}

TEST(LinuxCncPort, RefusesFiguresOutOfRange) {
  FakeHal hal;
  for (const auto& spoil : {+[](LinuxCncPort::Config& c) { c.units.axes = 0; },
                            +[](LinuxCncPort::Config& c) { c.units.axes = 9; },
                            +[](LinuxCncPort::Config& c) { c.units.linear_unit_mm = 0.0; },
                            +[](LinuxCncPort::Config& c) { c.lost_after_s = 0.001; }}) {
    auto config = kMillPort;
    spoil(config);
    EXPECT_FALSE(LinuxCncPort::make(config, hal).has_value());
  }
}

TEST(LinuxCncPort, HandsOutEachCycleOnceAndSaysHowOldItIs) {
  FakeHal hal;
  const auto port = port_on(hal);
  for (std::uint64_t tick = 1; tick <= 5; ++tick) {
    hal.push(cutting(tick));
  }
  for (std::uint64_t tick = 1; tick <= 5; ++tick) {
    const auto frame = port->read();
    ASSERT_TRUE(frame.has_value());
    EXPECT_EQ(frame->cycle, tick);
    EXPECT_DOUBLE_EQ(frame->age_s, 0.001 * static_cast<double>(5 - tick));
  }
  EXPECT_EQ(hal.pauses, 0U);
}

TEST(LinuxCncPort, SkipsToTheNewestWhenItIsFarBehind) {
  FakeHal hal;
  const auto port = port_on(hal);
  for (std::uint64_t tick = 1; tick <= 100; ++tick) {
    hal.push(cutting(tick));
  }
  const auto frame = port->read();
  ASSERT_TRUE(frame.has_value());
  EXPECT_EQ(frame->cycle, 100U);
  EXPECT_EQ(frame->age_s, 0.0);
  EXPECT_EQ(port->skipped(), 99U);
  EXPECT_EQ(port->missed(), 0U);
}

TEST(LinuxCncPort, LosesTheLinkWhenNoSampleComes) {
  FakeHal hal;
  const auto port = port_on(hal);
  const auto frame = port->read();
  ASSERT_FALSE(frame.has_value());
  EXPECT_EQ(frame.error().kind, Kind::unavailable);
  EXPECT_EQ(hal.pauses, 1000U);  // 0.1 s in tenths of a period
}

TEST(LinuxCncPort, SaysWhatIsWrongWithTheCounter) {
  FakeHal hal;
  const auto port = port_on(hal);
  hal.push(cutting(7));
  hal.push(cutting(7));
  hal.push(cutting(2));
  EXPECT_TRUE(port->read().has_value());
  const auto frozen = port->read();
  ASSERT_FALSE(frozen.has_value());
  EXPECT_THAT(frozen.error().what, HasSubstr("does not change"));
  const auto restarted = port->read();
  ASSERT_FALSE(restarted.has_value());
  EXPECT_THAT(restarted.error().what, HasSubstr("went back"));
}

TEST(LinuxCncPort, BeatsWithEveryWriteAndArmsTheWatchdogAfterTheFirstBeats) {
  FakeHal hal;
  const auto port = port_on(hal);
  for (std::uint64_t tick = 1; tick <= 10; ++tick) {
    hal.push(cutting(tick));
    ASSERT_TRUE(port->read().has_value());
    ASSERT_TRUE(port->write(kHalf).has_value());
  }
  EXPECT_FALSE(hal.written.front().armed);
  EXPECT_TRUE(hal.written.back().armed);
  for (std::size_t i = 1; i < hal.written.size(); ++i) {
    EXPECT_NE(hal.written[i].heartbeat, hal.written[i - 1].heartbeat);
    EXPECT_EQ(hal.written[i].feed, 0.5);
  }
  EXPECT_EQ(port->rearmed(), 0U);
}

TEST(LinuxCncPort, ArmsAWatchdogThatHasCutItOffAgain) {
  FakeHal hal;
  const auto port = port_on(hal);
  bool was_released = false;
  for (std::uint64_t tick = 1; tick <= 100; ++tick) {
    Sample sample = cutting(tick);
    sample[Column::layer_alive] = tick < 40 || was_released ? 1.0 : 0.0;
    hal.push(sample);
    ASSERT_TRUE(port->read().has_value());
    ASSERT_TRUE(port->write(kHalf).has_value());
    was_released = was_released || (tick > 40 && !hal.written.back().armed);
  }
  EXPECT_TRUE(was_released);
  EXPECT_TRUE(hal.written.back().armed);
  EXPECT_TRUE(port->in_force());
  EXPECT_EQ(port->rearmed(), 1U);
}

TEST(LinuxCncPort, WritesNothingOutsideTheModeAct) {
  FakeHal hal;
  const auto port = port_on(hal);
  EXPECT_FALSE(port->write({.feed_ratio = 0.5, .write = false}).has_value());
  EXPECT_TRUE(hal.written.empty());
}

TEST(LinuxCncPort, WritesNoOffsetThatNobodyConnected) {
  FakeHal hal;
  const auto port = port_on(hal);
  Command command = kHalf;
  command.offset_mm[2] = 0.01;
  command.path_offset_mm[2] = 0.01;
  hal.push(cutting(1));
  ASSERT_TRUE(port->read().has_value());
  ASSERT_TRUE(port->write(command).has_value());
  EXPECT_FALSE(port->capability().axis_offset);
  EXPECT_FALSE(port->capability().path_offset);
  EXPECT_EQ(hal.written.back().offset[2], 0.0);
  EXPECT_EQ(hal.written.back().path_offset[2], 0.0);
}

// In the control's unit, an inch here; A is rotary.
TEST(LinuxCncPort, StatesTheSlowestAccelerationOfItsLinearOffsets) {
  FakeHal hal;
  auto config = kMillPort;
  config.units.linear_unit_mm = 25.4;
  const auto stated = [&] {
    return LinuxCncPort::make(config, hal).value()->capability().path_offset_acceleration_mm_s2;
  };
  EXPECT_EQ(stated(), 0.0) << "not known";
  hal.acceleration = {20.0, 15.77, 0.0, 1.0};
  EXPECT_EQ(stated(), 400.0) << "15.77 in/s², in whole mm/s²";
  hal.acceleration = {0.01};
  EXPECT_EQ(stated(), 1.0) << "slow, not unlimited";
}

TEST(LinuxCncPort, OffsetsGrowByOneMillimetrePerSecondOnAnInchMachineToo) {
  FakeHal hal;
  hal.with_offsets = true;
  auto config = kMillPort;
  config.units.linear_unit_mm = 25.4;
  const auto port = LinuxCncPort::make(config, hal).value();
  Command command = kHalf;
  command.offset_mm[2] = 0.1;
  for (std::uint64_t tick = 1; tick <= 2; ++tick) {
    Sample sample = cutting(tick);
    sample[Column::enabled] = tick == 1 ? 0.0 : 1.0;
    hal.push(sample);
    ASSERT_TRUE(port->read().has_value());
    ASSERT_TRUE(port->write(command).has_value());
  }
  EXPECT_NEAR(25.4 * hal.written.back().offset[2], 0.001, 1e-9);
}

// 0.3 mm against the contour error go out at 5 mm/s in the servo thread; 0.05 mm against heat stay.
TEST(LinuxCncPort, LetsThePathOffsetOfAnEarlierLayerRampOutFirst) {
  FakeHal hal;
  hal.with_offsets = true;
  hal.offset_before[2] = 0.05;
  const auto port = port_on(hal);
  Command command = kHalf;
  command.offset_mm[2] = 0.05;
  command.path_offset_mm[2] = 0.2;
  for (std::uint64_t tick = 1; tick <= 90; ++tick) {
    Sample sample = cutting(tick);
    const double left = std::max(0.0, 0.3 - 0.005 * static_cast<double>(tick));
    sample.axis[2].offset = 0.05 + left;
    const bool armed = !hal.written.empty() && hal.written.back().armed;
    sample[Column::layer_alive] = armed ? 1.0 : 0.0;
    hal.push(sample);
    ASSERT_TRUE(port->read().has_value());
    ASSERT_TRUE(port->write(command).has_value());
    const auto& pins = hal.written.back();
    EXPECT_EQ(pins.armed, left < 0.002) << tick;
    EXPECT_EQ(pins.path_offset[2], armed ? 0.2 : 0.0) << tick;
    EXPECT_EQ(pins.offset[2], 0.05);
  }
}

// Another program may use the offsets, too.
TEST(LinuxCncPort, WaitsForThatThreeHundredCyclesAtMost) {
  FakeHal hal;
  hal.with_offsets = true;
  const auto port = port_on(hal);
  for (std::uint64_t tick = 1; tick <= 310; ++tick) {
    Sample sample = cutting(tick);
    sample.axis[2].offset = 1.0;
    hal.push(sample);
    ASSERT_TRUE(port->read().has_value());
    ASSERT_TRUE(port->write(kHalf).has_value());
    EXPECT_EQ(hal.written.back().armed, tick > 300) << tick;
  }
}

TEST(LinuxCncPort, AllocatesNothingInACycle) {
  FakeHal hal;
  const auto port = port_on(hal);
  for (std::uint64_t tick = 1; tick <= 100; ++tick) {
    hal.push(cutting(tick));
    const kernel::rt::testing::AllocationGuard guard;
    ASSERT_TRUE(port->read().has_value());
    ASSERT_TRUE(port->write(kHalf).has_value());
  }
}

TEST(LinuxCncPort, ShowsWhatTheHalHasOfSensorsAndProbe) {
  FakeHal hal;
  const auto port =
      LinuxCncPort::make({.units = {.servo_period_s = 0.001, .linear_unit_mm = 25.4}}, hal);
  ASSERT_TRUE(port.has_value());
  const std::array<double, 3> heard{0.1, -0.2, 0.3};
  hal.inputs.temperature_c[1] = 31.5;
  hal.inputs.probe = {.number = 3, .axis = 2, .displacement_mm = 0.001};
  hal.inputs.vibration = heard;
  hal.inputs.vibration_rate_hz = 10000.0;
  Sample sample = cutting(1);
  sample[Column::modulation] = 1.0;
  hal.push(sample);
  const auto frame = (*port)->read();
  ASSERT_TRUE(frame.has_value());
  EXPECT_TRUE(frame->speed_modulation);
  EXPECT_TRUE(std::isnan(frame->temperature_c[0]));
  EXPECT_EQ(frame->temperature_c[1], 31.5);
  EXPECT_EQ(frame->probe.number, 3U);
  EXPECT_DOUBLE_EQ(frame->probe.displacement_mm, 0.0254);
  EXPECT_EQ(frame->vibration.size(), 3U);
  EXPECT_EQ(frame->vibration_rate_hz, 10000.0);
}

// A pause of 150 cycles: those that waited are passed over, but their offsets count.
TEST(LinuxCncPort, KnowsTheOffsetInThePositionAfterAPause) {
  for (const bool sampler_full : {false, true}) {
    FakeHal hal;
    hal.with_offsets = true;
    const auto port = port_on(hal);
    const auto push = [&](std::uint64_t tick) {
      Sample sample = cutting(tick);
      sample.axis[2].offset = 0.001 * static_cast<double>(tick);
      hal.push(sample);
    };
    for (std::uint64_t tick = 1; tick <= 5; ++tick) {
      push(tick);
      ASSERT_TRUE(port->read().has_value());
    }
    const std::uint64_t from = sampler_full ? 156 : 6;
    for (std::uint64_t tick = from; tick <= 180; ++tick) {
      push(tick);
    }
    for (auto frame = port->read(); frame && frame->cycle < 180; frame = port->read()) {
      const double shown = 0.001 * static_cast<double>(frame->cycle);
      EXPECT_NEAR(frame->axis[2].offset_mm, shown, 0.0021) << frame->cycle;
    }
  }
}

// The joint's command contains the offset that was shown two servo cycles before.
TEST(LinuxCncPort, ShowsTheOffsetThatThePositionsContain) {
  FakeHal hal;
  const auto port = LinuxCncPort::make({.units = {.servo_period_s = 0.001}}, hal);
  ASSERT_TRUE(port.has_value());
  for (std::uint64_t tick = 1; tick <= 5; ++tick) {
    Sample sample = cutting(tick);
    sample.axis[2].offset = 0.01 * static_cast<double>(tick);
    hal.push(sample);
    const auto frame = (*port)->read();
    ASSERT_TRUE(frame.has_value());
    EXPECT_DOUBLE_EQ(frame->axis[2].offset_mm,
                     tick < 3 ? 0.0 : 0.01 * static_cast<double>(tick - 2));
  }
}

}  // namespace
}  // namespace steadyrest::adapters::linuxcnc
