// SPDX-License-Identifier: Apache-2.0
// Where the blocks around the pieces are: those that stay, and those that go with the command.
#include <cstddef>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/contour/offline/predistort/test/text/written_program.hpp>

namespace steadyrest::contour::offline {
namespace {

using test::expect_in_order;
using test::WrittenProgram;

// Each block is longer than anything is moved by. The last is commanded from 62 mm on; that is no
// reason for those that stay to be elsewhere.
TEST(ChangedTextAround, OfBlocksThatStayAreTheirOwn) {
  const WrittenProgram program("G0 X10 Y0\nG1 X30 F1200 M8\nX60 M9\nX90\nG0 Z5\n");
  auto pieces = program.own_pieces();
  ASSERT_EQ(pieces.size(), 1U);
  pieces[0].progress_start_mm = 62.0;
  const auto changed = program.with(pieces);
  ASSERT_TRUE(changed.has_value());
  expect_in_order(*changed, program.length_mm());
  EXPECT_NEAR(changed->start_mm[1], 10.0, 1e-9);
  EXPECT_NEAR(changed->start_mm[2], 30.0, 1e-9);
  EXPECT_NEAR(changed->start_mm[3], 62.0, 1e-9);
  EXPECT_NEAR(changed->start_mm[4], 90.0, 1e-9);
}

// A square of 2 mm, its corners rounded, run three times: each of its lines has several segments of
// the original, a few millimetres apart.
TEST(ChangedTextAround, OfBlocksThatAreRunAgainAreThoseOfTheirTurn) {
  const WrittenProgram program(
      "G64 P0.1\nG0 X0 Y0\nO100 sub\nG1 X2 F1200\nY2\nX0\nY0\nO100 endsub\n"
      "O100 call\nO100 call\nO100 call\nG0 Z5\n");
  const auto changed = program.with({});
  ASSERT_TRUE(changed.has_value());
  ASSERT_GT(program.path.segments.size(), 20U) << "not rounded";
  ASSERT_EQ(changed->start_mm.size(), program.path.segments.size());
  for (std::size_t i = 0; i < program.path.segments.size(); ++i) {
    EXPECT_NEAR(changed->start_mm[i], program.path.segments[i].position_mm, 1e-9) << i;
  }
}

// Behind a block whose command goes beyond X30, X30 once more would go back.
TEST(ChangedTextAround, ABlockThatRepeatsAPointGoesWithTheCommand) {
  const WrittenProgram program("G0 X10 Y0\nG1 X30 F1200\nG1 X30\nG1 X50\nG0 Z5\n");
  auto pieces = program.own_pieces();
  ASSERT_EQ(pieces.size(), 2U);
  pieces[0].segment.end_mm[0] = pieces[1].segment.start_mm[0] = 30.8;
  const auto changed = program.with(pieces);
  ASSERT_TRUE(changed.has_value());
  EXPECT_EQ(changed->replaced.replaced, 3U);
  expect_in_order(*changed, program.length_mm());
  for (std::size_t i = 1; i < changed->path.segments.size(); ++i) {
    EXPECT_GE(changed->path.segments[i].end_mm[0], changed->path.segments[i - 1].end_mm[0]);
  }
}

// Before a block that changes, one whose pieces would change nothing, and one that has none; not
// before one that must stay.
TEST(ChangedTextAround, WaitsAreTheFirstLineInPlaceOfABlock) {
  WrittenProgram program(
      "G0 X10 Y0\nG1 X30 F1200\nG0 Y5\nG1 X10\nG0 Y10\nG1 X30\nG0 Y15\nG1 X10 M8\nG0 Z5\n");
  program.waits = {{3, 0.1}, {5, 0.2}, {7, 0.3}, {9, 0.4}};
  auto pieces = program.own_pieces();
  ASSERT_EQ(pieces.size(), 3U);
  pieces.pop_back();
  pieces[0].segment.end_mm[0] = 30.5;
  pieces[1].begins_run = true;
  const auto changed = program.with(pieces);
  ASSERT_TRUE(changed.has_value());
  ASSERT_EQ(changed->lines.size(), 3U);
  EXPECT_EQ(changed->lines.at(3).size(), 2U);
  EXPECT_EQ(changed->lines.at(3)[0], "G4 P0.10");
  EXPECT_EQ(changed->lines.at(5), (std::vector<std::string>{"G4 P0.20", "G1 X10"}));
  EXPECT_EQ(changed->lines.at(7), (std::vector<std::string>{"G4 P0.30", "G1 X30"}));
  expect_in_order(*changed, program.length_mm());
  for (std::size_t i = 2; i < program.path.segments.size(); ++i) {
    EXPECT_NEAR(changed->start_mm[i], program.path.segments[i].position_mm, 1e-9) << i;
  }
}

}  // namespace
}  // namespace steadyrest::contour::offline
