// SPDX-License-Identifier: Apache-2.0
// The blocks that are written, as a machinist would write them for the change.
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/contour/offline/predistort/test/text/written_program.hpp>

namespace steadyrest::contour::offline {
namespace {

using test::WrittenProgram;

/// The lines of the changed program that came in place of one of the original.
std::vector<std::string> new_lines_of(const Changed& changed, std::uint32_t line) {
  std::vector<std::string> out;
  std::size_t number = 1;
  std::string text;
  for (const char c : changed.replaced.text) {
    if (c != '\n') {
      text += c;
      continue;
    }
    if (changed.replaced.origin[number++] == line && !text.starts_with(';')) {
      out.push_back(text.substr(0, text.find(" ;")));
    }
    text.clear();
  }
  return out;
}

using NewTexts = std::vector<std::string>;

TEST(ChangedTextBlocks, EachPieceIsABlockWithItsFeed) {
  const WrittenProgram program("G0 X10 Y0\nG1 X30 F1200\nG0 Z5\n");
  auto pieces = program.own_pieces();
  ASSERT_EQ(pieces.size(), 1U);
  pieces.push_back(part_of(pieces[0], 0.25, 1.0));
  pieces[0] = part_of(pieces[0], 0.0, 0.25);
  pieces[1].begins_run = false;
  pieces[1].segment.feed_mm_s *= 0.5;
  const auto changed = program.with(pieces);
  ASSERT_TRUE(changed.has_value());
  EXPECT_EQ(new_lines_of(*changed, 3), (NewTexts{"G1 X15.0 F1200.0", "G1 X30.0 F600.0"}));
}

// The block behind says neither G1 nor F: an arc in place of the line must not become its motion.
TEST(ChangedTextBlocks, MotionAndFeedAreAsTheyWereForABlockThatStays) {
  const WrittenProgram program("G0 X10 Y0\nG1 X30 F1200\nX40 M8\n");
  auto pieces = program.own_pieces();
  ASSERT_EQ(pieces.size(), 1U);
  pieces[0].segment =
      arc_from_tangent(nc::interpret::Plane::xy, {10, 0, 0}, {1, 0.5, 0}, {30, 0, 0}).value();
  pieces[0].segment.line = 3;
  pieces[0].segment.feed_mm_s = 10.0;
  const auto changed = program.with(pieces);
  ASSERT_TRUE(changed.has_value());
  const NewTexts lines = new_lines_of(*changed, 3);
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_TRUE(lines[0].starts_with("G2 X30.0 Y0.0 I10.0 J-20.0 F600.0")) << lines[0];
  EXPECT_EQ(lines[1], "G1 F1200.0");
  const auto& last = changed->path.segments.back();
  EXPECT_EQ(last.geometry, kernel::signal::Geometry::line);
  EXPECT_NEAR(last.feed_mm_s, 20.0, 1e-9);
}

}  // namespace
}  // namespace steadyrest::contour::offline
