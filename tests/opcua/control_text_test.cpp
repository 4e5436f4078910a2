// SPDX-License-Identifier: Apache-2.0
#include <string>

#include <gtest/gtest.h>
#include <tests/opcua/control_side.hpp>
#include <tests/opcua/scene.hpp>

#include <steadyrest/adapters/opcua/control_text.hpp>

namespace steadyrest::opcua {
namespace {

TEST(ControlText, EveryLineOfTheActionsIsUnderstoodAndNothingIsLeftOpen) {
  auto of = machine();
  of.feed_override.layer_may_exceed_panel = true;
  of.spindle_override.layer_may_exceed_panel = true;
  const auto texts = adapters::opcua::control_texts(of).value();
  ASSERT_EQ(texts.size(), 2U) << "without a PLC route there is no PLC block";
  for (const auto& text : texts) {
    EXPECT_EQ(text.text.find('{'), std::string::npos) << text.name;
    EXPECT_EQ(text.text.find('@'), std::string::npos) << text.name;
  }
  EXPECT_GT(SyncActions(texts.front().text).count(), 40U);
}

/// The example machine by examples/opcua/sinumerik-plc.toml.
kernel::machine::Machine by_plc() {
  auto of = machine();
  of.opcua.writes.push_back(
      {.quantity = kernel::machine::Quantity::feed_position, .node = "s=/Plc/DB180.DBB2"});
  of.opcua.plc_block = 180;
  of.opcua.spindle_axis = 6;
  return of;
}

TEST(ControlText, WithThePlcBlockNoActionWritesAnOverride) {
  const auto texts = adapters::opcua::control_texts(by_plc()).value();
  ASSERT_EQ(texts.size(), 3U);
  const std::string& actions = texts.front().text;
  EXPECT_NE(actions.find("\n; not on this machine: IDS=n DO $AC_OVR="), std::string::npos);
  EXPECT_EQ(actions.find(" DO $AC_OVR=", actions.find("IDS=101")),
            actions.find(" DO $AC_OVR=", actions.find("not on this machine: IDS=n DO $AC_OVR=")));
  EXPECT_NE(actions.find("]=$AA_TOTAL_OVR[S1]"), std::string::npos) << "the sample still shows it";
  const std::string& plc = texts[2].text;
  EXPECT_NE(plc.find("CALL FB 180, DB 181"), std::string::npos);
  EXPECT_NE(plc.find("    10: DB36.DB19 := "), std::string::npos);
}

TEST(ControlText, PlcBlockHasThisMachinesCodes) {
  const std::string text = adapters::opcua::control_texts(by_plc()).value()[2].text;
  // MD12030: 100 % is position 19, Gray 11010.
  EXPECT_NE(text.find("  26: panel := 19;   // 100 %"), std::string::npos) << text;
  EXPECT_NE(text.find("    19: DB21.DB4 := B#16#1A;   // 100 %"), std::string::npos);
}

TEST(ControlText, PlcBlockIsOfTheChannel) {
  auto of = by_plc();
  of.opcua.channel = 3;
  const std::string text = adapters::opcua::control_texts(of).value()[2].text;
  EXPECT_NE(text.find("CASE WORD_TO_INT(BYTE_TO_WORD(DB23.DB4)) OF"), std::string::npos);
  EXPECT_EQ(text.find("DB21"), std::string::npos);
}

// 10 % at 200 %/s, and 22 positions of them, with two cycles of OB1.
TEST(ControlText, ThePlcHandsBackOnePositionInTheTimeOfTheWidest) {
  const auto of = by_plc();
  const std::string text = adapters::opcua::control_texts(of).value()[2].text;
  EXPECT_NE(text.find("step := wait >= L#50;"), std::string::npos);
  EXPECT_NEAR(adapters::opcua::neutral_after_s(of, 0.0, 1.2), 1.0 + 24 * 0.05, 1e-9);
}

// The block climbs a repeated position like any other. From the lowest of three at 50 % these are
// two, then nine up to the upper of two at 100 %, with two cycles of OB1.
TEST(ControlText, RepeatedPositionsAreInTheStatedTime) {
  auto of = by_plc();
  auto& table = of.feed_override;
  table.ratio = {0.0, 0.5, 0.5, 0.5, 0.6, 0.7, 0.75, 0.8, 0.85, 0.9, 0.95, 1.0, 1.0, 1.2};
  table.code.clear();
  for (std::uint32_t i = 1; i <= table.ratio.size(); ++i) {
    table.code.push_back(i ^ (i >> 1U));
  }
  const std::string text = adapters::opcua::control_texts(of).value()[2].text;
  ASSERT_NE(text.find("step := wait >= L#250;"), std::string::npos);
  EXPECT_NEAR(adapters::opcua::neutral_after_s(of, 0.5, 1.0),
              of.opcua.dead_man_s + (2 + 9 + 2) * 0.25, 1e-9);
}

TEST(ControlText, TheStatedTimeIsThatOfTheSlowerOne) {
  auto of = machine();
  of.envelope.min_spindle_ratio = 0.5;
  of.spindle_override.ratio.back() = 2.0;
  const double cycles_s = 2.0 * of.control.interpolator_period_s;
  EXPECT_NEAR(adapters::opcua::longest_hand_back_s(of), 1.0 + 1.5 / 2.0 + cycles_s, 1e-9);
  of.spindle_override.ratio = {1.0};
  EXPECT_NEAR(adapters::opcua::longest_hand_back_s(of), 1.0 + 1.2 / 2.0 + cycles_s, 1e-9);
}

TEST(ControlText, WithoutASpindleTheFeedHasItsOwnRate) {
  auto of = machine();
  of.envelope.spindle_slew_1_s = 0.5;
  EXPECT_NEAR(adapters::opcua::neutral_after_s(of, 0.0), 1.0 + 1.0 / 0.5 + 0.004, 0.02);
  of.spindle_override.ratio = {1.0};
  EXPECT_NEAR(adapters::opcua::neutral_after_s(of, 0.0), 1.0 + 1.0 / 2.0 + 0.004, 0.02);
}

// The control writes 5EX-5; 5e-05 is an error there.
TEST(ControlText, SmallNumbersHaveNoExponent) {
  auto of = machine();
  of.file = "m.toml";
  of.control.interpolator_period_s = 0.001;
  of.envelope.max_offset_mm = 0.1;
  of.envelope.offset_slew_mm_s = 0.05;
  const std::string text = adapters::opcua::control_texts(of).value().front().text;
  EXPECT_NE(text.find(")>0.00005 DO"), std::string::npos);
  EXPECT_EQ(text.find("e-0"), std::string::npos);
}

TEST(ControlText, TheMachinesNameStaysInItsComment) {
  auto of = by_plc();
  of.name = "mill\nG0 X100";
  of.file = "mill\r\nM30";
  const auto texts = adapters::opcua::control_texts(of).value();
  for (const auto& text : texts) {
    EXPECT_EQ(text.text.find("\nG0 X100"), std::string::npos) << text.name;
    EXPECT_EQ(text.text.find("\nM30"), std::string::npos) << text.name;
  }
}

TEST(ControlText, WhatAnRParameterCannotHoldIsRefused) {
  auto of = machine();
  of.envelope.offset_slew_mm_s = 1e-7;
  const auto texts = adapters::opcua::control_texts(of);
  ASSERT_FALSE(texts.has_value());
  EXPECT_NE(texts.error().what.find("offset_slew_um_s = 0.0001"), std::string::npos);
  of.envelope.max_offset_mm = 0.0;
  EXPECT_TRUE(adapters::opcua::control_texts(of).has_value());
}

TEST(ControlText, TooManyActionsAreRefused) {
  auto of = machine();
  of.opcua.first_action = 230;
  const auto texts = adapters::opcua::control_texts(of);
  ASSERT_FALSE(texts.has_value());
  EXPECT_NE(texts.error().what.find("first_action = 230"), std::string::npos);
}

}  // namespace
}  // namespace steadyrest::opcua
