// SPDX-License-Identifier: Apache-2.0
// What a program has settled by itself, and what it takes from the control's past: a correction is
// written only into programs that mean the same however the control was left.
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/nc/rewrite/walk/said.hpp>

namespace steadyrest::nc::rewrite {
namespace {

using interpret::Asked;
using interpret::GGroup;
using interpret::mode;
using read::Dialect;
using ::testing::HasSubstr;

interpret::Config config_of(Dialect dialect, bool start_known = false) {
  interpret::Config config;
  config.dialect = dialect;
  config.start_known = start_known;
  return config;
}

/// Looks at words as the walk does.
class SaidBy {
 public:
  explicit SaidBy(const interpret::Config& config = config_of(Dialect::linuxcnc)) : said(config) {}
  SaidBy& word(char letter, double value) {
    said.look({.letter = letter, .value = value, .name = {}, .text = {}});
    return *this;
  }
  Said said;
};

constexpr std::uint32_t kNoAxes = 0;
constexpr std::uint32_t kOffset1 = 1;

TEST(Said, EachWordSettlesItsOwnMode) {
  const struct {
    char letter;
    double value;
    interpret::ModeMask settles;
  } cases[] = {{'G', 20, mode(GGroup::units)},         {'G', 91, mode(GGroup::distance)},
               {'G', 18, mode(GGroup::plane)},         {'G', 95, mode(GGroup::feed_mode)},
               {'G', 59.3, mode(GGroup::work_offset)}, {'G', 43, mode(GGroup::tool_length)},
               {'G', 64, mode(GGroup::path_mode)},     {'G', 1, mode(GGroup::motion)},
               {'M', 6, interpret::kToolMode},         {'M', 4, interpret::kSpindleMode},
               {'M', 8, interpret::kCoolantMode},      {'M', 48, interpret::kOverrideMode},
               {'F', 100, interpret::kFeedMode},       {'S', 0, interpret::kSpeedMode}};
  for (const auto& one : cases) {
    SaidBy program;
    EXPECT_FALSE(program.said.has(one.settles)) << one.letter << one.value;
    program.word(one.letter, one.value);
    EXPECT_TRUE(program.said.has(one.settles)) << one.letter << one.value;
    EXPECT_EQ(program.said.among(~interpret::ModeMask{0}), one.settles)
        << one.letter << one.value << " settles nothing else";
  }
}

TEST(Said, WhatActsOnceSettlesNothing) {
  SaidBy program;
  program.word('G', 4).word('G', 10).word('G', 28).word('G', 92).word('M', 0).word('X', 5);
  EXPECT_EQ(program.said.among(~interpret::ModeMask{0}), 0U);
}

// G70 and G71 are units on a SINUMERIK, finishing cycles elsewhere; G500 … G599 are its frames.
TEST(Said, GoesByTheDialect) {
  for (const double g : {70.0, 71.0, 700.0, 710.0}) {
    EXPECT_TRUE(SaidBy(config_of(Dialect::sinumerik)).word('G', g).said.has(mode(GGroup::units)));
    EXPECT_FALSE(SaidBy(config_of(Dialect::linuxcnc)).word('G', g).said.has(mode(GGroup::units)));
  }
  SaidBy frame(config_of(Dialect::sinumerik));
  EXPECT_TRUE(frame.word('G', 505).said.has(mode(GGroup::work_offset)));
  EXPECT_FALSE(SaidBy().word('G', 505).said.has(mode(GGroup::work_offset)));
}

TEST(Said, AWorkOffsetIsKnownWhereTheControlsFilesAre) {
  EXPECT_TRUE(SaidBy(config_of(Dialect::linuxcnc, true)).said.has(mode(GGroup::work_offset)));
  EXPECT_FALSE(SaidBy().said.has(mode(GGroup::work_offset)));
}

// M72, or the end of a subprogram after M73, brings back the control's own modes: they stay unset
// however often the program sets them later.
TEST(Said, AModeSavedBeforeItWasSetIsNeverSettled) {
  for (const double save : {70.0, 73.0}) {
    SaidBy program;
    program.word('G', 21).word('M', save).word('G', 90).word('F', 100).word('G', 21);
    EXPECT_TRUE(program.said.has(mode(GGroup::units))) << save;
    EXPECT_FALSE(program.said.has(mode(GGroup::distance))) << save;
    EXPECT_FALSE(program.said.has(interpret::kFeedMode)) << save;
    program.said.motion();
    EXPECT_FALSE(program.said.has(mode(GGroup::motion))) << save;
  }
}

std::string taken_from(SaidBy& program, const Asked& asked, std::uint32_t known = kNoAxes) {
  program.said.look(asked, known, kOffset1, 12);
  const auto& taken = program.said.taken();
  return taken ? taken->what : "";
}

TEST(Said, AValueOfTheControlIsTakenFromIt) {
  SaidBy program;
  Asked asked;
  EXPECT_EQ(taken_from(program, asked), "") << "nothing was read";
  asked.about("#31");
  EXPECT_THAT(taken_from(program, asked), HasSubstr("uses #31"));
  EXPECT_EQ(program.said.taken()->line, 12U);
  EXPECT_THAT(program.said.taken()->to_do, HasSubstr("--variables"));
}

TEST(Said, APositionIsKnownOnceTheProgramHasGivenIt) {
  Asked asked;
  asked.about_position(2);
  SaidBy program;
  EXPECT_EQ(taken_from(program, asked, 0b100), "");
  EXPECT_THAT(taken_from(program, asked, 0b011), HasSubstr("uses the position of Z"));
}

TEST(Said, AModeIsKnownOnceTheProgramHasSetIt) {
  Asked asked;
  asked.about_mode(mode(GGroup::units) | interpret::kFeedMode);
  SaidBy program;
  program.word('G', 21).word('F', 100);
  EXPECT_EQ(taken_from(program, asked), "");
  SaidBy half;
  half.word('G', 21);
  EXPECT_THAT(taken_from(half, asked), HasSubstr("a mode of the control"));
}

// Numbers of an inactive offset lie dormant and do no harm; before any is selected all may be
// active.
TEST(Said, NumbersOfAnOffsetInForceAreAFinding) {
  Asked active;
  active.about_offset(kOffset1);
  Asked dormant;
  dormant.about_offset(kOffset1 << 1U);
  SaidBy selected;
  selected.word('G', 54);
  EXPECT_EQ(taken_from(selected, dormant), "");
  EXPECT_THAT(taken_from(selected, active), HasSubstr("sets the active work offset"));
  EXPECT_THAT(selected.said.taken()->to_do, HasSubstr("G10 L2"));
  SaidBy unselected;
  EXPECT_THAT(taken_from(unselected, dormant), HasSubstr("sets the active work offset"));
  Asked shift;
  shift.about_offset(Asked::kShift);
  SaidBy shifted;
  shifted.word('G', 54);
  EXPECT_THAT(taken_from(shifted, shift), HasSubstr("sets the G92 shift"));
}

TEST(Said, KeepsTheFirstFinding) {
  SaidBy program;
  program.said.take({.line = 3, .what = "first"});
  program.said.take({.line = 4, .what = "second"});
  Asked asked;
  asked.about("#31");
  EXPECT_EQ(taken_from(program, asked), "first");
  EXPECT_EQ(program.said.taken()->line, 3U);
}

}  // namespace
}  // namespace steadyrest::nc::rewrite
