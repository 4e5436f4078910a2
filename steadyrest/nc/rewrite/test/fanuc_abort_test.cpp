// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/nc/rewrite/test/fanuc_shop.hpp>
#include <steadyrest/nc/rewrite/test/workshop.hpp>

// The same passes for controls that have no expressions.
namespace steadyrest::nc::rewrite {
namespace {

using test::Fanuc;
using test::kFanuc;
using test::kGrowth;
using test::replaced;
using test::text_of_file;
using ::testing::HasSubstr;

TEST_F(Fanuc, StopsAtTheHeadWhereNothingTellsWhatAnAbortedRunHasLeft) {
  const auto done = shop_.compensate(kFanuc, kGrowth);
  ASSERT_TRUE(done) << done.error().what;
  const std::string text = text_of_file(shop_.changed());
  EXPECT_THAT(text, HasSubstr("%\r\nO1234 (PASSES)\nM0 (STEADYREST head Z: AFTER AN ABORTED RUN"));
  ASSERT_TRUE(shop_.verify(kGrowth));
  EXPECT_THAT(shop_.fault(kGrowth, replaced(text, "M0 (STEADYREST", "M1 (STEADYREST")),
              HasSubstr("head"));
  EXPECT_NE(shop_.fault(kGrowth, replaced(text, "G90 (STEADYREST", "M0 G90 (STEADYREST")), "");
}

TEST_F(Fanuc, TakesOffWhatAnAbortedRunHasLeftWhereNobodyElseUsesTheExternalOffset) {
  shop_.settings.external_offset_free = true;
  shop_.settings.cleared_after_abort = true;
  const auto done = shop_.compensate(kFanuc, kGrowth);
  ASSERT_TRUE(done) << done.error().what;
  const std::string text = text_of_file(shop_.changed());
  const std::string head = "G90 G10 L2 P0 Z0.0000 (STEADYREST head Z)\n";
  EXPECT_THAT(text, HasSubstr("%\r\nO1234 (PASSES)\n" + head + "G21 G90"));
  // The head's one line moves the first insertion down.
  EXPECT_EQ(done->insertions.at(0).line, 9U);
  ASSERT_TRUE(shop_.verify(kGrowth));
  EXPECT_THAT(shop_.fault(kGrowth, replaced(text, head, "")), HasSubstr("head"));
  EXPECT_THAT(
      shop_.fault(kGrowth, replaced(text, "Z0.0000 (STEADYREST head", "Z0.001 (STEADYREST head")),
      HasSubstr("head"));
  const std::string late = replaced(replaced(text, head, ""), "G0 X0 Y10\n", head + "G0 X0 Y10\n");
  EXPECT_THAT(shop_.fault(kGrowth, late), HasSubstr("head"));
  ASSERT_TRUE(strip(shop_.changed(), shop_.changed()));
  EXPECT_EQ(text_of_file(shop_.changed()), kFanuc);
}

// 0 takes it off by value, but no number shows a touch-off made through it.
TEST_F(Fanuc, AsksBeforeItTakesOffWhereSomebodyMayHaveTouchedOff) {
  shop_.settings.external_offset_free = true;
  ASSERT_TRUE(shop_.compensate(kFanuc, kGrowth));
  const std::string text = text_of_file(shop_.changed());
  EXPECT_THAT(text, HasSubstr("\nM0 (STEADYREST head Z: IF TOUCHED OFF AFTER AN ABORTED RUN STOP"));
  EXPECT_THAT(text, HasSubstr(")\nG90 G10 L2 P0 Z0.0000 (STEADYREST head Z)\nG21 G90"));
  EXPECT_TRUE(shop_.verify(kGrowth));
}

// The head takes the external offset off in G90: the mode must be the program's own before it
// matters.
TEST_F(Fanuc, ItsHeadChangesNoModeThatTheProgramDoesNotSay) {
  const auto expect_refused = [&](const std::string& program, std::uint32_t line) {
    const auto refused = shop_.compensate(program, kGrowth);
    ASSERT_FALSE(refused) << program;
    EXPECT_THAT(refused.error().what, HasSubstr("G90")) << program;
    EXPECT_EQ(refused.error().to_do, "write G90 (or G91) before it");
    EXPECT_EQ(refused.error().line, line) << program;
  };
  const auto after = [](const std::string& lines) {
    // Before the program says G90 or G91 itself, the head's G90 would decide.
    return replaced(kFanuc, "G21 G90", lines + "G21 G90");
  };
  EXPECT_TRUE(shop_.compensate(after("G21 G54\nG0 X5\n"), kGrowth)) << "another head";
  shop_.settings.external_offset_free = true;
  expect_refused(after("G21 G54\nG0 X5\n"), 4U);
  expect_refused(after("/G90\nG0 X5\n"), 4U);
  expect_refused(after("/G0 X5\n"), 3U);
  expect_refused(after("G28 Z0\n"), 3U);
  expect_refused(after("G10 L2 P1 X5\n"), 3U);
  for (const char* lines : {"G91 G28 Z0\n", "G0 X5 G90\n", "M5\nT1 M6\n"}) {
    const auto done = shop_.compensate(after(lines), kGrowth);
    EXPECT_TRUE(done) << lines << done.error().what;
  }
}

TEST_F(Fanuc, TheExternalOffsetIsNotFreeWhereTheProgramSetsIt) {
  shop_.settings.external_offset_free = true;
  const auto refusal = [&](const std::string& line) {
    const auto done =
        shop_.compensate(replaced(kFanuc, "G0 X0 Y10\n", line + "\nG90\nG0 X0 Y10\n"), kGrowth);
    EXPECT_EQ(done ? 0U : done.error().line, done ? 0U : 9U) << line;
    return done ? "" : done.error().what + ": " + done.error().to_do;
  };
  // In any order and by expressions too: the effect counts, not the spelling.
  for (const char* line : {"G10 L2 P0 Z0", "P0 L2 G10 Z0", "G91 G10 L2 P0 Z0.1", "G10 L2 P0 X0",
                           "N8 G10 P0 L2 Y1", "G10 L2 P[1-1] Z0", "/G10 L2 P0 Z0"}) {
    EXPECT_THAT(refusal(line), HasSubstr("external_offset_free")) << line;
  }
  for (const char* line : {"#5203=0", "#[5200+3]=0", "#2500=0", "[#_WZCMN[3]]=0"}) {
    EXPECT_NE(refusal(line), "") << line;
  }
  EXPECT_EQ(refusal("G10 L2 P2 Z0"), "");
  const std::string text = text_of_file(shop_.changed());
  test::write_file(shop_.original(), replaced(text_of_file(shop_.original()), "P2 Z0", "P0 X0"));
  EXPECT_THAT(shop_.fault(kGrowth, replaced(text, "P2 Z0", "P0 X0")),
              HasSubstr("external offset itself"));
}

}  // namespace
}  // namespace steadyrest::nc::rewrite
