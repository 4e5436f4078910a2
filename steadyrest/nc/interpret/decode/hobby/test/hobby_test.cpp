// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <vector>

#include <steadyrest/nc/interpret/test/moves.hpp>

// Grbl and Mach3 as their senders feed them.
namespace steadyrest::nc::interpret {
namespace {

Config hobby(read::Dialect dialect) {
  Config config;
  config.dialect = dialect;
  config.unit_known = true;
  return config;
}
const Config kGrbl = hobby(read::Dialect::grbl);
const Config kMach3 = hobby(read::Dialect::mach3);

std::vector<std::string> assumed_of(const std::string& text, const Config& config) {
  Kept kept;
  std::vector<std::string> out;
  const auto report = run_text(text, config, kept);
  for (const Assumption& assumption : report->assumed) {
    out.emplace_back(assumption.what);
  }
  return out;
}

TEST(Grbl, EndsWithItsFileAndSaysSo) {
  EXPECT_EQ(moves_of("G21\nG90\nG0 X1\nG1 X2 F100\n", kGrbl).size(), 2U);
  EXPECT_EQ(assumed_of("G0 X1\n", kGrbl), std::vector<std::string>{"end_of_file"});
  EXPECT_TRUE(assumed_of("G0 X1\nM2\n", kGrbl).empty());
  EXPECT_EQ(reason_of("G0 X1\n", Config{}), "no_program_end");
}

TEST(Grbl, PassesOverWhatIsForTheControl) {
  EXPECT_EQ(
      moves_of("%\n$X\n$$\n$G\n$32=1\n$ 30 = 1000\n?\n~\n%\nG0 X1 ?\n%\n%\nG0 X2\n", kGrbl).size(),
      2U);
  for (const auto& [line, reason] :
       {std::pair{"$H", "homing"}, std::pair{"$J=G91 X5 F100", "jogging"},
        std::pair{"$J=X1F1", "jogging"}, std::pair{"!", "feed_hold"},
        std::pair{"$3=1", "control_setting"}, std::pair{"$110=500", "control_setting"},
        std::pair{"$C", "control_setting"}, std::pair{"$SLP", "control_setting"}}) {
    EXPECT_EQ(reason_of(std::string(line) + "\nG0 X1\n", kGrbl), reason) << line;
  }
  EXPECT_EQ(reason_of("$X\nM2\n", Config{}), "missing_value") << "linuxcnc";
}

TEST(Grbl, ReadsTextAsLooselyAsItsSenders) {
  EXPECT_EQ(
      moves_of("g0   x1 y 2 (a (comment) ;more\nn10g1x3f200;end\nG1 X4 (open\n", kGrbl).size(), 3U);
  EXPECT_EQ(reason_of("G0 X#1\n", kGrbl), "parameter");
  EXPECT_EQ(reason_of("G0 X1 (a (b)\nM2\n", Config{}), "nested_comment");
}

TEST(Grbl, HasRoomFor79CharactersWithoutBlanksAndComments) {
  const std::string words = "G1 X1.000000000000 Y2.000000000000 Z3.000000000000 F100.0000000000";
  EXPECT_EQ(
      reason_of(words + "                 (A COMMENT OF ANY LENGTH, TAKEN OUT BEFORE)\n", kGrbl),
      "");
  EXPECT_EQ(reason_of(words + " S1000.0000000000000\n", kGrbl), "line_too_long");
}

TEST(Grbl, AssumesAFeedBeforeTheFirstF) {
  const auto moves = moves_of("G21 G90\nG0 X1\nG1 X2\nX3 F600\n", kGrbl);
  EXPECT_NEAR(moves[1].feed_mm_s, 100.0 / 60.0, 1e-12);
  EXPECT_NEAR(moves[2].feed_mm_s, 10.0, 1e-12);
  EXPECT_EQ(assumed_of("G21\nG1 X2\nM2\n", kGrbl), std::vector<std::string>{"feed"});
  EXPECT_TRUE(assumed_of("G21\nG1 F5\nG1 X2\nM2\n", kGrbl).empty());
  EXPECT_TRUE(assumed_of("G21\nG1\nG0 X2\nM2\n", kGrbl).empty());
  EXPECT_EQ(reason_of("G21 G93\nG1 X2\n", kGrbl), "feed_missing");
}

TEST(Grbl, SwitchesUnitsBeforeItReadsTheFeed) {
  EXPECT_NEAR(moves_of("G20 G1 X1 F60\n", kGrbl).front().feed_mm_s, 25.4, 1e-12);
}

TEST(Grbl, KnowsItsOwnWordsAndNamesOthers) {
  EXPECT_EQ(
      reason_of("G17 G21 G90 G94 G54 G40 G49 G80\nG10 L20 P1 X0 Y0 Z0\nG28.1\nG92 X1\nG92.1\n"
                "G43.1 Z5\nG49\nG38.2 Z-5 F50\nG53 G0 Z0\nT1 M6\nM3 S1000\nM4 S0\nM7\nM8\nM9\n"
                "M56\nG61\nG4 P0.5\nM0\nG28\nG81 X1 Z-1 R1 F50\nG80\nM5\n",
                kGrbl),
      "");
  for (const char* text : {"G64", "G64 P0.01", "G5 X1", "G33 Z1 K1", "G84 Z-1 R1", "G90.1"}) {
    EXPECT_EQ(reason_of(std::string(text) + "\n", kGrbl), "g_code_not_interpreted") << text;
  }
  EXPECT_EQ(reason_of("G41 D1\n", kGrbl), "g_code_not_interpreted");
  EXPECT_EQ(reason_of("M98 P1\n", kGrbl), "m_code_not_interpreted");
  EXPECT_EQ(reason_of("M106 S255\n", kGrbl), "m_code_not_interpreted");
}

// Laser programs: power in S, on at G1 alone.
TEST(Grbl, ReadsLaserPrograms) {
  Kept kept;
  const auto report =
      run_text("G21\nG90\nM4 S0\nG0 X1 Y1\nG1 X2 S500 F1200\nX3 S0\nM5\n", kGrbl, kept);
  ASSERT_TRUE(report && report->refused.empty());
  EXPECT_EQ(kept.moves.size(), 3U);
}

TEST(Mach3, CallsSubprogramsByNumberWithinTheFile) {
  const auto moves = moves_of(
      "%\nO100\nG21 G90 G64\n#1 = 5\nG0 X[#1 * 2]\nM98 P200 L2\nM30\nO200\nG91 G1 X1 "
      "F100\nG90\nM99\n",
      kMach3);
  ASSERT_EQ(moves.size(), 3U);
  EXPECT_EQ(moves.back().end[0], 12.0);
  EXPECT_EQ(moves_of("G0 X1\nG50 G69\nG0 X2\n%\nG0 X3\n", kMach3).size(), 3U);
  EXPECT_EQ(reason_of("G0 X1\nM47\n", kMach3), "endless");
  EXPECT_EQ(reason_of("G68 A0 B0 R30\n", kMach3), "g_code_not_interpreted");
}

}  // namespace
}  // namespace steadyrest::nc::interpret
