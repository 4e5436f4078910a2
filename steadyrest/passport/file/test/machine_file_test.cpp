// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>
#include <numbers>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/passport/file/consistency.hpp>
#include <steadyrest/passport/file/machine_file.hpp>

// A small file whose expected values are round in the inner units: 6000 mm/min is 100 mm/s, 3
// (m/min)/mm is 50 1/s, 180 °/s is π rad/s. Z comes before X and there is no Y, so sorting and
// stand-ins show.
namespace steadyrest::passport {
namespace {

using kernel::machine::Axis;
using kernel::machine::Machine;
using kernel::machine::OverrideTable;

constexpr std::string_view kSmall = R"(
[control]
dialect = "fanuc"
interpolator_period_ms = 4
servo_period_ms = 2

[[axis]]
name = "Z"
servo_gain_m_min_mm = 3
max_feed_mm_min = 9000
max_acceleration_mm_s2 = 900

[[axis]]
name = "X"
servo_gain_1_s = 50
max_feed_mm_min = 6000
max_acceleration_mm_s2 = 900
backlash_um = 12
[axis.encoder]
count_um = 0.5

[[axis]]
name = "C"
servo_gain_1_s = 20
max_speed_deg_s = 180
max_acceleration_deg_s2 = 360

[override.feed]
percent = [0, 10, 50, 100, 120]

[contour]
limit_um = 10
)";

TEST(MachineFile, ConvertsEveryValueOnceToTheInnerUnits) {
  const auto machine = parse(kSmall, "small.toml");
  ASSERT_TRUE(machine) << kernel::outcome::text(machine.error());
  const Axis& x = machine->axes[0];
  EXPECT_DOUBLE_EQ(x.max_speed_au_s, 100.0);
  EXPECT_DOUBLE_EQ(x.backlash_au, 0.012);
  EXPECT_DOUBLE_EQ(x.encoder.count_au, 0.0005);
  EXPECT_DOUBLE_EQ(machine->axes[2].servo_gain_1_s, 50.0);
  EXPECT_DOUBLE_EQ(machine->axes[3].max_speed_au_s, std::numbers::pi);
  EXPECT_DOUBLE_EQ(machine->contour.limit_mm, 0.010);
  EXPECT_DOUBLE_EQ(machine->control.interpolator_period_s, 0.004);
  EXPECT_EQ(machine->file, "small.toml");
}

TEST(MachineFile, PutsAStandInWhereXYOrZIsMissing) {
  const auto machine = parse(kSmall, "small.toml");
  ASSERT_TRUE(machine) << kernel::outcome::text(machine.error());
  ASSERT_EQ(machine->axes.size(), 4U);
  EXPECT_EQ(machine->axes[0].name, "X");
  EXPECT_EQ(machine->axes[1].name, "Y");
  EXPECT_EQ(machine->axes[2].name, "Z");
  EXPECT_EQ(machine->axes[3].name, "C");
  EXPECT_FALSE(machine->axes[1].present);
  EXPECT_EQ(machine->axes[1].min_au, machine->axes[1].max_au);
  EXPECT_TRUE(machine->axes[3].rotary);
}

// Gray codes of 1, 2, 3, 4, 5. Rapid follows the feed switch but never above 100 %; a machine
// without a spindle switch has the one step 100 %.
TEST(MachineFile, GivesGrayCodesThatStartAtOne) {
  const auto machine = parse(kSmall, "small.toml");
  ASSERT_TRUE(machine) << kernel::outcome::text(machine.error());
  EXPECT_THAT(machine->feed_override.code, testing::ElementsAre(1, 3, 2, 6, 7));
  EXPECT_THAT(machine->feed_override.ratio,
              testing::ElementsAre(0.0, 0.1, 0.5, 1.0, testing::DoubleEq(1.2)));
  EXPECT_THAT(machine->rapid_override.ratio, testing::ElementsAre(0.0, 0.1, 0.5, 1.0, 1.0));
  EXPECT_THAT(machine->spindle_override.ratio, testing::ElementsAre(1.0));
}

Machine example(const std::string& name) {
  auto machine = read(STEADYREST_SOURCE_DIR "/examples/machines/" + name + ".toml");
  EXPECT_TRUE(machine) << kernel::outcome::text(machine.error());
  return machine.value_or(Machine{});
}

/// Users start from the examples; doctor must have no findings on them.
class ExampleMachine : public testing::TestWithParam<std::string> {};

TEST_P(ExampleMachine, LoadsAndIsConsistent) {
  const Machine machine = example(GetParam());
  EXPECT_GE(machine.axes.size(), 3U);
  EXPECT_TRUE(findings(machine).empty()) << findings(machine).front().what;
}

std::vector<std::string> example_names() {
  std::vector<std::string> names;
  for (const auto& entry :
       std::filesystem::directory_iterator(STEADYREST_SOURCE_DIR "/examples/machines")) {
    names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

INSTANTIATE_TEST_SUITE_P(Examples, ExampleMachine, testing::ValuesIn(example_names()),
                         [](const testing::TestParamInfo<std::string>& at) {
                           std::string name = at.param;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

// SINUMERIK 840D: position p of the panel's 23 has the Gray code p ^ (p >> 1) (Siemens HT2 table);
// 100 % is position 19, 120 % the last. The spindle switch has 15 values from 50 %.
TEST(ExampleMachines, VmcHasTheSwitchesOfThe840D) {
  const Machine vmc = example("vmc-840d");
  ASSERT_EQ(vmc.feed_override.ratio.size(), 23U);
  EXPECT_EQ(vmc.feed_override.code[0], 0b00001U);
  EXPECT_EQ(vmc.feed_override.code[18], 0b11010U);
  EXPECT_DOUBLE_EQ(vmc.feed_override.ratio[18], 1.0);
  EXPECT_EQ(vmc.feed_override.code[22], 0b11100U);
  EXPECT_DOUBLE_EQ(vmc.feed_override.ratio[22], 1.2);
  ASSERT_EQ(vmc.spindle_override.ratio.size(), 15U);
  EXPECT_EQ(vmc.spindle_override.code[14], 0b01000U);
  EXPECT_DOUBLE_EQ(vmc.axes[0].servo_gain_1_s, 50.0);
}

// Figures of the KhAI lathe (Kombarov 2011): F = 9000 mm/min is 150 counts per tick, the planned
// acceleration 0.9 counts/tick², the drive's 2.1 counts/tick².
TEST(ExampleMachines, LatheHasThePapersFiguresInCountsAndTicks) {
  const Machine lathe = example("lathe-16k20f3");
  const Axis& z = lathe.axes[2];
  const double count_mm = z.encoder.count_au;
  const double tick_s = lathe.control.servo_period_s;
  EXPECT_NEAR(z.max_speed_au_s * tick_s / count_mm, 150.0, 1e-9);
  EXPECT_NEAR(z.max_acceleration_au_s2 * tick_s * tick_s / count_mm, 0.9, 1e-12);
  EXPECT_NEAR(z.drive_acceleration_au_s2 * tick_s * tick_s / count_mm, 2.1, 1e-12);
  EXPECT_FALSE(lathe.axes[1].present);
}

// MD12030 of a real 840D sl (DMG archive): 100 % is index 24, code 10101; 11010, which is 100 % on
// the standard panel, means 70 % here. A constant table in the code would fail this test.
TEST(MachineFile, TakesAMachinesOwnTableOfThirtyOneSteps) {
  std::string text(kSmall);
  const std::string small_table = "percent = [0, 10, 50, 100, 120]";
  text.replace(
      text.find(small_table), small_table.size(),
      "percent = [0, 0.5, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 15, 20, 30, 40, 50, 60, 70, 75, 80, "
      "85, 90, 95, 100, 105, 110, 115, 120, 130, 150]");
  const auto machine = parse(text, "dmg.toml");
  ASSERT_TRUE(machine) << kernel::outcome::text(machine.error());
  const OverrideTable& feed = machine->feed_override;
  ASSERT_EQ(feed.code.size(), 31U);
  EXPECT_EQ(feed.code[24], 0b10101U);
  EXPECT_DOUBLE_EQ(feed.ratio[24], 1.0);
  EXPECT_EQ(feed.code[18], 0b11010U);
  EXPECT_NEAR(feed.ratio[18], 0.7, 1e-12);
}

// LinuxCNC in half per cents: 201 steps, word = number of the step.
TEST(MachineFile, TakesABinaryWordAsThePercentOrAsTheNumberOfTheStep) {
  const Machine cnc = example("linuxcnc-mill");
  ASSERT_EQ(cnc.feed_override.ratio.size(), 201U);
  EXPECT_DOUBLE_EQ(cnc.feed_override.ratio[1], 0.005);
  EXPECT_DOUBLE_EQ(cnc.feed_override.ratio[200], 1.0);
  EXPECT_EQ(cnc.feed_override.code[200], 200U);
  EXPECT_EQ(cnc.spindle_override.code.back(), 150U);
}

}  // namespace
}  // namespace steadyrest::passport
