// SPDX-License-Identifier: Apache-2.0
// Subprograms, conditions and loops. The expected values come from rs274 (LinuxCNC 2.9).
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <unistd.h>

#include <steadyrest/nc/interpret/test/moves.hpp>

namespace steadyrest::nc::interpret {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

std::vector<double> x_of(std::string_view text, const Config& config = {}) {
  return ends_along(0, text, config);
}

TEST(Flow, WhileRunsUntilItsConditionIsFalse) {
  EXPECT_THAT(x_of("o1 while [#1 LT 3]\n#1=[#1+1]\nG0 X#1\no1 endwhile\nM2\n"),
              ElementsAre(1, 2, 3));
}

TEST(Flow, PecksCountWhereALoopDoesNotEnd) {
  Config config;
  config.most_repeated_lines = 1000;
  Kept kept;
  const auto report = run_text(
      "F100 G0 Z10\no1 while [#1 LT 3]\nG83 X1 Z0 R9 Q0.01\no1 endwhile\nM2\n", config, kept);
  ASSERT_TRUE(report);
  ASSERT_EQ(report->refused.size(), 1U);
  EXPECT_EQ(report->refused.front().reason, "endless_program");
  EXPECT_LT(report->moves, 110'000U);  // one cycle makes 2,700; 333 turns would be 900,000
}

TEST(Flow, DoRunsOnceAtLeast) {
  EXPECT_THAT(x_of("o1 do\n#1=[#1+1]\nG0 X#1\no1 while [#1 LT 0]\nM2\n"), ElementsAre(1));
}

TEST(Flow, RepeatRoundsItsCountAndPassesOverWhatIsNotPositive) {
  EXPECT_THAT(
      x_of("o1 repeat [2.6]\nG91 G0 X1\no1 endrepeat\no2 repeat [-1]\nX9\no2 endrepeat\nM2\n"),
      ElementsAre(1, 2, 3));
}

// As rs274 does.
TEST(Flow, ARepeatThatIsLeftKeepsTheTurnsThatWereLeft) {
  EXPECT_THAT(
      x_of("o1 sub\no2 repeat [3]\nG91 G0 X1\no3 if [#1 GT 0]\no1 return\no3 endif\n"
           "o2 endrepeat\no1 endsub\no1 call [1]\no1 call [0]\nG90 G0 X0\no1 call [0]\nM2\n"),
      ElementsAre(1, 2, 3, 0, 1, 2, 3));
  for (const char* word : {"break", "continue"}) {
    const std::string out = std::string{"o1 "} + word;
    EXPECT_THAT(x_of("#2=0\no4 while [#2 LT 2]\n#2=[#2+1]\n#1=0\no1 while [#1 LT 1]\n#1=[#1+1]\n"
                     "o2 repeat [2]\nG91 G0 X1\no3 if [#2 LT 2]\n" +
                     out + "\no3 endif\no2 endrepeat\no1 endwhile\no4 endwhile\nM2\n"),
                ElementsAre(1, 2))
        << word;
  }
}

TEST(Flow, BreakAndContinueNameTheirLoop) {
  EXPECT_THAT(x_of("#1=0\no1 while [#1 LT 5]\n#1=[#1+1]\no2 if [#1 EQ 2]\no1 continue\no2 endif\n"
                   "o3 if [#1 EQ 4]\no1 break\no3 endif\nG0 X#1\no1 endwhile\nM2\n"),
              ElementsAre(1, 3));
}

TEST(Flow, ContinueInADoLoopAsksItsConditionFirst) {
  EXPECT_THAT(x_of("#1=0\no1 do\n#1=[#1+1]\no2 if [#1 LT 5]\no1 continue\no2 endif\nG0 X#1\n"
                   "o1 while [#1 LT 8]\nM2\n"),
              ElementsAre(5, 6, 7, 8));
}

TEST(Flow, WhatIsPassedOverIsNotRead) {
  EXPECT_THAT(
      x_of("o1 if [0]\nGARBAGE $$ here\no1 elseif [2]\nG0 X2\no1 else\nG0 X3\no1 endif\nM2\n"),
      ElementsAre(2));
}

TEST(Flow, WhatIsLookedForDoesNotStandBehindTheClosingPercent) {
  const std::string_view sub = "o1 sub\nG0 X1\no1 endsub\n";
  EXPECT_THAT(reason_of(std::string{"%\no1 call\nM2\n%\n"}.append(sub)), "o_word_without_end");
  EXPECT_THAT(reason_of("%\no1 if [0]\nG0 X1\n%\no1 endif\nM2\n"), "o_word_without_end");
  EXPECT_THAT(x_of(std::string{"o1 call\nM2\n%\n"}.append(sub)), ElementsAre(1));
}

TEST(Flow, ACallHasItsOwnThirtyParametersAndLocalNames) {
  // In the call: #30 is cleared, #1 is 5. After it: #29 of the caller is unchanged, #30 is 7 again;
  // #31 is common to both; the name is the caller's.
  EXPECT_THAT(x_of("#30=7 #<a>=1\no1 sub\n#<a>=5\nG0 X#30\nX#1\n#29=1\no1 endsub\n#31=2\n"
                   "o1 call [5] [6]\nX#29\nX#30\nX#31\nX#<a>\nM2\n"),
              ElementsAre(0, 5, 0, 7, 2, 1));
}

TEST(Flow, AReturnedValueIsReadAfterTheCall) {
  EXPECT_THAT(
      x_of("o<f> sub\no1 if [#1 GT 0]\no1 return [123*#1]\no1 endif\no<f> endsub [4712]\n"
           "o<f> call [0]\nG0 X#<_value>\no<f> call [2]\nX#<_value>\nX#<_value_returned>\nM2\n"),
      ElementsAre(4712, 246, 1));
}

TEST(Flow, ASubprogramMayStandBehindItsCall) {
  EXPECT_THAT(x_of("o<later> call [4]\nM2\no<later> sub\nG0 X#1\no<later> endsub\n"),
              ElementsAre(4));
}

TEST(Flow, GlobalNamesOutliveTheCall) {
  EXPECT_THAT(x_of("o1 sub\n#<_g>=4\no1 endsub\no1 call\nG0 X#<_g>\nM2\n"), ElementsAre(4));
}

TEST(Flow, ProgramsByNumberRepeatAndShareTheParameters) {
  EXPECT_THAT(x_of("#1=5\nM98 P100 L2\nG0 X#1\nM2\no100\n#1=[#1+1]\nM99\n"), ElementsAre(7));
  EXPECT_THAT(x_of("M98 P100 L0\nG0 X3\nM2\nO100 (x)\nG0 X1\nM99\n"), ElementsAre(3));
}

TEST(Flow, ASubprogramOfItsOwnFileIsFoundInItsFolder) {
  const auto folder =
      std::filesystem::temp_directory_path() / ("steadyrest-flow-" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "ext.ngc")
      << "o<ext> sub\nG0 X#1\no<ext> return [5]\nX99\no<ext> endsub\nM2\n";
  Config config;
  config.subprogram_folders = {folder.string()};
  EXPECT_THAT(x_of("o<ext> call [4]\nX#<_value>\no<ext> call [6]\nM2\n", config),
              ElementsAre(4, 5, 6));
  std::ofstream(folder / "bad.ngc") << "o<bad> sub\nG0 X[1/0]\no<bad> endsub\n";
  Kept kept;
  const auto report = run_text("o<bad> call\nM2\n", config, kept);
  ASSERT_EQ(report->refused.size(), 1U);
  EXPECT_EQ(report->refused.front().file, (folder / "bad.ngc").string());
  EXPECT_EQ(report->refused.front().line, 2U);
  EXPECT_EQ(first_refusal(*report, "main.ngc").file, (folder / "bad.ngc").string());
  std::filesystem::remove_all(folder);
}

TEST(Flow, ALoopGoesBackInAFileLongerThanItsBuffer) {
  const auto path = std::filesystem::temp_directory_path() /
                    ("steadyrest-long-" + std::to_string(::getpid()) + ".ngc");
  {
    std::ofstream out(path);
    // 2 MB, far more than the buffer: the loop must seek, and count lines on from there.
    out << "o1 repeat [3]\nG91 G0 X1\n";
    for (int i = 0; i < 60'000; ++i) {
      out << "(a comment that fills the buffer)\n";
    }
    out << "o1 endrepeat\nM2\n";
  }
  Kept kept;
  const auto report = run_file(path.string(), {}, kept);
  std::filesystem::remove(path);
  ASSERT_TRUE(report.has_value());
  EXPECT_THAT(report->refused, IsEmpty());
  ASSERT_EQ(kept.moves.size(), 3U);
  EXPECT_EQ(kept.moves.back().end[0], 3.0);
}

TEST(Flow, ModesThatM73KeptComeBackAtTheEndOfTheCall) {
  EXPECT_THAT(
      x_of("o1 sub\nM73\nG91 G20\nG0 X1\no1 endsub\nG90 G21\no1 call\nG0 X1\no1 call\nX1\nM2\n"),
      ElementsAre(25.4, 1, 26.4, 1));
  EXPECT_EQ(reason_of("M72\nM2\n"), "modes_not_kept");
}

TEST(Flow, PositionsOffsetsAndToolsAreReadAsParameters) {
  EXPECT_THAT(x_of("G0 X7\n#1=#5420\nX1\nX#1\nX[#<_x>+1]\nM2\n"), ElementsAre(7, 1, 7, 8));
  EXPECT_THAT(x_of("G10 L2 P2 X3\nG0 X#5241\nG55 X#5220\nX#5220\nM2\n"), ElementsAre(3, 1, 2));
  // A number that a program sets acts when its system is selected again, or when G10 sets it.
  EXPECT_THAT(x_of("#5221=3\nG92 Y1\nG0 Z1\nG10 L2 P1 Y1\nG0 Z2\nM2\n"), ElementsAre(0, -3));
}

}  // namespace
}  // namespace steadyrest::nc::interpret
