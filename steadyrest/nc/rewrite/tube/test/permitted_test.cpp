// SPDX-License-Identifier: Apache-2.0
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/nc/rewrite/tube/test/tube_shop.hpp>

// What each change may do, by programs that do a little more.
namespace steadyrest::nc::rewrite {
namespace {

using test::TubeShop;
using testing::HasSubstr;
using testing::StartsWith;

const std::string kSlot =
    "G21 G90 G94\n"  // 1, changed 2
    "S3000 M3\n"     // 2, changed 3
    "G0 X0 Y0\n"     // 3, changed 4
    "G1 X10 F600\n"  // 4, changed 5; its new lines from 6 on
    "Y5\n"           // 5
    "G0 X0\n"        // 6
    "M5\n"           // 7
    "M2\n";

TEST(Permitted, FeedsAreAtMostTheBlocks) {
  const TubeShop shop("feeds", 0.005);
  const auto verdict = [&](std::vector<std::string> lines) {
    return shop.verdict(kSlot, {{4, std::move(lines)}});
  };
  EXPECT_EQ(verdict({"G1 X4 F600.0", "X10 F300.0", "F600.0"}), "proved");
  // The next block takes a lower feed over; it may not take a higher one.
  EXPECT_EQ(verdict({"G1 X10 F60.0"}), "proved");
  EXPECT_THAT(verdict({"G1 X10 F600.0", "F601.0"}),
              StartsWith("changed:8: runs at 601 mm/min in place of 600 mm/min"));
  EXPECT_THAT(verdict({"G1 X10 F601.0"}), StartsWith("changed:6: has a feed of 601 mm/min"));
  EXPECT_THAT(verdict({"G1 X10 F0.0"}), StartsWith("changed:6: "));
  EXPECT_THAT(verdict({"G1 X5 Y0.01 F600.0", "X10 Y0"}),
              StartsWith("changed:6: is 0.010000 mm from the original's path"));
}

// F is put back before a block that must stay; one that is left out, or changed, is not proved.
TEST(Permitted, ALineThatMustStayKeepsItsFeed) {
  const TubeShop shop("feeds", 0.005);
  const std::string program = "G21 G90 G94\nG0 X0 Y0\nG1 X10 F600\nX20 M8\nX30 M9\nX30 M9\nM2\n";
  EXPECT_EQ(shop.verdict(program, {{3, {"G1 X10 F60.0", "F600.0"}}}), "proved");
  EXPECT_THAT(shop.verdict(program, {{3, {"G1 X10 F60.0", "F0.1"}}}),
              StartsWith("changed:7: runs at 0.1 mm/min in place of 600 mm/min"));
  EXPECT_THAT(shop.verdict(program, {{3, {"G1 X10 F60.0"}}}),
              StartsWith("changed:6: runs at 60 mm/min in place of 600 mm/min"));
}

TEST(Permitted, TheLowestFeedIsNamed) {
  const TubeShop shop("feeds", 0.005);
  shop.change(kSlot, {{4, {"G1 X4 F600.0", "X10 F150.0"}}});
  const auto proof = shop.prove();
  ASSERT_TRUE(proof.has_value());
  EXPECT_DOUBLE_EQ(proof->least_feed_ratio, 0.25);
  EXPECT_EQ(proof->slowest_line, 7U);
}

TEST(Permitted, AnFMayFollowALineThatStays) {
  const TubeShop shop("feeds", 0.005);
  const std::string program = "G21 G90 G94\n#1=10\nG0 X0\nG1 X[#1] F600\nX20\nM2\n";
  const std::string own = "G1 X[#1] F600";
  EXPECT_EQ(shop.verdict(program, {{4, {own, "F500.0"}}}), "proved");
  EXPECT_THAT(shop.verdict(program, {{4, {own, "F500.0 X10"}}}), HasSubstr("holds more than F"));
  EXPECT_THAT(shop.verdict(program, {{4, {"G1 X[#1+1] F600"}}}),
              StartsWith("changed:6: a new line names a parameter"));
  EXPECT_THAT(shop.verdict(program, {{4, {"G1 X10 F600"}}}),
              StartsWith("changed:5: replaces line 4 of the original, which must stay"));
}

TEST(Permitted, SpeedsTakeTheFeedAlongInProportion) {
  TubeShop shop("speeds", 0.005);
  shop.machine.spindle.max_rev_s = 60.0;
  const auto verdict = [&](const std::string& speed, const std::string& feed) {
    return shop.verdict(kSlot, {{2, {speed}}, {4, {feed}}});
  };
  EXPECT_EQ(verdict("S3300 M3", "G1 X10 F660"), "proved");
  EXPECT_EQ(verdict("S2700 M3", "G1 X10 F540"), "proved");
  EXPECT_THAT(verdict("S3300 M3", "G1 X10 F700"), StartsWith("changed:7: has a feed of 700"));
  EXPECT_THAT(verdict("S3300 M4", "G1 X10 F660"), StartsWith("changed:4: replaces a line"));
  EXPECT_THAT(verdict("S3300 M3 M8", "G1 X10 F660"), StartsWith("changed:4: replaces a line"));
  EXPECT_THAT(verdict("S3601 M3", "G1 X10 F660"), HasSubstr("the machine allows 0 to 3600 rpm"));
  // Not every feed has followed: the block after it takes it over.
  EXPECT_EQ(verdict("S3300 M3", "G1 X10 F600"), "proved");
  EXPECT_THAT(shop.verdict(kSlot, {{4, {"G1 X10 S3300 F660"}}}), StartsWith("changed:6: "));
  EXPECT_THAT(TubeShop("feeds", 0.005).verdict(kSlot, {{2, {"S3300 M3"}}}),
              StartsWith("changed:3: replaces line 2 of the original, which must stay"));
}

TEST(Permitted, TheMarkMustSayWhatWasChanged) {
  const auto verdict = [](const std::string& changes) {
    return TubeShop(changes, 0.1).verdict(kSlot, {{4, {"G1 X10 F600.0"}}});
  };
  EXPECT_EQ(verdict("predistort,feeds,speeds"), "proved");
  EXPECT_THAT(verdict("everything"), HasSubstr("--changes everything, which is not known"));
  EXPECT_THAT(verdict(""), HasSubstr("does not say what was changed"));
}

TEST(Permitted, TheTubeIsTheMarksUnlessItIsGiven) {
  const auto tube = [](const std::vector<Told>& told, std::optional<double> given) {
    const auto out = permitted_of("changed.nc", told, given, nullptr);
    EXPECT_TRUE(out.has_value());
    return out ? out->tube_mm : 0.0;
  };
  EXPECT_DOUBLE_EQ(tube({{"changes", "predistort"}, {"tube-mm", "0.25"}}, {}), 0.25);
  EXPECT_DOUBLE_EQ(tube({{"changes", "predistort"}, {"tube-mm", "0.25"}}, 0.1), 0.1);
  EXPECT_DOUBLE_EQ(tube({{"changes", "predistort"}}, {}), kUsualTube_mm);
  EXPECT_DOUBLE_EQ(tube({{"changes", "feeds"}}, {}), kSamePath_mm);
  EXPECT_FALSE(permitted_of("changed.nc", {{"changes", "feeds"}, {"tube-mm", "-1"}}, {}, nullptr));
}

}  // namespace
}  // namespace steadyrest::nc::rewrite
