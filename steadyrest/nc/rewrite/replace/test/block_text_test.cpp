// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <steadyrest/math/geometry/vector.hpp>
#include <steadyrest/nc/rewrite/replace/block_text.hpp>
#include <steadyrest/nc/rewrite/replace/block_words.hpp>
#include <steadyrest/nc/rewrite/replace/cut_blocks.hpp>
#include <steadyrest/nc/rewrite/replace/test/read_back.hpp>

namespace steadyrest::nc::rewrite {
namespace {

using kernel::signal::Geometry;
using kernel::signal::Point;
using read::Dialect;
using test::blocks_of;
using test::moves_read_back;
using test::Workshop;

/// Why each block that cuts stays as it is, by line.
std::vector<std::pair<std::uint32_t, Stays>> stays(const CutBlocks& found) {
  std::vector<std::pair<std::uint32_t, Stays>> out;
  for (const CutBlock& block : found.blocks) {
    out.emplace_back(block.line, block.stays);
  }
  return out;
}

TEST(CutBlocks, SaysWhyABlockMustStay) {
  const Workshop shop;
  const auto found = blocks_of(shop,
                               "G21 G90 G94 G17 G64 G99\n"  // 1
                               "G0 X0 Y0 Z1\n"              // 2
                               "G1 Z-1 F100\n"              // 3 free
                               "G1 X5 M8\n"                 // 4 more words
                               "G2 X6 Y1 I0 J1\n"           // 5 arc that 6 takes its word from
                               "X7 Y2 I0 J1\n"              // 6
                               "G1 X[1+2] Y2\n"             // 7 calculated
                               "#1=5\n"                     // 8
                               "/G1 X3\n"                   // 9 switchable
                               "G93 G1 X4 F5\n"             // 10
                               "G1 X5 F5\n"                 // 11 feed mode
                               "G94 G1 X6 F100\n"           // 12 more words
                               "O100 repeat [2]\n"          // 13
                               "G1 X7\n"                    // 14 repeated
                               "G1 X6\n"                    // 15
                               "O100 endrepeat\n"           // 16
                               "G81 X1 Y1 Z-2 R1 F50\n"     // 17 a cycle
                               "G80\n"                      // 18
                               "G1 X9 F80\n"                // 19 free
                               "M2\n");
  EXPECT_EQ(stays(found), (std::vector<std::pair<std::uint32_t, Stays>>{{3, Stays::free},
                                                                        {4, Stays::more_words},
                                                                        {5, Stays::motion_needed},
                                                                        {6, Stays::free},
                                                                        {7, Stays::calculated},
                                                                        {9, Stays::switchable},
                                                                        {10, Stays::more_words},
                                                                        {11, Stays::feed_mode},
                                                                        {12, Stays::more_words},
                                                                        {14, Stays::repeated},
                                                                        {15, Stays::repeated},
                                                                        {17, Stays::spline},
                                                                        {19, Stays::free}}));
}

// Truth: the interpreter, which reads the text again.
RC_GTEST_PROP(BlockText, IsReadAsItWasMeant, ()) {
  const auto dialect = *rc::gen::element(Dialect::linuxcnc, Dialect::sinumerik, Dialect::fanuc);
  const bool inch = *rc::gen::element(false, true);
  const bool relative = *rc::gen::element(false, true);
  const Workshop shop;
  const std::string inches = dialect == Dialect::sinumerik ? "G700" : "G20";
  const std::string metric = dialect == Dialect::sinumerik ? "G710" : "G21";
  const std::string modes = "G17 G94 G54 " + (inch ? inches : metric) +
                            (relative ? " G91\n" : " G90\n") + "G0 X1. Y2. Z3.\n";
  const std::string line = "N70 G1 X4. Y2. F30.";
  const auto found = blocks_of(shop, modes + line + "\nM30\n", dialect);
  RC_ASSERT(found.blocks.size() == 1U);
  const CutBlock& block = found.blocks[0];
  RC_ASSERT(block.stays == Stays::free);
  RC_ASSERT(std::abs(block.feed - 30.0) < 1e-9);

  Point at = block.start_mm;
  std::vector<NewMove> moves;
  Point now = at;
  for (int i = 0; i < *rc::gen::inRange(1, 5); ++i) {
    const auto number = [] { return 0.001 * *rc::gen::inRange(-30000, 30000); };
    NewMove move;
    move.feed_ratio = 0.01 * *rc::gen::inRange(50, 200);
    if (*rc::gen::inRange(0, 2) == 0) {
      move.end_mm = {number(), number(), number()};
    } else {
      move.geometry = Geometry::arc;
      move.clockwise = *rc::gen::element(false, true);
      const double radius = 1.0 + std::abs(number());
      const double from = number();
      const double sweep = 0.2 + 0.01 * *rc::gen::inRange(0, 280);
      move.centre_mm = {now[0] - radius * std::cos(from), now[1] - radius * std::sin(from), 0.0};
      const double to = from + (move.clockwise ? -sweep : sweep);
      move.end_mm = {move.centre_mm[0] + radius * std::cos(to),
                     move.centre_mm[1] + radius * std::sin(to), now[2] + 0.1};
    }
    now = move.end_mm;
    moves.push_back(move);
  }
  const BlockText writer(dialect, decimals_of(dialect, block.unit_mm));
  const auto texts = writer.write(block, line, moves, at);
  RC_ASSERT(texts.size() == moves.size());
  std::string program = modes;
  for (const std::string& text : texts) {
    program += text + "\n";
  }
  const auto read = moves_read_back(program + "M30\n", dialect);
  RC_ASSERT(read.size() == moves.size() + 1);
  const int decimals = decimals_of(dialect, block.unit_mm);
  const double step = 0.9 * std::pow(10.0, -decimals) * block.unit_mm;
  for (std::size_t i = 0; i < moves.size(); ++i) {
    const interpret::Move& m = read[i + 1];
    const NewMove& wanted = moves[i];
    const interpret::Axes end = machine_of(m, m.end);
    RC_ASSERT(math::geometry::distance({end[0], end[1], end[2]}, wanted.end_mm) < step);
    RC_ASSERT(std::abs(m.feed_mm_s * 60.0 / block.unit_mm - 30.0 * wanted.feed_ratio) < 1e-3);
    const bool arc = wanted.geometry == Geometry::arc;
    RC_ASSERT((m.kind == interpret::MoveKind::arc) == arc);
    if (arc) {
      RC_ASSERT(std::hypot(m.centre_mm[0] - wanted.centre_mm[0],
                           m.centre_mm[1] - wanted.centre_mm[1]) < 2.0 * step);
      RC_ASSERT(m.turns == (wanted.clockwise ? -1 : 1));
    }
  }
  const interpret::Axes last = machine_of(read.back(), read.back().end);
  RC_ASSERT(math::geometry::distance({last[0], last[1], last[2]}, at) < 1e-9);
}

// In the other position of the switch it would be another block, until X, Y and Z, the motion or
// the feed that the skipped line gave are given again.
TEST(CutBlocks, WhatFollowsASkippableLineStays) {
  const Workshop shop;
  const auto found = blocks_of(shop,
                               "G21 G90 G94 G17 G64\n"
                               "G0 X0 Y0 Z1\n"
                               "G1 X5 F100\n"      // 3
                               "/G1 X8\n"          // 4
                               "Y2\n"              // 5 X from 4
                               "G3 X20 Y20 R20\n"  // 6 begins at the X of 4
                               "G1 X0\n"           // 7
                               "/F200\n"           // 8
                               "X1\n"              // 9 feed of 8
                               "X2 F300\n"         // 10
                               "/M8\n"             // 11 no matter
                               "X3\n"              // 12
                               "/G91\n"            // 13
                               "G90 G1 X4\n"       // 14
                               "G1 X5\n"           // 15 never known again
                               "M2\n");
  EXPECT_EQ(stays(found),
            (std::vector<std::pair<std::uint32_t, Stays>>{{3, Stays::free},
                                                          {4, Stays::switchable},
                                                          {5, Stays::after_switch},
                                                          {6, Stays::after_switch},
                                                          {7, Stays::free},
                                                          {9, Stays::after_switch},
                                                          {10, Stays::free},
                                                          {12, Stays::free},
                                                          {14, Stays::more_words},
                                                          {15, Stays::after_switch}}));
}

TEST(CutBlocks, ABlockWithACommentThatTheControlActsOnStays) {
  for (const char* comment :
       {"(MSG,on)", "( msg , on)", "(PROBEOPEN a.txt)", "(LOGCLOSE)", ";py,x"}) {
    EXPECT_FALSE(active_comment(Dialect::linuxcnc, std::string("G1 X5 ") + comment).empty());
    EXPECT_TRUE(active_comment(Dialect::fanuc, std::string("G1 X5 ") + comment).empty());
  }
  EXPECT_EQ(active_comment(Dialect::linuxcnc, "G1 X5 (message) (log book) (log,x)"), "LOG");
  EXPECT_EQ(active_comment(Dialect::linuxcnc, "G1 X5 (message, of the tool)"), "");
  const Workshop shop;
  const auto found =
      blocks_of(shop, "G21 G90 G94\nG0 X0\nG1 X5 F100\nX6 (LOG, x)\nX7 (the log)\nM2\n");
  EXPECT_EQ(stays(found), (std::vector<std::pair<std::uint32_t, Stays>>{
                              {3, Stays::free}, {4, Stays::more_words}, {5, Stays::free}}));
}

TEST(BlockText, KeepsAllDigitsOfTheBlocksOwnEnd) {
  const Workshop shop;
  const auto found = blocks_of(shop,
                               "G21 G90 G17 G64 F300\n"
                               "G0 X-14.372598 Y15.985548 Z21.805119\n"
                               "G1 X-15.372598 Y18.485548 Z18.3\n"
                               "G2 I0 J-8\n"
                               "M2\n");
  const CutBlock& block = found.blocks.front();
  Point at = block.start_mm;
  const Point between = {-15.0, 17.1234567, 20.0};
  const BlockText writer(Dialect::linuxcnc, decimals_of(Dialect::linuxcnc, 1.0));
  const std::vector<NewMove> moves = {
      {.geometry = Geometry::line, .end_mm = between, .feed_ratio = 0.5},
      {.geometry = Geometry::line, .end_mm = block.end_mm, .feed_ratio = 1.0}};
  EXPECT_EQ(writer.write(block, "", moves, at),
            (std::vector<std::string>{"G1 X-15.0 Y17.12346 Z20.0 F150.0",
                                      "G1 X-15.372598 Y18.485548 Z18.3 F300.0"}));
  EXPECT_EQ(at, block.end_mm);
}

TEST(BlockText, ChangesTheFeedAlone) {
  const Workshop shop;
  const auto found = blocks_of(shop, "G21 G90\nG0 X0\nG1 X5 F100\nM2\n");
  ASSERT_EQ(found.blocks.size(), 1U);
  const CutBlock& block = found.blocks[0];
  const BlockText writer(Dialect::linuxcnc, 5);
  EXPECT_EQ(writer.with_feed(block, "N10 G1 X5 F100 (F 3)", 0.5), "N10 G1 X5 F50.0 (F 3)");
  EXPECT_EQ(writer.with_feed(block, "G1 (F9) f 100.0 X5", 0.725), "G1 (F9) F72.5 X5");
  EXPECT_EQ(writer.with_feed(block, "X5 Y2", 0.5), "X5 Y2 F50.0");
  EXPECT_EQ(writer.with_feed(block, "X5  ; F is above", 0.5), "X5 F50.0  ; F is above");
  const BlockText sinumerik(Dialect::sinumerik, 4);
  EXPECT_EQ(sinumerik.with_feed(block, "G1 X=AC(5) F=100 ;F", 0.5), "G1 X=AC(5) F50.0 ;F");
}

TEST(BlockText, RestoresWhatTheNextBlockTakesOver) {
  const Workshop shop;
  const auto found = blocks_of(shop,
                               "G21 G90\nG0 X0\nG1 X5 F100\nX6 (takes both)\nG0 X0\n"
                               "G1 X7 F100\nG0 X0\nM2\n");
  ASSERT_EQ(found.blocks.size(), 3U);
  const BlockText writer(Dialect::linuxcnc, 5);
  const std::vector<NewMove> arc = {{.geometry = Geometry::arc, .feed_ratio = 1.1}};
  EXPECT_EQ(writer.restore(found.blocks[0], arc), "G1 F100.0");
  EXPECT_EQ(writer.restore(found.blocks[2], arc), "");
}

}  // namespace
}  // namespace steadyrest::nc::rewrite
