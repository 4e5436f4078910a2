// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <gmock/gmock.h>

#include <steadyrest/kernel/file/testing/own_folder.hpp>
#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/nc/interpret/parameters/linuxcnc_files.hpp>
#include <steadyrest/nc/interpret/test/moves.hpp>

// Expected values are rs274's output (LinuxCNC 2.9) for the same tool table and program.
namespace steadyrest::nc::interpret {
namespace {

using testing::HasSubstr;

kernel::outcome::Result<std::vector<Tool>> table_of(const std::string& text, double unit_mm = 1.0) {
  const kernel::file::testing::OwnFolder folder;
  return read_tool_table(folder.file("tool.tbl", text), unit_mm);
}

// #5411, #5412 and #5413 from rs274 with these lines.
TEST(ToolTable, HasTheAnglesAndTheEdgeOfALatheTool) {
  const auto tools = table_of(
      "T1 P1 Z1 D0.04 I95 J155 Q2 ;turning\nT6 P6 D0.04 I-10.5 J+3.25 Q02\nT7 P7 D1\n", 25.4);
  ASSERT_TRUE(tools.has_value());
  ASSERT_EQ(tools->size(), 3U);
  EXPECT_EQ((*tools)[0], (Tool{.number = 1,
                               .offset = {0.0, 0.0, 25.4},
                               .diameter_mm = 0.04 * 25.4,
                               .front_angle_deg = 95.0,
                               .back_angle_deg = 155.0,
                               .orientation = 2}));
  EXPECT_EQ((*tools)[1].front_angle_deg, -10.5);
  EXPECT_EQ((*tools)[1].back_angle_deg, 3.25);
  EXPECT_EQ((*tools)[1].orientation, 2);
  EXPECT_EQ((*tools)[2].orientation, 0);
}

// LinuxCNC has nine orientations and reads only the leading digits of anything else.
TEST(ToolTable, RefusesAnOrientationThatIsNone) {
  for (const char* word : {"Q2.5", "Q10", "Q-1"}) {
    const auto tools = table_of(fmt::format("T1 P1 D1\nT2 P2 {} D1\n", word));
    ASSERT_FALSE(tools.has_value()) << word;
    EXPECT_THAT(kernel::outcome::text(tools.error()),
                HasSubstr(fmt::format(":2: `{} D1` is no orientation of a tool", word)));
  }
}

// Everything a line of the table can say about a tool comes back, in any word order.
TEST(ToolTable, LosesNothing) {
  for (std::int32_t edge = 0; edge <= 9; ++edge) {
    Tool tool{.number = edge + 3,
              .offset = {},
              .diameter_mm = 0.5 + edge,
              .front_angle_deg = 10.25 * edge - 20.0,
              .back_angle_deg = 77.5 - edge,
              .orientation = edge};
    std::string text = fmt::format("Q{} J{} I{} D{} T{}", edge, tool.back_angle_deg,
                                   tool.front_angle_deg, tool.diameter_mm, tool.number);
    for (std::size_t i = 0; i < kAxisLetters.size(); ++i) {
      tool.offset[i] = 1.5 * static_cast<double>(i) - 0.25 * edge;
      text += fmt::format(" {}{}", kAxisLetters[i], tool.offset[i]);
    }
    const auto tools = table_of(text + "\n");
    ASSERT_TRUE(tools.has_value()) << text;
    EXPECT_EQ(*tools, std::vector{tool}) << text;
  }
}

// The tool point is one radius off the centre of its nose.
TEST(ToolTable, TheEdgeMovesACompensatedTool) {
  Config config;
  config.tools = table_of("T1 P1 D1.016 I95 J155 Q2\n").value();
  const auto moves = moves_of(
      "G21 G18 G90 G64\nT1 M6\nF100\nG0 X20 Z5\nG42 G1 X10 Z0\nX10 Z-10\nX14 Z-14\nX20 Z-14\nG40\n"
      "G0 X30 Z5\nM2\n",
      config);
  const std::vector<std::pair<double, double>> ends = {
      {20, 5}, {10, -0.8220}, {10, -10.2976}, {13.7024, -14}, {19.4920, -14.0}, {30, 5}};
  ASSERT_EQ(moves.size(), ends.size());
  for (std::size_t i = 0; i < ends.size(); ++i) {
    EXPECT_NEAR(moves[i].end[0], ends[i].first, kHalfDigit) << i;
    EXPECT_NEAR(moves[i].end[2], ends[i].second, kHalfDigit) << i;
  }
  EXPECT_EQ(reason_of("G17 T1 M6\nG41 G1 X1 F10\nM2\n", config), "cutter_comp_plane");
}

}  // namespace
}  // namespace steadyrest::nc::interpret
