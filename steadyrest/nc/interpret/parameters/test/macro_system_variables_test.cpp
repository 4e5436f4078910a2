// SPDX-License-Identifier: Apache-2.0
// FANUC Series 30i operator's manual, "System variables": modal information and positions.
#include <utility>

#include <gmock/gmock.h>

#include <steadyrest/nc/interpret/parameters/test/macro_variables_of.hpp>

namespace steadyrest::nc::interpret {
namespace {

using test::MacroVariablesOf;
using testing::DoubleEq;
using testing::ElementsAre;

using MacroSystemVariables = MacroVariablesOf;

// "Modal information": the code of each group in force.
TEST_F(MacroSystemVariables, AreTheModesAsCodes) {
  state_.plane = Plane::zx;
  state_.incremental = true;
  state_.feed_mode = FeedMode::per_revolution;
  state_.unit_mm = state_.feed_unit_mm = 25.4;
  state_.retract_to_initial = true;
  state_.active_offset = 5;
  state_.motion = 810;
  state_.plain_motion = 10;
  state_.spindle_speed_rev_s = 20.0;
  state_.selected_tool = 12;
  const std::pair<int, double> codes[] = {{4002, 18}, {4003, 91},   {4005, 95},
                                          {4006, 20}, {4009, 81},   {4010, 98},
                                          {4014, 59}, {4119, 1200}, {4120, 12}};
  for (const auto& [index, code] : codes) {
    EXPECT_THAT(value_of(index), ElementsAre(code)) << index;
  }
  // Cycles are a group of their own: G1 is in force beside one.
  EXPECT_THAT(value_of(4001), ElementsAre(1.0));
  EXPECT_THAT(value_of(4109), ElementsAre()) << "no feed per minute in G95";
  state_ = {};
  EXPECT_THAT(value_of(4001), ElementsAre());
  state_.motion = state_.plain_motion = 30;
  state_.feed_mm_s = 2.0;
  EXPECT_THAT(value_of(4001), ElementsAre(3.0));
  EXPECT_THAT(value_of(4009), ElementsAre(80.0));
  EXPECT_THAT(value_of(4109), ElementsAre(120.0));
  EXPECT_NE(variables_.asked().modes & kFeedMode, 0U);
}

// In inch programs the unit of machine positions is a setting of the control.
TEST_F(MacroSystemVariables, ArePositionsInTheProgramsUnit) {
  state_.position = {25.4, 50.8, -12.7};
  state_.offset = {10.0, 20.0, 30.0};
  state_.tool_offset = {0.0, 0.0, 100.0};
  EXPECT_THAT(value_of(5023), ElementsAre(DoubleEq(17.3)));
  EXPECT_EQ(variables_.asked().value, "#5023");
  EXPECT_THAT(value_of(5043), ElementsAre(DoubleEq(87.3)));
  EXPECT_THAT(value_of(5004), ElementsAre());
  state_.unit_mm = 25.4;
  EXPECT_THAT(value_of(5002), ElementsAre(2.0));
  EXPECT_THAT(value_of(5021), ElementsAre());
}

}  // namespace
}  // namespace steadyrest::nc::interpret
