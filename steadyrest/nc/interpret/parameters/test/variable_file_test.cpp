// SPDX-License-Identifier: Apache-2.0
// LinuxCNC 2.9, "Numbered Parameters": 5161–5169 G28, 5181–5189 G30, 5210 and 5211–5219 G92, 5220
// the active system, 5221–5230 G54 with its rotation, 5241–5250 G55 … 5381–5390 G59.3.
#include <string>

#include <fmt/core.h>
#include <gmock/gmock.h>

#include <steadyrest/kernel/file/testing/own_folder.hpp>
#include <steadyrest/nc/interpret/parameters/linuxcnc_files.hpp>

namespace steadyrest::nc::interpret {
namespace {

/// The refusal of a variable file; empty when it has been read.
std::string fault_of_variables(const std::string& text, Config& config, double unit_mm = 1.0) {
  const kernel::file::testing::OwnFolder folder;
  const auto read = read_variables(folder.file("linuxcnc.var", text), unit_mm, config);
  return read ? "" : kernel::outcome::text(read.error());
}

// A whole file, each number its own value; linear axes in inches, rotary ones in degrees.
TEST(VariableFile, HasEveryOffsetAtItsNumber) {
  std::string text;
  for (int number = 5161; number <= 5390; ++number) {
    if (number != 5210 && number != 5220) {
      text += fmt::format("{}\t{}.5\n", number, number);
    }
  }
  Config config;
  EXPECT_EQ(fault_of_variables(text, config, 25.4), "");
  for (int axis = 0; axis < 9; ++axis) {
    const auto at = static_cast<std::size_t>(axis);
    const auto expected = [&](int first) {
      return (first + axis + 0.5) * (axis >= 3 && axis <= 5 ? 1.0 : 25.4);
    };
    EXPECT_DOUBLE_EQ(config.home[0][at], expected(5161)) << axis;
    EXPECT_DOUBLE_EQ(config.home[1][at], expected(5181)) << axis;
    EXPECT_DOUBLE_EQ(config.g92[at], expected(5211)) << axis;
    EXPECT_DOUBLE_EQ(config.work_offset[0][at], expected(5221)) << axis;
    EXPECT_DOUBLE_EQ(config.work_offset[8][at], expected(5381)) << axis;
  }
  EXPECT_DOUBLE_EQ(config.rotation_deg[0], 5230.5);
  EXPECT_DOUBLE_EQ(config.rotation_deg[8], 5390.5);
  EXPECT_TRUE(config.start_known);
  EXPECT_FALSE(config.g92_on);
}

TEST(VariableFile, SaysWhichSystemIsActiveAndWhetherG92Is) {
  for (int system = 1; system <= 9; ++system) {
    Config config;
    EXPECT_EQ(fault_of_variables(fmt::format("5210 1\n5220 {}.000000\n", system), config), "");
    EXPECT_EQ(config.active_offset, static_cast<std::size_t>(system) - 1);
    EXPECT_TRUE(config.g92_on);
  }
  for (const char* system : {"0", "10", "-1"}) {
    Config config;
    EXPECT_THAT(fault_of_variables(fmt::format("5210 0\n5220 {}\n", system), config),
                testing::HasSubstr("linuxcnc.var:2: an active coordinate system"));
    EXPECT_FALSE(config.start_known) << system;
  }
}

TEST(VariableFile, KeepsOtherNumbersAndPassesOverThoseThatNoParameterHas) {
  Config config;
  EXPECT_EQ(fault_of_variables("  31 -0.25\n\n5401\t2.0\r\n0 7\n200000 8\n", config), "");
  EXPECT_THAT(config.numbers,
              testing::ElementsAre(testing::Pair(31, -0.25), testing::Pair(5401, 2.0)));
}

TEST(VariableFile, IsRefusedAtTheLineThatIsNoNumberAndValue) {
  for (const char* line : {"5221", "abc", "5221 x", "5221.5 1", "; comment", "#5221 1"}) {
    Config config;
    EXPECT_THAT(fault_of_variables(fmt::format("5161 1\n5162 2\n{}\n", line), config),
                testing::HasSubstr("linuxcnc.var:3: a line that is not `number value`"))
        << line;
    EXPECT_FALSE(config.start_known) << line;
  }
  Config config;
  EXPECT_NE(fault_of_variables(std::string(70000, '1'), config), "");
  EXPECT_FALSE(read_variables("/nonexistent/linuxcnc.var", 1.0, config).has_value());
}

}  // namespace
}  // namespace steadyrest::nc::interpret
