// SPDX-License-Identifier: Apache-2.0
// Which blocks may be replaced, by programs with one block that cuts and one reason against it; and
// what is known of a block that may.
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/nc/rewrite/replace/at_worst.hpp>
#include <steadyrest/nc/rewrite/replace/cut_blocks.hpp>
#include <steadyrest/nc/rewrite/replace/test/read_back.hpp>

namespace steadyrest::nc::rewrite {
namespace {

using read::Dialect;
using test::blocks_of;
using test::Workshop;

/// Why the block in this line of a program stays.
Stays why_it_stays(const std::string& program, std::uint32_t line,
                   Dialect dialect = Dialect::linuxcnc) {
  Workshop shop;
  shop.config.axes = "XYZA";
  const CutBlocks found = blocks_of(shop, program, dialect);
  const CutBlock* const block = found.find(line);
  EXPECT_NE(block, nullptr) << program;
  return block == nullptr ? Stays::free : block->stays;
}

TEST(CutBlocks, StayWhereTheControlDoesMoreThanTheyShow) {
  const std::string head = "G21 G90 G94 G17 F100\nG0 X0 Y0 Z1\n";
  EXPECT_EQ(why_it_stays(head + "G1 X5\nM2\n", 3), Stays::free);
  EXPECT_EQ(why_it_stays(head + "G41.1 D2 G1 X5\nG1 X9\nG40 G1 X12\nM2\n", 4), Stays::compensated);
  EXPECT_EQ(why_it_stays(head + "G7\nG1 X5\nM2\n", 4), Stays::diameter);
  EXPECT_EQ(why_it_stays(head + "G1 X5 A90\nM2\n", 3), Stays::more_words);
  EXPECT_EQ(why_it_stays(head + "M49\nG1 X5\nM2\n", 4), Stays::locked);
  EXPECT_EQ(why_it_stays(head + "G5 I0 J3 P0 Q-3 X2 Y2\nM2\n", 3), Stays::spline);
  EXPECT_EQ(why_it_stays(head + "G1 X5 (" + std::string(230, '-') + ")\nM2\n", 3), Stays::too_long);
  EXPECT_EQ(why_it_stays("G71 G90 G94 F100\nG0 X0\nR1=5\nG1 X=R1\nM30\n", 4, Dialect::sinumerik),
            Stays::calculated);
  EXPECT_EQ(why_it_stays("G71 G90 G94 F100\nG0 X0\nG1 X=AC(5)\nM30\n", 3, Dialect::sinumerik),
            Stays::free);
}

// G40 alone leaves the tool beside the contour; no control accepts an arc from there.
TEST(CutBlocks, TheFirstMoveAfterCompensationStaysStraight) {
  const std::string on = "G21 G90 G94 G17 F100\nG0 X0 Y0 Z1\nG41.1 D2 G1 X5\nG1 X9\n";
  EXPECT_EQ(why_it_stays(on + "G40\nG1 X12\nG1 X20\nM2\n", 6), Stays::line_needed);
  EXPECT_EQ(why_it_stays(on + "G40\nG1 X12\nG1 X20\nM2\n", 7), Stays::free);
  EXPECT_EQ(why_it_stays(on + "G40 M8\nG4 P1\nG1 X12\nM2\n", 7), Stays::line_needed);
  EXPECT_EQ(why_it_stays(on + "G40\nG0 X12\nG1 X20\nM2\n", 7), Stays::free);
  EXPECT_EQ(why_it_stays(on + "G40 G1 X12\nG1 X20\nM2\n", 6), Stays::free);
  EXPECT_EQ(why_it_stays("G21 G90 G40 G94 G17 F100\nG0 X0 Y0\nG1 X5\nM2\n", 3), Stays::free);
}

// Only the control knows G54: after SUPA the place of an axis in the program's coordinates is
// unknown until the axis is programmed again. A rotary axis at rest does not matter: no block that
// replaces a cut names it.
TEST(CutBlocks, AnAxisThatStandsMayBeAnywhere) {
  const std::string head = "G71 G90 G94 G17 F100\nSUPA G0 X0 Y0 Z50 A30 D0\nG54\n";
  EXPECT_EQ(why_it_stays(head + "G0 X1 Y1 Z1\nG1 X5\nM30\n", 5, Dialect::sinumerik), Stays::free);
  EXPECT_EQ(why_it_stays(head + "G0 X1 Y1\nG1 X5\nM30\n", 5, Dialect::sinumerik),
            Stays::by_control);
  EXPECT_EQ(why_it_stays(head + "G0 X1 Y1 Z1\nG1 X5 A40\nM30\n", 5, Dialect::sinumerik),
            Stays::more_words);
}

// In inches F is inches a minute; G10 L2 R turns the work about Z, and shifts it.
TEST(CutBlocks, TellInWhichModesTheyWereWritten) {
  const Workshop shop;
  const CutBlocks found = blocks_of(shop,
                                    "G20 G91 G91.1 G18 G94\n"
                                    "G10 L2 P1 X1 Y2 Z3 R90\n"
                                    "G54 F12\n"
                                    "G90 G0 X0 Y0 Z0\n"
                                    "G91 G1 X2\n"
                                    "M2\n");
  ASSERT_EQ(found.blocks.size(), 1U);
  EXPECT_EQ(found.find(4), nullptr);
  const CutBlock& block = *found.find(5);
  EXPECT_EQ(block.stays, Stays::more_words) << "it sets G91";
  EXPECT_DOUBLE_EQ(block.feed, 12.0);
  EXPECT_DOUBLE_EQ(block.unit_mm, 25.4);
  EXPECT_TRUE(block.incremental);
  EXPECT_FALSE(block.centre_absolute);
  EXPECT_EQ(block.plane, interpret::Plane::zx);
  EXPECT_DOUBLE_EQ(block.rotation_deg, 90.0);
  EXPECT_NEAR(block.start_mm[0], 25.4, 1e-9);
  EXPECT_NEAR(block.end_mm[0], 25.4, 1e-9);  // work X is the machine's Y
  EXPECT_NEAR(block.end_mm[1], 4.0 * 25.4, 1e-9);
  EXPECT_NEAR(block.end_mm[2], 3.0 * 25.4, 1e-9);
}

TEST(CutBlocks, TellWhatTheNextTakesOver) {
  const Workshop shop;
  const CutBlocks found = blocks_of(shop,
                                    "G21 G90\nG0 X0\n"
                                    "G1 X1 F9\nX2\n"        // 3 hands on both, 4 the feed
                                    "G1 X3\nG1 X4 F8\n"     // 5, 6: G1 and F are said again
                                    "G0 X0\nG1 X5\nM2\n");  // 6 hands on its feed across a rapid
  const auto inherited = [&](std::uint32_t line) { return found.find(line)->inherited; };
  const auto feed_inherited = [&](std::uint32_t line) { return found.find(line)->feed_inherited; };
  ASSERT_EQ(found.blocks.size(), 5U);
  EXPECT_TRUE(inherited(3) && feed_inherited(3));
  EXPECT_TRUE(!inherited(4) && feed_inherited(4));
  EXPECT_TRUE(!inherited(5) && !feed_inherited(5));
  EXPECT_TRUE(!inherited(6) && feed_inherited(6));
}

// A block with another G word leans on the motion in force all the same.
TEST(CutBlocks, HandTheirMotionOnToABlockWithAnyOtherWord) {
  const auto hands_on = [&](const std::string& next, Dialect dialect) {
    const Workshop shop;
    const std::string millimetres = dialect == Dialect::sinumerik ? "G71" : "G21";
    const CutBlocks found = blocks_of(
        shop, millimetres + " G90 G94 G17 F100\nG0 X0 Y0 Z1\nG1 X5\n" + next + "\nM30\n", dialect);
    return found.find(3) != nullptr && found.find(3)->inherited;
  };
  for (const Dialect dialect : {Dialect::linuxcnc, Dialect::fanuc, Dialect::sinumerik}) {
    for (const char* const next : {"G91 X7", "G90 X7", "G40 X7", "G64 X7", "G54 X7", "G9 X7",
                                   "G17 X7", "G94 X7 F50", "M8 X7", "G91\nM8\nX7"}) {
      if (dialect == Dialect::linuxcnc && std::string_view(next) == "G9 X7") {
        continue;  // not a word of LinuxCNC
      }
      EXPECT_TRUE(hands_on(next, dialect)) << next;
    }
    EXPECT_FALSE(hands_on("G1 G91 X7", dialect));
    EXPECT_FALSE(hands_on("G0 X7", dialect));
  }
  for (const char* const next :
       {"G53 X7", "G61 X7", "G61.1 X7", "G59.3 X7", "G91.1 X7", "M70", "M73"}) {
    EXPECT_TRUE(hands_on(next, Dialect::linuxcnc)) << next;
  }
  EXPECT_FALSE(hands_on("G43.1 Z1 X7\nG0 X9", Dialect::linuxcnc)) << "X is G43.1's";
  EXPECT_FALSE(hands_on("G81 X7 Z-1 R1\nX9", Dialect::linuxcnc));
}

TEST(CutBlocks, HandNothingOnToADwell) {
  const auto arc_before = [](const std::string& next, Dialect dialect) {
    return why_it_stays("G21 G90 G94 G17 F100\nG0 X9 Y0 Z1\nG2 X9 Y0 I-9 J0\n" + next + "\nM2\n", 3,
                        dialect);
  };
  EXPECT_EQ(arc_before("G4 P0.5", Dialect::linuxcnc), Stays::free);
  EXPECT_EQ(arc_before("G4 P500", Dialect::fanuc), Stays::free);
  EXPECT_EQ(arc_before("G4 P0.5\nG0 X1", Dialect::linuxcnc), Stays::free);
  EXPECT_EQ(arc_before("G4 P0.5\nX9 Y0 I-9 J0", Dialect::linuxcnc), Stays::motion_needed);
}

// LinuxCNC ignores G52 when G10 changes the rotation under it: the control counts with another
// point than where the machine is, and an axis that is not named goes there.
TEST(CutBlocks, StayWholeWhereTheControlCountsWithAnotherStart) {
  Workshop shop;
  shop.config.start_known = true;
  CutBlocks found = blocks_of(shop,
                              "G21 G90 G17 F100\nG0 X10 Y5 Z1\nG52 Y3\nG10 L2 P0 X2 R71\n"
                              "G1 Y20\nG1 X30\nM2\n");
  ASSERT_EQ(found.blocks.size(), 2U);
  EXPECT_EQ(found.find(5)->stays, Stays::beside);
  EXPECT_TRUE(found.find(5)->begins_beside);
  EXPECT_NEAR(found.find(5)->start_mm[0], 10.0, 1e-9);
  EXPECT_NEAR(found.find(5)->start_mm[1], 5.0, 1e-9);
  EXPECT_EQ(found.find(6)->stays, Stays::free);
  EXPECT_FALSE(found.find(6)->begins_beside);
}

// A refusal names a line: the block there stays, then the ones before it, then those behind it.
TEST(CutBlocks, NearARefusalStayOneAfterAnother) {
  const Workshop shop;
  CutBlocks found =
      blocks_of(shop, "G21 G90 F100\nG0 X0\nG1 X1\nG1 X2\nG1 X3 M8\nG1 X4\nG1 X5\nM2\n");
  EXPECT_EQ(found.keep_near(5, 1), 1U);
  EXPECT_EQ(found.lines_that_stay(Stays::unproved), (std::vector<std::uint32_t>{4}));
  EXPECT_EQ(found.keep_near(5, 2), 2U);
  EXPECT_EQ(found.lines_that_stay(Stays::unproved), (std::vector<std::uint32_t>{3, 4, 6}));
  EXPECT_EQ(found.keep_near(0, 9), 1U);
  EXPECT_EQ(found.keep_near(0, 9), 0U);
  EXPECT_EQ(found.find(5)->stays, Stays::more_words) << "its own reason";
}

TEST(CutBlocks, AreAllKeptBeforeAProgramIsRefused) {
  const Workshop shop;
  std::string program = "G21 G90 F100\nG0 X0\n";
  for (int i = 1; i <= 40; ++i) {
    program += "G1 X" + std::to_string(i) + "\n";
  }
  CutBlocks found = blocks_of(shop, program + "M2\n");
  int made = 0;
  const auto never = [&]() -> kernel::outcome::Result<int> {
    ++made;
    return kernel::outcome::refuse("p.ngc", 20U, "no", "never");
  };
  EXPECT_FALSE(at_worst_they_stay(found, never).has_value());
  EXPECT_LE(made, 5) << "eight times as many each time";
  EXPECT_EQ(found.lines_that_stay(Stays::unproved).size(), 40U);
}

}  // namespace
}  // namespace steadyrest::nc::rewrite
