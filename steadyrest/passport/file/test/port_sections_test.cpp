// SPDX-License-Identifier: Apache-2.0
#include <string>

#include <gtest/gtest.h>

#include <steadyrest/passport/file/machine_file.hpp>
#include <steadyrest/passport/keys/schema.hpp>

namespace steadyrest::passport {
namespace {

using kernel::machine::Lines;
using kernel::machine::LinesKind;
using kernel::machine::Machine;
using kernel::machine::Parity;
using kernel::machine::Wiring;

const std::string kMachine = R"(port = "lines"
[control]
dialect = "sinumerik"
interpolator_period_ms = 4
servo_period_ms = 2
[[axis]]
name = "X"
servo_gain_1_s = 50
max_feed_mm_min = 10000
max_acceleration_mm_s2 = 1000
[[axis]]
name = "Y"
servo_gain_1_s = 50
max_feed_mm_min = 10000
max_acceleration_mm_s2 = 1000
[override.feed]
percent = [0, 50, 100]
[override.spindle]
percent = [50, 100, 120]
)";

const std::string kLines = R"([lines]
kind = "modbus_rtu"
address = "10.0.0.5:1502"
device = "/dev/ttyUSB3"
unit = 2
baud = 57600
parity = "odd"
registers = true
first_input = 3
first_output = 4
output_copy = 5
input_device = 6
output_device = 7
wiring = "plc"
cycle_ms = 8
reply_ms = 9
heartbeat = 10
running = 11
cutting = 12
locked = 13
locked_inverted = true
locked_hold_ms = 1500
modulate = 14
programmed_rpm = 1200
dropped_after_ms = 12
watchdog_ms = 15
watchdog_registers = [4384, 16]
watchdog_reset = [4385, 48847, 4385, 45054]
[lines.feed]
panel = [0, 1]
out = [2, 3]
mask = 17
panel_inverted = true
[lines.spindle]
panel = [4, 5]
out = [6, 7]
mask = 18
out_inverted = true
[recorder]
device = "/dev/ttyACM1"
baud = 115200
start_mm = [1.5, -2]
spindle_counts_rev = 4096
)";

TEST(PortSections, EveryKeyReachesItsField) {
  const auto read = parse(kMachine + kLines, "lines.toml");
  ASSERT_TRUE(read) << kernel::outcome::text(read.error());
  Lines expected{.kind = LinesKind::modbus_rtu,
                 .address = "10.0.0.5:1502",
                 .device = "/dev/ttyUSB3",
                 .unit = 2,
                 .baud = 57600,
                 .parity = Parity::odd,
                 .registers = true,
                 .first_input = 3,
                 .first_output = 4,
                 .output_copy = 5,
                 .input_device = 6,
                 .output_device = 7,
                 .wiring = Wiring::plc,
                 .feed = {.panel = {0, 1}, .out = {2, 3}, .mask = 17, .panel_inverted = true},
                 .spindle = {.panel = {4, 5}, .out = {6, 7}, .mask = 18, .out_inverted = true},
                 .heartbeat = 10,
                 .running = 11,
                 .cutting = 12,
                 .locked = 13,
                 .locked_inverted = true,
                 .locked_hold_s = 1.5,
                 .modulate = 14,
                 .programmed_rev_s = 20,
                 .watchdog_registers = {4384, 16},
                 .watchdog_reset = {4385, 48847, 4385, 45054}};
  EXPECT_DOUBLE_EQ(read->lines.cycle_s, 0.008);
  EXPECT_DOUBLE_EQ(read->lines.reply_s, 0.009);
  EXPECT_DOUBLE_EQ(read->lines.watchdog_s, 0.015);
  expected.cycle_s = read->lines.cycle_s;
  expected.reply_s = read->lines.reply_s;
  expected.watchdog_s = read->lines.watchdog_s;
  EXPECT_DOUBLE_EQ(read->lines.dropped_after_s, 0.012);
  expected.dropped_after_s = read->lines.dropped_after_s;
  EXPECT_EQ(read->lines, expected);
  EXPECT_TRUE(read->recorder.fitted);
  EXPECT_EQ(read->recorder.kind, kernel::machine::RecorderKind::serial);
  EXPECT_EQ(read->recorder.device, "/dev/ttyACM1");
  EXPECT_EQ(read->recorder.baud, 115200U);
  EXPECT_EQ(read->recorder.start_mm, (std::vector<double>{1.5, -2.0, 0.0}));
  EXPECT_EQ(read->recorder.spindle_counts_rev, 4096.0);
  EXPECT_EQ(layer_cycle_s(*read), read->lines.cycle_s);
  // A key without a line above would not be tried.
  for (const auto& key : lines_keys()) {
    EXPECT_NE(kLines.find("\n" + std::string(key.name) + " ="), std::string::npos) << key.name;
  }
}

TEST(PortSections, EncodersOnLinuxHaveTwoNumbersEach) {
  const std::string serial = R"([recorder]
device = "/dev/ttyACM1"
baud = 115200)";
  for (const std::string kind : {"gpio\"\ndevice = \"/dev/gpiochip1", "counter"}) {
    std::string text = kMachine + kLines;
    text.replace(text.find(serial), serial.size(),
                 "[recorder]\nkind = \"" + kind + "\"\ninputs = [17, 27, 5, 6, 13, 19]");
    const auto read = parse(text, "lines.toml");
    ASSERT_TRUE(read) << kernel::outcome::text(read.error());
    EXPECT_EQ(read->recorder.inputs, (std::vector<std::uint32_t>{17, 27, 5, 6, 13, 19}));
    // Without its encoder, the spindle needs no lines.
    text.erase(text.find("spindle_counts_rev"));
    const auto beyond = parse(text, "lines.toml");
    ASSERT_FALSE(beyond);
    EXPECT_NE(kernel::outcome::text(beyond.error()).find("inputs has 6 entries; 2 encoders need 4"),
              std::string::npos);
  }
}

TEST(PortSections, TheSameFileDrivesTheSimulatedMachine) {
  std::string text = kMachine + kLines;
  text.replace(text.find("\"lines\""), 7, "\"sim\"");
  const auto read = parse(text, "sim.toml");
  ASSERT_TRUE(read) << kernel::outcome::text(read.error());
  EXPECT_EQ(layer_cycle_s(*read), 0.004);
}

TEST(PortSections, OutputsAreReadBackWhereTheyAreWritten) {
  std::string text = kMachine + kLines;
  text.erase(text.find("output_copy"), std::string("output_copy = 5\n").size());
  EXPECT_EQ(parse(text, "lines.toml").value().lines.output_copy, 4U);
}

// The feed would jump when the spindle's word comes in or goes.
TEST(PortSections, EachOverrideHasItsOwnMask) {
  std::string text = kMachine + kLines;
  text.replace(text.find("mask = 18"), 9, "mask = 17");
  const auto shared = parse(text, "lines.toml");
  ASSERT_FALSE(shared);
  EXPECT_NE(kernel::outcome::text(shared.error()).find("output 17 has two purposes"),
            std::string::npos);
}

}  // namespace
}  // namespace steadyrest::passport
