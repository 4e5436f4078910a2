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
  ASSERT_EQ(texts.size(), 3U);
  for (const auto& text : texts) {
    EXPECT_EQ(text.text.find('{'), std::string::npos) << text.name;
    EXPECT_EQ(text.text.find('@'), std::string::npos) << text.name;
  }
  EXPECT_GT(SyncActions(texts.front().text).count(), 40U);
}

TEST(ControlText, PlcBlockHasThisMachinesCodes) {
  const auto of = machine();
  const std::string text = adapters::opcua::control_texts(of).value()[2].text;
  // MD12030: 100 % is position 19, Gray 11010.
  EXPECT_NE(text.find("  26: panel := 19;   // 100 %"), std::string::npos) << text;
  EXPECT_NE(text.find("    19: DB21.DB4 := B#16#1A;   // 100 %"), std::string::npos);
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
