// SPDX-License-Identifier: Apache-2.0
// Pieces written into a program and planned again: where nothing is changed the path is its own.
#include <cstddef>
#include <string>

#include <gtest/gtest.h>

#include <steadyrest/contour/offline/predistort/test/text/written_program.hpp>
#include <steadyrest/math/geometry/vector.hpp>

namespace steadyrest::contour::offline {
namespace {

namespace geometry = math::geometry;
using test::WrittenProgram;

TEST(ChangedText, WithThePathsOwnPiecesIsTheProgram) {
  const WrittenProgram program(
      "G0 X10 Y0\nG1 Y20 F1200\nG3 X0 Y30 I-10 J0\nG1 X-20 Z-3\nG2 X-20 Y20 I0 J-5\n");
  const auto changed = program.with(program.own_pieces());
  ASSERT_TRUE(changed.has_value());
  EXPECT_EQ(changed->replaced.replaced, 0U);
  ASSERT_EQ(changed->path.segments.size(), program.path.segments.size());
  for (std::size_t i = 0; i < program.path.segments.size(); ++i) {
    const auto& was = program.path.segments[i];
    const auto& is = changed->path.segments[i];
    EXPECT_LT(geometry::distance(is.end_mm, was.end_mm), 1e-4);
    EXPECT_NEAR(is.length_mm, was.length_mm, 1e-4);
    EXPECT_NEAR(is.feed_mm_s, was.feed_mm_s, 1e-6);
    EXPECT_NEAR(changed->start_mm[i], was.position_mm, 1e-4);
    EXPECT_NEAR(changed->end_mm[i], was.position_mm + was.length_mm, 1e-4);
  }
}

// X50 takes its F from the block before, so it has to say what it was; the others need nothing.
TEST(ChangedText, LeavesBlocksThatDoNotChange) {
  const WrittenProgram program("G0 X10 Y0\nG1 X30 F1200\nX50\nG1 X70 F1200.0\nG1 X90\nG0 Z5\n");
  auto pieces = program.own_pieces();
  ASSERT_EQ(pieces.size(), 4U);
  pieces[0].segment.feed_mm_s *= 0.5;
  pieces[2].progress_start_mm += 0.25;
  const auto changed = program.with(pieces);
  ASSERT_TRUE(changed.has_value());
  EXPECT_TRUE(changed->lines.contains(3));
  EXPECT_TRUE(changed->lines.contains(4));
  EXPECT_EQ(changed->lines.size(), 2U);
  EXPECT_NE(changed->replaced.text.find("\nG1 X70 F1200.0\nG1 X90\n"), std::string::npos);
  EXPECT_NEAR(changed->start_mm[3], pieces[2].progress_start_mm, 1e-9) << "its piece's place";
}

TEST(ChangedText, WithoutPiecesIsTheProgram) {
  const WrittenProgram program(
      "G0 X10 Y0\nO100 sub\nG1 X20 F1200\nG1 X10\nO100 endsub\nO100 call\nO100 call\nG1 Y9\n");
  const auto changed = program.with({});
  ASSERT_TRUE(changed.has_value());
  EXPECT_EQ(changed->replaced.replaced, 0U);
  ASSERT_EQ(changed->start_mm.size(), program.path.segments.size());
  // Blocks that are run twice cover two stretches, one after the other.
  for (std::size_t i = 0; i < program.path.segments.size(); ++i) {
    EXPECT_NEAR(changed->start_mm[i], program.path.segments[i].position_mm, 1e-9) << i;
  }
  EXPECT_NEAR(changed->end_mm.back(), program.length_mm(), 1e-9);
}

}  // namespace
}  // namespace steadyrest::contour::offline
