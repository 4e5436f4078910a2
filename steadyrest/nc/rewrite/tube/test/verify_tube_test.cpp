// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/nc/rewrite/tube/test/tube_shop.hpp>

// Programs whose distance from the original is known from their numbers. The mark is line 1.
namespace steadyrest::nc::rewrite {
namespace {

using test::TubeShop;
using testing::HasSubstr;
using testing::StartsWith;

/// A full circle of R 10 about X0 Y0 from X10 Y0, entered and left by rapids.
const std::string kCircle =
    "G21 G90 G94 G17\n"      // 1, changed 2
    "G0 X10 Y0\n"            // 2, changed 3
    "G2 X10 Y0 I-10 F500\n"  // 3, changed 4; its new lines from 5 on
    "G0 X0 Y0\n"             // 4
    "M2\n";

/// The circle by R 10.1.
const NewLines kWider = {{3, {"G1 X10.1 Y0 F500.0", "G2 X10.1 Y0 I-10.1 J0 F500.0"}}};

TEST(VerifyTube, ProvesACircleByAWiderOneAndSaysHowFarItIs) {
  const TubeShop shop;
  shop.change(kCircle, kWider);
  const auto proof = shop.prove();
  ASSERT_TRUE(proof.has_value()) << proof.error().what;
  EXPECT_EQ(proof->replaced_lines, 1U);
  EXPECT_EQ(proof->new_lines, 2U);
  EXPECT_EQ(proof->moves, 4U);
  EXPECT_NEAR(proof->farthest_mm, 0.1, 0.001);
  EXPECT_DOUBLE_EQ(proof->tube_mm, 0.2);
}

TEST(VerifyTube, RefusesWhatLeavesTheTubeWithItsLine) {
  const TubeShop narrow("predistort", 0.05);
  EXPECT_THAT(narrow.verdict(kCircle, kWider),
              StartsWith("changed:5: is 0.100000 mm from the original's path there"));
  // To the µm: 0.1 mm is too much for 0.099 mm, and not for 0.1001 mm.
  EXPECT_NE(TubeShop("predistort", 0.099).verdict(kCircle, kWider), "proved");
  EXPECT_EQ(TubeShop("predistort", 0.1001).verdict(kCircle, kWider), "proved");
}

TEST(VerifyTube, RefusesAPieceOutsideByOneMicrometre) {
  const std::string line = "G21 G90 G94 G17\nG0 X0 Y0\nG1 X20 F500\nG0 Y5\nM2\n";
  const TubeShop shop("predistort", 0.1);
  EXPECT_EQ(shop.verdict(line, {{3, {"G1 X10 Y0.1 F500.0", "G1 X20 Y0 F500.0"}}}), "proved");
  EXPECT_THAT(shop.verdict(line, {{3, {"G1 X10 Y0.101 F500.0", "G1 X20 Y0 F500.0"}}}),
              StartsWith("changed:5: is 0.101000 mm"));
  // An arc whose middle alone is outside: sagitta 0.101 mm over the chord of 20 mm.
  const double radius = (10.0 * 10.0 + 0.101 * 0.101) / (2.0 * 0.101);
  const std::string arc = fmt::format("G2 X20 Y0 I10 J{:.6f} F500.0", -(radius - 0.101));
  EXPECT_THAT(shop.verdict(line, {{3, {arc}}}), StartsWith("changed:5: is 0.10"));
  EXPECT_EQ(TubeShop("predistort", 0.1011).verdict(line, {{3, {arc}}}), "proved");
}

/// A corner of 90° at X10 Y0, with the tool's coolant at its end.
const std::string kCorner =
    "G21 G90 G94\n"  // 1, changed 2
    "G0 X0 Y0\n"     // 2, changed 3
    "G1 X10 F500\n"  // 3, changed 4
    "G1 Y10 F500\n"  // 4
    "G0 X0 Y0\n"     // 5
    "M2\n";

TEST(VerifyTube, RefusesALeftOutCornerWithTheOriginalsLine) {
  const TubeShop shop("predistort", 0.3);
  // Cut at 0.4 mm from the corner: 0.2 mm from the legs, 0.28 mm from the corner.
  EXPECT_EQ(shop.verdict(kCorner,
                         {{3, {"G1 X9.6 F500.0"}}, {4, {"G1 X10 Y0.4 F500.0", "G1 Y10 F500.0"}}}),
            "proved");
  // At 0.5 mm: 0.25 mm from the legs, 0.354 mm from the corner.
  EXPECT_THAT(shop.verdict(kCorner,
                           {{3, {"G1 X9.5 F500.0"}}, {4, {"G1 X10 Y0.5 F500.0", "G1 Y10 F500.0"}}}),
              StartsWith("original:3: is left out by 0.353553 mm at X10.0000 Y0.0000"));
}

TEST(VerifyTube, ProvesACornerLedBeyond) {
  const TubeShop shop("predistort", 0.3);
  EXPECT_EQ(shop.verdict(kCorner,
                         {{3, {"G1 X10.25 F500.0"}}, {4, {"G1 X10 Y0.4 F500.0", "G1 Y10 F500.0"}}}),
            "proved");
}

TEST(VerifyTube, RefusesASpiralWithATurnLess) {
  // Half circles, 0.075 mm wider each: the turn inside or outside is within the tube everywhere.
  std::string program = "G21 G90 G94 G17\nG0 X10 Y0\n";
  NewLines less;
  double x = 10.0;
  for (std::uint32_t line = 3; line < 9; ++line) {
    const double to = -std::copysign(std::abs(x) + 0.075, x);
    const std::string half = fmt::format("G3 X{:.3f} Y0 I{:.4f} J0 F500", to, 0.5 * (to - x));
    program += half + "\n";
    const bool second = line == 5 || line == 6;
    less[line] = second ? std::vector<std::string>{} : std::vector{half};
    x = to;
  }
  less[7].insert(less[7].begin(), "G1 X10.3 Y0 F500");
  program += "G0 X0 Y0\nM2\n";
  const TubeShop shop;
  NewLines all = less;
  EXPECT_THAT(shop.verdict(program, less), HasSubstr("leaves something out"));
  all.erase(5);
  all.erase(6);
  all[7].erase(all[7].begin());
  EXPECT_EQ(shop.verdict(program, all), "proved");
}

TEST(VerifyTube, RefusesWhatANewLineMayNotDo) {
  const TubeShop shop;
  const auto verdict = [&](std::vector<std::string> lines) {
    return shop.verdict(kCircle, {{3, std::move(lines)}});
  };
  const std::string circle = "G2 X10 Y0 I-10 J0 F500.0";
  EXPECT_EQ(verdict({circle}), "proved");
  EXPECT_THAT(verdict({circle + " M8"}), StartsWith("changed:5: holds M8"));
  EXPECT_THAT(verdict({"G0 X10.1", "G2 X10.1 I-10.1 F500.0"}), StartsWith("changed:5: holds G0"));
  EXPECT_THAT(verdict({circle, "G91"}), StartsWith("changed:6: holds G91"));
  EXPECT_THAT(verdict({circle, "G4 P1"}), StartsWith("changed:6: holds G4"));
  EXPECT_THAT(verdict({circle, "#100=5"}), StartsWith("changed:6: a new line names a parameter"));
  EXPECT_THAT(verdict({circle, "G1 X[10+0] F500.0"}), StartsWith("changed:6: holds X[10+0]"));
  EXPECT_THAT(verdict({circle, "S500"}), StartsWith("changed:6: holds S500"));
  EXPECT_THAT(verdict({"/" + circle}), StartsWith("changed:5: is a new line that does more"));
  EXPECT_THAT(verdict({circle + " (ABORT,no)"}), StartsWith("changed:5: a new line has a comment"));
  EXPECT_THAT(verdict({"G2 X10 Y0 I-10 J0 F5000.0"}), StartsWith("changed:5: has a feed of 5000"));
  EXPECT_THAT(verdict({"G2 X10 Y0 I-10 J0 F99.0"}), StartsWith("changed:5: has a feed of 99"));
  EXPECT_EQ(verdict({"G2 X10 Y0 I-10 J0 F1000.0"}), "proved");
  EXPECT_EQ(verdict({"G2 X10 Y0 I-10 J0 F100.0"}), "proved");
  EXPECT_THAT(verdict({"G93 G2 X10 Y0 I-10 J0 F8.0"}), StartsWith("changed:5: holds G93"));
  EXPECT_THAT(verdict({"G3 X10 Y0 I-10 J0 F500.0"}), StartsWith("original:3: is left out"));
  EXPECT_THAT(verdict({}), StartsWith("original:3: is left out"));
}

TEST(VerifyTube, RefusesAChangedEnd) {
  const TubeShop shop;
  const std::string start = "G21 G90 G94\nG0 X0 Y0\nG1 X10 F500\n";
  const NewLines off = {{3, {"G1 X10.1 F500.0"}}};
  // A line names X again: it may start a little elsewhere.
  EXPECT_EQ(shop.verdict(start + "G1 X20 F500\nM2\n", off), "proved");
  EXPECT_THAT(shop.verdict(start + "G1 Y5 F500\nM2\n", off),
              StartsWith("changed:6: ends 0.100000 mm from where the original's ends in X"));
  EXPECT_THAT(shop.verdict(start + "G91 G1 X5 F500\nM2\n", off),
              StartsWith("changed:6: ends 0.100000 mm"));
  EXPECT_THAT(shop.verdict(start + "G2 X12 Y0 I1 F500\nM2\n", off), StartsWith("changed:6: "));
  EXPECT_THAT(shop.verdict(start + "M2\n", off), HasSubstr("ends at another position"));
  EXPECT_THAT(shop.verdict(start + "#1=[#<_x>]\nG1 X20 F500\nM2\n", off),
              HasSubstr("leaves another value in"));
}

TEST(VerifyTube, RefusesMotionAndFeedThatTheNextBlockWouldTakeOver) {
  const TubeShop shop;
  const std::string program = "G21 G90 G94 G17\nG0 X0 Y0\nG1 X10 F500\nX20\nG0 X0\nM2\n";
  const std::string line = "G1 X5 F400.0";
  const std::string arc = "G3 X10 Y0 I2.5 J50 F400.0";
  EXPECT_THAT(shop.verdict(program, {{3, {line, arc}}}), StartsWith("changed:7: "));
  EXPECT_THAT(shop.verdict(program, {{3, {line, arc, "G1"}}}),
              StartsWith("changed:8: runs at 400 mm/min in place of 500 mm/min"));
  EXPECT_EQ(shop.verdict(program, {{3, {line, arc, "G1 F500.0"}}}), "proved");
}

TEST(VerifyTube, RefusesBlocksThatMustStay) {
  const TubeShop shop;
  EXPECT_THAT(shop.verdict("G21 G90 G94\nG0 X0\nG1 X10 F500 M8\nM2\n", {{3, {"G1 X10 F500.0"}}}),
              StartsWith("changed:4: replaces line 3 of the original, which must stay: it does "
                         "more than cut"));
  EXPECT_THAT(shop.verdict("G21 G90 G94\nG0 X0\nG1 F500\nO1 repeat [2]\nG1 X10\nG0 X0\n"
                           "O1 endrepeat\nM2\n",
                           {{5, {"G1 X10 F500.0"}}}),
              StartsWith("changed:6: replaces line 5 of the original, which must stay"));
  EXPECT_THAT(shop.verdict("G21 G90 G94\nG0 X0\nM2\n", {{2, {"G0 X0"}}}),
              HasSubstr("which must stay: it does not cut"));
}

TEST(VerifyTube, RefusesTextsThatAreNotTheOriginals) {
  const TubeShop shop;
  const std::string text = shop.change(kCircle, kWider);
  const auto verdict = [&](const std::string& from, const std::string& to) {
    test::write_file(shop.changed(), test::replaced(text, from, to));
    return shop.verdict();
  };
  EXPECT_THAT(verdict("G0 X0 Y0\n", "G0 X0 Y1\n"), StartsWith("changed:7: differs from the orig"));
  EXPECT_THAT(verdict("M2\n", ""), StartsWith("changed:8: ends before the original"));
  EXPECT_THAT(verdict("M2\n", "M2\nG0 X1\n"), StartsWith("changed:9: differs"));
  EXPECT_THAT(verdict("I-10 F500\n", "I-10 F501\n"), StartsWith("changed:4: differs"));
  EXPECT_THAT(verdict("--changes predistort", "--changes feeds"), HasSubstr("record in its head"));
}

TEST(VerifyTube, ProvesBothPositionsOfBlockDelete) {
  const TubeShop shop;
  // With the `/` line executed the arc that follows starts elsewhere.
  const std::string program = "G21 G90 G94\nG0 X0 Y0\n/G0 X0 Y1\nG1 X10 Y0 F500\nG0 X0\nM2\n";
  EXPECT_EQ(shop.verdict(program, {{4, {"G1 X10 Y0.1 F500.0", "G1 Y0 F500.0"}}}), "proved");
  TubeShop skips;
  skips.config.block_delete = true;
  EXPECT_EQ(skips.verdict(program, {{4, {"G1 X10 Y0.1 F500.0", "G1 Y0 F500.0"}}}), "proved");
  // By way of Y0: right with the line skipped alone.
  const NewLines by_zero = {{4, {"G1 X0.5 Y0 F500.0", "G1 X10 F500.0"}}};
  EXPECT_THAT(skips.verdict(program, by_zero),
              HasSubstr("without block delete (lines with / executed): "));
  EXPECT_THAT(shop.verdict(program, by_zero), Not(HasSubstr("block delete")));
}

// Without its `/` line the program ends in an arc without a centre: no change can be proved then.
TEST(VerifyTube, ProvesAnUnchangedProgramThatTheOtherPositionOfBlockDeleteBreaks) {
  const TubeShop shop;
  const std::string program =
      "G21 G90 G94 G17\nG0 X0 Y0\nG1 X5 F500\nG2 X10 I2.5 J0\n/G1 X12\nX20\nM2\n";
  test::write_file(shop.original(), program);
  EXPECT_TRUE(verify_tube(shop.original(), shop.original(), shop.config, {}));
  EXPECT_THAT(shop.verdict(program, {{3, {"G1 X5 Y0.1 F500.0", "G1 Y0"}}}),
              HasSubstr("with block delete (lines with / skipped): "));
}

// G10 changes the rotation under G52: the cut begins where the machine is (X10 Y5), not where the
// control counts from. Feeds alone keep the path; another path behind it is seen.
TEST(VerifyTube, KnowsWhereACutBeginsWhenTheControlCountsWithAnotherPoint) {
  const std::string program =
      "G21 G90 G17 G54\nS1000 M3\nG0 X10 Y5 Z1\nG52 Y3\nG10 L2 P0 X2 R71\n"
      "G1 Y20 F100\nG1 X30\nG0 Z5\nM2\n";
  TubeShop feeds("feeds", 0.005);
  feeds.config.start_known = true;
  EXPECT_EQ(feeds.verdict(program, {{6, {"G1 Y20 F90"}}}), "proved");
  EXPECT_EQ(feeds.verdict(program, {{6, {"G1 Y20 F90"}}, {7, {"G1 X30 F50"}}}), "proved");
  TubeShop path("predistort", 0.2);
  path.config.start_known = true;
  // From the machine's place by its own line: a point of it, then the end.
  EXPECT_EQ(path.verdict(program, {{6, {"G1 X4.4956 Y20 F100"}}}), "proved");
  EXPECT_NE(path.verdict(program, {{6, {"G1 X4.4956 Y15 F100", "G1 X4.4956 Y20 F100"}}}), "proved");
}

}  // namespace
}  // namespace steadyrest::nc::rewrite
