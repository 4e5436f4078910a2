// SPDX-License-Identifier: Apache-2.0
// The proof that a program with other speeds cuts the same: one thing is spoiled at a time.
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/nc/rewrite/replace/same_cut.hpp>
#include <steadyrest/nc/rewrite/test/workshop.hpp>

namespace steadyrest::nc::rewrite {
namespace {

using test::Workshop;
using ::testing::HasSubstr;

const std::string kSpeedCut =
    "G21 G90 G94 G17\n"    // 1
    "S3000 M3\n"           // 2
    "G0 X0 Y0 Z1\n"        // 3
    "G1 X10 F600\n"        // 4
    "G3 X20 Y10 I0 J10\n"  // 5
    "G95 G1 Y20 F0.2\n"    // 6
    "M2\n";

/// What the proof says of the program with these lines; empty when it holds.
std::string speed_fault(const NewLines& lines, Changes changes = Changes::speeds) {
  const Workshop shop;
  test::write_file(shop.original(), kSpeedCut);
  const auto out =
      replace(shop.original(), read::Dialect::linuxcnc, lines, {{"changes", "speeds"}});
  EXPECT_TRUE(out.has_value());
  const auto proof = prove_same_cut(shop.original(), *out, shop.config, changes, 1e-5);
  return proof ? "" : proof.error().what;
}

TEST(SameCut, TheFeedFollowsTheSpeedOrStays) {
  EXPECT_EQ(speed_fault({}), "");
  EXPECT_EQ(speed_fault({{2, {"S3300 M3"}}, {4, {"G1 X10 F660"}}}), "");
  EXPECT_EQ(speed_fault({{2, {"S3300 M3"}}}), "") << "the feed may stay";
  EXPECT_THAT(speed_fault({{2, {"S3300 M3"}}, {4, {"G1 X10 F661"}}}), HasSubstr("another feed"));
  EXPECT_THAT(speed_fault({{4, {"G1 X10 F660"}}}), HasSubstr("line 4: another feed"));
  EXPECT_THAT(speed_fault({{2, {"S3300 M3"}}, {6, {"G95 G1 Y20 F0.22"}}}),
              HasSubstr("line 6: another feed"));
}

TEST(SameCut, TheSpindleTurnsTheSameWay) {
  EXPECT_THAT(speed_fault({{2, {"S3000 M4"}}}), HasSubstr("line 2: another event"));
  EXPECT_THAT(speed_fault({{2, {"S3000"}}}), HasSubstr("line 2: another event"));
  EXPECT_THAT(speed_fault({{2, {"S3300 M3"}}}, Changes::feeds), HasSubstr("another event"));
}

// Half a radian of R10 about X10 Y10 ends at X14.79426 Y1.22417.
TEST(SameCut, PartsLieOnTheWhole) {
  const std::string rest = "G3 X20 Y10 I-4.79426 J8.77583";
  EXPECT_EQ(speed_fault({{5, {"G3 X14.79426 Y1.22417 I0 J10", rest}}}), "");
  EXPECT_THAT(speed_fault({{5, {"G3 X14.79426 Y1.23417 I0 J10.005", rest}}}), HasSubstr("another"));
  EXPECT_EQ(speed_fault({{4, {"G1 X4 F600", "G1 X10"}}}), "");
  EXPECT_THAT(speed_fault({{4, {"G1 X4 Y0.001 F600", "G1 X10 Y0"}}}), HasSubstr("another path"));
  EXPECT_THAT(speed_fault({{4, {"G1 X11 F600", "G1 X10"}}}), HasSubstr("another path"));
  EXPECT_THAT(speed_fault({{4, {"G1 X4 F600"}}}), HasSubstr("another path"));
  EXPECT_THAT(speed_fault({{4, {"F600"}}}), HasSubstr("line 4: fewer moves"));
}

TEST(SameCut, AProgramEndsAsItDid) {
  EXPECT_THAT(speed_fault({{7, {"M9", "M2"}}}), HasSubstr("another event"));
  EXPECT_THAT(speed_fault({{7, {"G1 Y30", "M2"}}}), HasSubstr("more moves"));
  EXPECT_THAT(speed_fault({{7, {"G18", "M2"}}}), HasSubstr("modal state"));
}

}  // namespace
}  // namespace steadyrest::nc::rewrite
