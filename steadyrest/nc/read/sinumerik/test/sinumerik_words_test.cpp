// SPDX-License-Identifier: Apache-2.0
#include <string>

#include <gtest/gtest.h>

#include <steadyrest/nc/read/sinumerik/sinumerik_words.hpp>

namespace steadyrest::nc::read {
namespace {

TEST(SinumerikNamedWords, HaveTheirRoleInAnyCase) {
  const std::pair<const char*, WordRole> cases[] = {
      {"cr", WordRole::decoded},          {"CompCad", WordRole::decoded},
      {"SOFT", WordRole::without_effect}, {"StopRe", WordRole::without_effect},
      {"brisk", WordRole::dynamics},      {"DYNFINISH", WordRole::dynamics}};
  for (const auto& [name, role] : cases) {
    const NamedWord* const word = named_word(name);
    ASSERT_NE(word, nullptr) << name;
    EXPECT_EQ(word->role, role) << name;
  }
  EXPECT_EQ(named_word("BRISKB"), nullptr);
  EXPECT_EQ(named_word(""), nullptr);
}

TEST(SinumerikNamedWords, TellCyclesFromSubprograms) {
  for (const char* name : {"CYCLE81", "cycle800", "CYCLE95", "HOLES1", "Pocket3", "LONGHOLE"}) {
    EXPECT_TRUE(names_cycle(name)) << name;
  }
  for (const char* name : {"CYCLE", "POCKET", "HOLES3", "POCKET_7", "L100", ""}) {
    EXPECT_FALSE(names_cycle(name)) << name;
  }
}

// "Cycles", CYCLE832: the last digit is the machining, the one before it the orientation tolerance.
TEST(SinumerikNamedWords, DefineTheModesOfCycle832) {
  double value = -1.0;
  EXPECT_TRUE(predefined("_off", value));
  EXPECT_EQ(value, 0.0);
  EXPECT_TRUE(predefined("_rough", value));
  EXPECT_EQ(value, 3.0);
  EXPECT_TRUE(predefined("_ori_finish", value));
  EXPECT_EQ(value, 11.0);
  EXPECT_FALSE(predefined("_x_home", value));
}

}  // namespace
}  // namespace steadyrest::nc::read
