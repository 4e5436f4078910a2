// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <string_view>

#include <gtest/gtest.h>

#include <steadyrest/nc/interpret/test/moves.hpp>

namespace steadyrest::nc::interpret {
namespace {

using read::Dialect;

/// `3 units`: the line and what it depends on; empty for nothing.
std::string assumed(std::string_view text, Config config) {
  Kept kept;
  const auto report = run_text(text, config, kept);
  EXPECT_TRUE(report && report->refused.empty()) << text;
  EXPECT_LE(report->assumed.size(), 1U) << text;
  return report->assumed.empty()
             ? std::string{}
             : std::to_string(report->assumed[0].line) + ' ' + std::string(report->assumed[0].what);
}
std::string assumed(std::string_view text, Dialect dialect = Dialect::linuxcnc) {
  Config config;
  config.dialect = dialect;
  return assumed(text, config);
}

TEST(Assumptions, AreTheUnitsOfALengthBeforeItsUnitIsSaid) {
  for (const Dialect dialect : {Dialect::linuxcnc, Dialect::fanuc}) {
    EXPECT_EQ(assumed("G90 G17\nG0 X0 Y0\nX5.\nM30\n", dialect), "3 units");
    EXPECT_EQ(assumed("G0 X5.\nG21\nX6.\nM30\n", dialect), "1 units");
    EXPECT_EQ(assumed("G20\nG0 X5.\nM30\n", dialect), "");
    EXPECT_EQ(assumed("G21 G0 X5.\nM30\n", dialect), "") << "the unit acts first";
    EXPECT_EQ(assumed("F100\nG21\nG1 X5.\nM30\n", dialect), "1 units");
    EXPECT_EQ(assumed("G93\nG21 G1 X5. F2\nM30\n", Dialect::linuxcnc), "") << "F is a time";
  }
  EXPECT_EQ(assumed("G90\nG0 X5\nM30\n", Dialect::sinumerik), "2 units");
  for (const std::string word : {"G70", "G71", "G700", "G710"}) {
    EXPECT_EQ(assumed(word + "\nG0 X5\nM30\n", Dialect::sinumerik), "") << word;
  }
}

// 0 is the same place in any unit; angles, times and numbers have none.
TEST(Assumptions, DoNotCountValuesWithoutAUnit) {
  EXPECT_EQ(assumed("G0 X0 Y0 Z0\nG91 G28 Z0\nG4 P2\nA90\nS500 M3\nT1 M6\nM2\n"), "");
  EXPECT_EQ(assumed("G91 G28 Z0\nG30 P2 Z0\nG4 X1.5\nM30\n", Dialect::fanuc), "");
  EXPECT_EQ(assumed("ROT Z30\nTRANS X0\nM30\n", Dialect::sinumerik), "");
}

TEST(Assumptions, SeeEveryKindOfLength) {
  for (const std::string block : {"G64 P0.1", "G10 L2 P1 X5", "G92 Z3", "G96 S100", "G43.1 Z10",
                                  "F100", "G95 F0.1", "@5 ^30", "G28 X3"}) {
    EXPECT_EQ(assumed("G17\nG0 X0\n" + block + "\nG21\nM2\n"), "3 units") << block;
  }
  for (const std::string block : {"TRANS X5", "G641 ADIS=0.5", "G0 X=IC(2)", "F100"}) {
    EXPECT_EQ(assumed("G17\n" + block + "\nG71\nM30\n", Dialect::sinumerik), "2 units") << block;
  }
}

TEST(Assumptions, AreNoneWhereTheControlsUnitIsKnown) {
  Config config;
  config.unit_known = config.inch = true;
  EXPECT_EQ(assumed("G0 X5\nM2\n", config), "");
  EXPECT_EQ(moves_of("G0 X5\nM2\n", config)[0].end[0], 127.0);
  config.dialect = Dialect::sinumerik;
  EXPECT_EQ(assumed("G70\nG1 X5 F10\nM30\n", config), "");
}

TEST(Assumptions, AreTheFeedsOfG70AndOfABlockWithG20) {
  EXPECT_EQ(assumed("G70\nG1 X5 F100\nM30\n", Dialect::sinumerik), "2 feed_units");
  EXPECT_EQ(assumed("G71\nG1 X5 F100\nM30\n", Dialect::sinumerik), "") << "mm either way";
  EXPECT_EQ(assumed("G700\nG1 X5 F100\nM30\n", Dialect::sinumerik), "");
  EXPECT_EQ(assumed("G20 F10\nG1 X5\nM2\n"), "1 feed_units") << "as rs274: F acts first";
  EXPECT_EQ(assumed("G20 F10\nG1 X5.\nM30\n", Dialect::fanuc), "");
  EXPECT_EQ(assumed("G21 F10\nG1 X5\nM2\n"), "");
}

TEST(Assumptions, AreTheThirdAndFourthReferencePoints) {
  EXPECT_EQ(assumed("G21 G91 G30 P2 Z0\nM30\n", Dialect::fanuc), "");
  EXPECT_EQ(assumed("G21\nG91 G30 P3 Z0\nM30\n", Dialect::fanuc), "2 reference_point");
}

}  // namespace
}  // namespace steadyrest::nc::interpret
