// SPDX-License-Identifier: Apache-2.0
// Predefined named parameters. The values are those that rs274 (LinuxCNC 2.9) moved X to, for the
// same programs.
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/nc/interpret/parameters/parameter_answers.hpp>
#include <steadyrest/nc/interpret/test/moves.hpp>

namespace steadyrest::nc::interpret {
namespace {

/// X#<name> after a block, in a program that is back in its first modes when it moves.
double answer_after(const std::string& block, const std::string& name) {
  const auto moves =
      moves_of(block + "\n#1=#<" + name + ">\nG21 G8 G90 G94 G54 G49 G17 G97\nG0 X#1\nM2\n");
  return moves.empty() ? -12345.0 : moves.back().end[0];
}

struct AnswerCase {
  std::string block;
  std::vector<std::pair<std::string, double>> answers;
};

TEST(ParameterAnswers, AreThoseOfRs274) {
  const AnswerCase cases[] = {
      {"",
       {{"_motion_mode", 800},
        {"_plane", 170},
        {"_coord_system", 540},
        {"_metric", 1},
        {"_imperial", 0},
        {"_absolute", 1},
        {"_units_per_minute", 1},
        {"_ccomp", 400},
        {"_lathe_radius_mode", 1},
        {"_spindle_rpm_mode", 1},
        {"_spindle_on", 0}}},
      {"G18 G20 G91",
       {{"_plane", 180}, {"_metric", 0}, {"_imperial", 1}, {"_incremental", 1}, {"_absolute", 0}}},
      {"G19 G59 G93",
       {{"_plane", 190}, {"_coord_system", 590}, {"_inverse_time", 1}, {"_units_per_minute", 0}}},
      {"G59.1 G95", {{"_coord_system", 591}, {"_units_per_rev", 1}}},
      {"G59.3 G7",
       {{"_coord_system", 593}, {"_lathe_diameter_mode", 1}, {"_lathe_radius_mode", 0}}},
      {"G90.1 G98", {{"_ijk_absolute_mode", 1}, {"_retract_old_z", 1}, {"_retract_r_plane", 0}}},
      {"S500 M3 M8 F120",
       {{"_rpm", 500},
        {"_spindle_on", 1},
        {"_spindle_cw", 1},
        {"_flood", 1},
        {"_mist", 0},
        {"_feed", 120}}},
      {"S400 M4 M7 G20 F3", {{"_rpm", 400}, {"_spindle_cw", 0}, {"_mist", 1}, {"_flood", 0}}},
      {"G43.1 Z1 G96 S100", {{"_tool_offset", 1}, {"_spindle_css_mode", 1}}},
      {"G1 F100 Y1", {{"_motion_mode", 10}, {"_y", 1}, {"_abs_y", 1}, {"_x", 0}}},
      {"G3 F100 X1 Y1 I1", {{"_motion_mode", 30}, {"_x", 1}}},
      {"G10 L2 P1 Y3", {{"_y", -3}, {"_abs_y", 0}}}};
  for (const auto& [block, answers] : cases) {
    for (const auto& [name, expected] : answers) {
      EXPECT_NEAR(answer_after(block, name), expected, kHalfDigit) << block << ' ' << name;
    }
  }
}

TEST(ParameterAnswers, WithoutAModeAreTheSameInEveryState) {
  State other;
  other.unit_mm = 25.4;
  other.plane = Plane::yz;
  other.incremental = other.centre_absolute = other.retract_to_initial = other.diameter = true;
  other.motion = 20;
  other.feed_mode = FeedMode::per_revolution;
  other.feed_mm_s = 0.5;
  other.active_offset = 8;
  other.override_off = other.surface_speed = true;
  other.spindle_speed_rev_s = 3.0;
  other.spindle_direction = 1;
  other.coolant = 3.0;
  other.tool_offset[2] = 4.0;
  other.selected_tool = other.tool_in_spindle = 5;
  other.cutter_side = -1;
  for (const char* name :
       {"_vmajor",           "_vminor",        "_speed_override", "_adaptive_feed", "_feed_hold",
        "_remap_level",      "_plane",         "_ccomp",          "_metric",        "_absolute",
        "_coord_system",     "_mist",          "_flood",          "_feed",          "_rpm",
        "_current_tool",     "_selected_tool", "_feed_override",  "_retract_old_z", "_spindle_on",
        "_spindle_css_mode", "_tool_offset",   "_motion_mode"}) {
    const Answer* const answer = answer_of(name);
    ASSERT_NE(answer, nullptr) << name;
    EXPECT_EQ(answer->mode != 0, answer->value(State{}) != answer->value(other)) << name;
  }
  EXPECT_EQ(answer_of("_line_number"), nullptr);
  EXPECT_EQ(answer_of(""), nullptr);
}

}  // namespace
}  // namespace steadyrest::nc::interpret
