// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <vector>

#include <steadyrest/nc/interpret/test/moves.hpp>

// What LinuxCNC's INI file makes of a program. All expected values are those of `rs274 -i INI`.
namespace steadyrest::nc::interpret {
namespace {

Config with(auto set) {
  Config config;
  config.axes = "XYZA";
  set(config.settings);
  return config;
}

/// The refusal of a program, or of its start.
std::string refusal(const std::string& text, const Config& config) {
  Kept kept;
  const auto report = run_text(text, config, kept);
  if (!report) {
    return kernel::outcome::text(report.error());
  }
  return report->refused.empty() ? std::string{} : report->refused.front().text;
}

TEST(Settings, AStartupBlockSetsTheModesOfTheFirstLine) {
  const auto moves =
      moves_of("G0 X1 Z2\nG2 X2 I1 F10\nM2\n",
               with([](auto& settings) { settings.startup = "G20 G18 G64 P0.001 G91 G94"; }));
  ASSERT_EQ(moves.size(), 2U);
  EXPECT_DOUBLE_EQ(moves[0].end[0], 25.4);
  EXPECT_DOUBLE_EQ(moves[0].path_tolerance_mm, 0.0254);
  EXPECT_DOUBLE_EQ(moves[1].end[0], 76.2);
  EXPECT_DOUBLE_EQ(moves[1].normal[1], 1.0);
  EXPECT_DOUBLE_EQ(moves[1].feed_mm_s, 10.0 * 25.4 / 60.0);
  // G7 halves a lathe's X.
  EXPECT_DOUBLE_EQ(
      moves_of("G0 X10\nM2\n", with([](auto& settings) { settings.startup = "G7 G18"; }))[0].end[0],
      5.0);
}

TEST(Settings, AStartupBlockThatMovesOrIsNoBlockIsRefused) {
  for (const char* startup : {"G0 X5", "M2", "o100 call", "G999", "G20 G21", "G1 F100 X1"}) {
    const auto text = refusal("G0 X1\nM2\n", with([&](auto& set) { set.startup = startup; }));
    EXPECT_NE(text.find(startup), std::string::npos) << startup << ": " << text;
  }
}

TEST(Settings, ARemappedCodeIsRefusedByItsName) {
  const Config config = with([](auto& settings) { settings.remapped = "M6 G88.8 T M400"; });
  for (const char* program :
       {"G21 M6\nM2\n", "G0 X1\nM06\nM2\n", "G88.8 X1\nM2\n", "T1\nM2\n", "M400\nM2\n"}) {
    EXPECT_NE(refusal(program, config).find("is remapped on this machine"), std::string::npos)
        << program;
  }
  // Neighbours keep their meaning.
  EXPECT_EQ(refusal("G0 X1\nM61 Q0\nG88 X1 Z-1 R1 P0 F100 S100 M3\nM2\n",
                    with([](auto& settings) { settings.remapped = "M6 G88.8"; })),
            "");
}

TEST(Settings, AToolChangeLiftsTheQuillAndGoesToG30) {
  Config config = with([](auto& settings) {
    settings.tool_change_quill_up = true;
    settings.tool_change_at_g30 = true;
  });
  config.home[1] = {11.0, 22.0, 33.0, 370.0};
  config.work_offset[0] = {100.0, 200.0, 50.0, 15.0};
  config.rotation_deg[0] = 30.0;
  config.g92 = {1.0, 2.0, 3.0};
  config.g92_on = true;
  config.tools = std::vector<Tool>{{.number = 1, .offset = {0.0, 0.0, 10.0, 5.0}},
                                   {.number = 2, .offset = {0.0, 0.0, 25.0}}};
  const auto moves = moves_of("G0 X1 Y2 Z3 A4\nT1 M6 G43\nG0 X0\nT2 M6\nM2\n", config);
  ASSERT_EQ(moves.size(), 6U);
  EXPECT_NEAR(moves[1].end[2], -53.0, 1e-9);
  EXPECT_EQ(moves[1].end[0], 1.0);
  EXPECT_EQ(moves[1].kind, MoveKind::rapid);
  EXPECT_NEAR(moves[2].end[0], -167.07626, 1e-4);
  EXPECT_NEAR(moves[2].end[1], -111.65252, 1e-4);
  EXPECT_NEAR(moves[2].end[2], -20.0, 1e-9);
  EXPECT_NEAR(moves[2].end[3], 355.0, 1e-9);
  // With a tool's length in force Z is higher by it; A is not.
  EXPECT_NEAR(moves[4].end[2], -63.0, 1e-9);
  EXPECT_NEAR(moves[5].end[2], -30.0, 1e-9);
  EXPECT_NEAR(moves[5].end[3], 355.0, 1e-9);
}

// LinuxCNC's task moves there, not rs274; machine coordinates.
TEST(Settings, AToolChangeGoesToItsPosition) {
  Config config = with([](auto& settings) {
    settings.tool_change_position_mm = {1.0, 2.0, 3.0};
    settings.tool_change_rotary_rad = {0.5, 0.0, 0.0};
  });
  config.work_offset[0][0] = 100.0;
  const auto moves = moves_of("G0 X5\nM6\nG0 Y0\nM2\n", config);
  ASSERT_EQ(moves.size(), 3U);
  EXPECT_DOUBLE_EQ(moves[1].end[0], -99.0);
  EXPECT_DOUBLE_EQ(moves[1].end[2], 3.0);
  EXPECT_NEAR(moves[1].end[3], 28.64788975654116, 1e-12);
  EXPECT_DOUBLE_EQ(moves[2].end[0], -99.0);
}

TEST(Settings, AToolChangeMayLeaveTheSpindleOn) {
  const char* const program = "S60 M3 F100\nM6\nG1 X1\nM2\n";
  EXPECT_EQ(moves_of(program, with([](auto& set) { set.tool_change_with_spindle_on = true; }))[0]
                .spindle_rev_s,
            1.0);
  EXPECT_EQ(moves_of(program)[0].spindle_rev_s, 0.0);
}

TEST(Settings, AToolLengthInForceIsTheNewToolsAfterM6) {
  Config config = with([](auto& settings) { settings.tool_change_keeps_offset = true; });
  config.tools = std::vector<Tool>{{.number = 1, .offset = {0.0, 0.0, 10.0}},
                                   {.number = 2, .offset = {0.0, 0.0, 25.0}}};
  const auto moves = moves_of("T1 M6\nG43\nG0 Z0\nT2 M6\nG0 Z0\nG49\nT1 M6\nG0 Z0\nM2\n", config);
  ASSERT_EQ(moves.size(), 3U);
  EXPECT_DOUBLE_EQ(moves[0].offset[2], 10.0);
  EXPECT_DOUBLE_EQ(moves[1].offset[2], 25.0);
  EXPECT_DOUBLE_EQ(moves[2].offset[2], 0.0);
}

TEST(Settings, AWrappedAxisGoesTheWayItsSignSays) {
  Config config = with([](auto& settings) { settings.wrapped_axes = "A"; });
  config.work_offset[0][3] = 15.0;
  const auto moves = moves_of(
      "G0 A350\nG0 A10\nG0 A-10\nG0 A-20\nG0 A100\nG91 G0 A-720\nG90 A5\nA-5\nA-350\n"
      "G53 G0 A20\nG53 G0 A-20\nG0 A0\nG0 A-0\nM2\n",
      config);
  const std::vector<double> ends = {-10,  10,   10,   -340,  -260, -980, -715,
                                    -715, -730, -715, -1045, -720, -720};
  ASSERT_EQ(moves.size(), ends.size());
  for (std::size_t i = 0; i < ends.size(); ++i) {
    EXPECT_DOUBLE_EQ(moves[i].end[3], ends[i]) << i;
  }
  const auto feeds = moves_of("G0 X0 A350\nG1 F500 X10 A10\nX20 A-10\nG2 X30 I5 A-20\nM2\n",
                              with([](auto& settings) { settings.wrapped_axes = "A"; }));
  ASSERT_EQ(feeds.size(), 4U);
  EXPECT_DOUBLE_EQ(feeds[0].end[3], 350.0);
  EXPECT_DOUBLE_EQ(feeds[1].end[3], 370.0);
  EXPECT_DOUBLE_EQ(feeds[2].end[3], 370.0);
  EXPECT_DOUBLE_EQ(feeds[3].end[3], 20.0);
}

// rs274: stored within a turn, reached from below.
TEST(Settings, AReferencePointOfAWrappedAxisIsWithinATurn) {
  const Config config = with([](auto& settings) {
    settings.wrapped_axes = "A";
    settings.tool_change_at_g30 = true;
  });
  const auto last = [&](const char* program) { return moves_of(program, config).back().end[3]; };
  EXPECT_DOUBLE_EQ(last("G0 A-189\nG30.1\nG0 A-200\nG30 A-210\nM2\n"), -531.0);
  EXPECT_DOUBLE_EQ(last("G91 G0 A-100\nG28.1\nG0 A-600\nG28\nM2\n"), -460.0);
  EXPECT_DOUBLE_EQ(last("G91 G0 A-600\nG30.1\nG30\nM2\n"), -600.0);
  EXPECT_DOUBLE_EQ(last("G0 A189\nG30.1\nG0 A100\nM6\nM2\n"), 549.0);
}

TEST(Settings, AWrappedAxisTakesAnglesWithinATurn) {
  const Config config = with([](auto& settings) { settings.wrapped_axes = "A"; });
  for (const char* program : {"G0 A360\nM2\n", "G1 F100 A-361\nM2\n", "G53 G0 A400\nM2\n",
                              "G28 A400\nM2\n", "G91 G0 A1\nG90 A720\nM2\n"}) {
    EXPECT_NE(refusal(program, config).find("counts in turns"), std::string::npos) << program;
  }
  EXPECT_EQ(refusal("G91 G0 A720\nG92 A400\nM2\n", config), "");
}

TEST(Settings, AnIndexerMovesAloneByG0) {
  const Config config = with([](auto& settings) { settings.indexer_axes = "A"; });
  EXPECT_EQ(refusal("G0 A90\nG0 X1\nM2\n", config), "");
  for (const char* program : {"G1 F100 A90\nM2\n", "G0 X1 A90\nM2\n"}) {
    EXPECT_NE(refusal(program, config).find("indexing axis"), std::string::npos) << program;
  }
}

// rs274 with CENTER_ARC_RADIUS_TOLERANCE_MM = 0.005 and _INCH = 0.0005.
TEST(Settings, AnArcsRadiiMayDifferByTheToleranceGiven) {
  const Config own = with([](auto&) {});
  const Config config = with([](auto& settings) {
    settings.arc_tolerance_mm = 0.005;
    settings.inch_arc_tolerance_mm = 0.0127;
  });
  EXPECT_EQ(refusal("G21 F100 G0 X0 Y0\nG2 X1 I0.51\nM2\n", own), "");
  EXPECT_NE(refusal("G21 F100 G0 X0 Y0\nG2 X1 I0.51\nM2\n", config), "");
  EXPECT_EQ(refusal("G21 F100 G0 X0 Y0\nG2 X1 I0.502\nM2\n", config), "");
  EXPECT_EQ(refusal("G20 F100 G0 X0 Y0\nG2 X1 I0.501\nM2\n", own), "");
  EXPECT_NE(refusal("G20 F100 G0 X0 Y0\nG2 X1 I0.501\nM2\n", config), "");
  EXPECT_EQ(refusal("G20 F100 G0 X0 Y0\nG2 X1 I0.5002\nM2\n", config), "");
}

TEST(Settings, FanucSubprogramsMayBeOff) {
  const Config config = with([](auto& settings) { settings.fanuc_subprograms = false; });
  EXPECT_NE(refusal("M98 P1\nM2\n", config).find("switched off"), std::string::npos);
  EXPECT_NE(refusal("M99\nM2\n", config).find("switched off"), std::string::npos);
}

}  // namespace
}  // namespace steadyrest::nc::interpret
