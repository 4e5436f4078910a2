// SPDX-License-Identifier: Apache-2.0
// A dwell between a rapid and a block that is replaced: where it may be, and in which words.
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/nc/rewrite/replace/block_text.hpp>
#include <steadyrest/nc/rewrite/tube/test/tube_shop.hpp>

namespace steadyrest::nc::rewrite {
namespace {

using test::TubeShop;
using testing::HasSubstr;

/// A rapid, and two blocks that cut.
const std::string kCut =
    "G21 G90 G94 G17\n"  // 1
    "G0 X1 Y0\n"         // 2
    "G1 X10 F500\n"      // 3
    "G1 Y10\n"           // 4
    "G0 X0 Y0\n"         // 5
    "M2\n";

const std::string kPath = "predistort,dwells";

TEST(Wait, BehindARapidIsProved) {
  const TubeShop shop(kPath);
  EXPECT_EQ(shop.verdict(kCut, {{3, {"G4 P0.20", "G1 X10 Y0.1 F500.0"}}}), "proved");
  EXPECT_EQ(shop.verdict(kCut, {{3, {"G4 P0.20", "G1 X10 F500"}}}), "proved");
  EXPECT_EQ(shop.prove()->moves, 5U);
}

TEST(Wait, MustBeAmongTheChangesThatTheHeadNames) {
  EXPECT_THAT(TubeShop("predistort,feeds").verdict(kCut, {{3, {"G4 P0.20", "G1 X10 F500"}}}),
              HasSubstr("changed:5: holds G4"));
}

// A tool that waits in the cut leaves a mark.
TEST(Wait, NowhereElse) {
  const TubeShop shop(kPath);
  const std::string where = "is a dwell that is not between a rapid and the block";
  EXPECT_THAT(shop.verdict(kCut, {{3, {"G1 X10 F500.0", "G4 P0.20"}}}), HasSubstr(where));
  EXPECT_THAT(shop.verdict(kCut, {{3, {"G1 X5 F500.0", "G4 P0.20", "G1 X10 F500.0"}}}),
              HasSubstr(where));
  EXPECT_THAT(shop.verdict(kCut, {{3, {"G4 P0.20", "G4 P0.20", "G1 X10 F500.0"}}}),
              HasSubstr(where));
  EXPECT_THAT(shop.verdict(kCut, {{4, {"G4 P0.20", "G1 Y10 F500.0"}}}), HasSubstr(where));
  EXPECT_THAT(
      shop.verdict(kCut, {{3, {"G1 X10 Y0.1 F500.0"}}, {4, {"G4 P0.20", "G1 X10 Y10 F500.0"}}}),
      HasSubstr(where));
}

// It starts and ends at one place, and cuts.
TEST(Wait, NotBehindAWholeCircle) {
  const TubeShop shop(kPath);
  const std::string head = "G21 G90 G94 G17\nG0 X50 Y30\n";
  for (const char* circle : {"G3 X50 Y30 I10 J0 F600\n", "G3 X50 Y30 I10 J0 P3 F600\n"}) {
    EXPECT_THAT(
        shop.verdict(head + circle + "G1 X80 F3000\nM2\n", {{4, {"G4 P1", "G1 X80 F3000"}}}),
        HasSubstr("is a dwell that is not between a rapid and the block"));
  }
}

TEST(Wait, NotBehindARapidThatGoesNowhere) {
  const TubeShop shop(kPath);
  const std::string cut = "G21 G90 G94 G17\nG0 X1\nG1 X10 F600\nG0 X";
  EXPECT_THAT(shop.verdict(cut + "10.0000001\nG1 X80\nM2\n", {{5, {"G4 P1", "G1 X80 F600"}}}),
              HasSubstr("is a dwell that is not between a rapid and the block"));
  EXPECT_EQ(shop.verdict(cut + "11\nG1 X80\nM2\n", {{5, {"G4 P1", "G1 X80 F600"}}}), "proved");
}

TEST(Wait, NotAtFeedsPerRevolution) {
  const TubeShop shop(kPath);
  EXPECT_THAT(shop.verdict("G21 G90 G95 G17\nS600 M3\nG0 X1\nG1 X10 F0.1\nM2\n",
                           {{4, {"G4 P0.2", "G1 X10 F0.1"}}}),
              HasSubstr("is a dwell at feeds per revolution"));
}

TEST(Wait, OfSecondsAlone) {
  const TubeShop shop(kPath);
  EXPECT_THAT(shop.verdict(kCut, {{3, {"G4 P6", "G1 X10 F500.0"}}}),
              HasSubstr("is a dwell of 6 s; 5 s are allowed"));
  EXPECT_THAT(shop.verdict(kCut, {{3, {"G4 P0.2 F500", "G1 X10"}}}),
              HasSubstr("is a dwell with more words than its time"));
  EXPECT_NE(shop.verdict(kCut, {{3, {"G4 P[1/5]", "G1 X10 F500.0"}}}), "proved");
  EXPECT_NE(shop.verdict(kCut, {{3, {"G4 P0.2 M8", "G1 X10 F500.0"}}}), "proved");
}

TEST(Wait, InTheWordsOfEachControl) {
  for (const auto dialect :
       {read::Dialect::linuxcnc, read::Dialect::fanuc, read::Dialect::sinumerik}) {
    TubeShop shop(kPath);
    shop.config.dialect = dialect;
    const bool siemens = dialect == read::Dialect::sinumerik;
    const std::string head = siemens ? "G710 G90 G94 G17\n" : "G21 G90 G94 G17\n";
    const std::string program = head + "G0 X1 Y0\nG1 X10 F500\nG1 Y10\nM30\n";
    EXPECT_EQ(shop.verdict(program, {{3, {dwell_text(dialect, 0.25), "G1 X10 F500"}}}), "proved");
    EXPECT_EQ(shop.prove()->moves, 4U);
  }
  EXPECT_EQ(dwell_text(read::Dialect::linuxcnc, 0.25), "G4 P0.25");
  EXPECT_EQ(dwell_text(read::Dialect::fanuc, 0.25), "G4 X0.25");
  EXPECT_EQ(dwell_text(read::Dialect::sinumerik, 0.25), "G4 F0.25");
}

}  // namespace
}  // namespace steadyrest::nc::rewrite
