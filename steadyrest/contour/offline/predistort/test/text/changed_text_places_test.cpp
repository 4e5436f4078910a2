// SPDX-License-Identifier: Apache-2.0
// Which stretch of the original the segments of pieces are for, and what cannot be written.
#include <numbers>

#include <gtest/gtest.h>

#include <steadyrest/contour/offline/predistort/test/text/written_program.hpp>
#include <steadyrest/math/geometry/vector.hpp>

namespace steadyrest::contour::offline {
namespace {

using test::expect_in_order;
using test::WrittenProgram;

// Half a circle, half a millimetre wider, is still that of 10π mm.
TEST(ChangedTextPlaces, OfAWiderArcAreThoseOfTheOriginal) {
  const WrittenProgram program("G0 X10 Y-20\nG1 Y0 F1200\nG3 X-10 Y0 I-10 J0\nG1 Y-20\nG0 Z5\n");
  auto pieces = program.own_pieces();
  ASSERT_EQ(pieces.size(), 3U);
  pieces[0].segment.end_mm[0] = 10.5;
  pieces[1].segment =
      arc_from_tangent(nc::interpret::Plane::xy, {10.5, 0, 0}, {0, 1, 0}, {-10.5, 0, 0}).value();
  pieces[1].segment.line = 4;
  pieces[1].segment.feed_mm_s = 20.0;
  pieces[2].segment.start_mm[0] = -10.5;
  const auto changed = program.with(pieces);
  ASSERT_TRUE(changed.has_value());
  expect_in_order(*changed, program.length_mm());
  ASSERT_EQ(changed->path.segments.size(), program.path.segments.size());
  EXPECT_NEAR(changed->path.segments[2].length_mm, 10.5 * std::numbers::pi, 1e-3);
  EXPECT_NEAR(changed->end_mm[2] - changed->start_mm[2], 10.0 * std::numbers::pi, 1e-3);
  EXPECT_NEAR(changed->start_mm[3], program.path.segments[3].position_mm, 1e-9);
}

// The first piece is commanded for the first 12 mm of a block of 20 mm, whatever its own length.
TEST(ChangedTextPlaces, OfPiecesAreAsTheySay) {
  const WrittenProgram program("G0 X10 Y0\nG1 X30 F1200\nG0 Z5\n");
  auto pieces = program.own_pieces();
  pieces.push_back(part_of(pieces[0], 0.25, 1.0));
  pieces[0] = part_of(pieces[0], 0.0, 0.25);
  pieces[0].progress_end_mm = pieces[1].progress_start_mm = 22.0;
  pieces[1].begins_run = false;
  pieces[1].segment.feed_mm_s *= 0.9;
  const auto changed = program.with(pieces);
  ASSERT_TRUE(changed.has_value());
  expect_in_order(*changed, program.length_mm());
  ASSERT_EQ(changed->path.segments.size(), 4U);
  EXPECT_NEAR(changed->path.segments[1].length_mm, 5.0, 1e-9);
  EXPECT_NEAR(changed->start_mm[1], 10.0, 1e-9);
  EXPECT_NEAR(changed->start_mm[2], 22.0, 1e-9);
}

TEST(ChangedTextPlaces, WhatThePlannerRefusesIsRefused) {
  const WrittenProgram program("G0 X10 Y0\nG1 X30 F1200\n");
  auto pieces = program.own_pieces();
  pieces[0].segment.feed_mm_s = 0.0;
  EXPECT_FALSE(program.with(pieces).has_value());
}

}  // namespace
}  // namespace steadyrest::contour::offline
