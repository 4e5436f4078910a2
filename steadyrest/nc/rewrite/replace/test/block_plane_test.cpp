// SPDX-License-Identifier: Apache-2.0
// Arcs written in any plane with either kind of centre. Truth: the interpreter, which reads the
// text again.
#include <array>
#include <string>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <steadyrest/math/geometry/vector.hpp>
#include <steadyrest/nc/rewrite/replace/block_text.hpp>
#include <steadyrest/nc/rewrite/replace/test/read_back.hpp>

namespace steadyrest::nc::rewrite {
namespace {

namespace geometry = math::geometry;
using kernel::signal::Point;
using read::Dialect;
using test::blocks_of;
using test::moves_read_back;
using test::quarter_from;
using test::Workshop;
using test::xyz_of;

constexpr int kDigits = 5;
constexpr double kLastDigit_mm = 1e-5;

/// A plane: its word, and the axes that it spans, right-handed.
struct NamedPlane {
  const char* word;
  std::size_t first;
  std::size_t second;
};
constexpr std::array kPlanes = {NamedPlane{"G17", 0, 1}, NamedPlane{"G18", 2, 0},
                                NamedPlane{"G19", 1, 2}};

RC_GTEST_PROP(BlockText, AnArcIsReadInItsPlane, ()) {
  const NamedPlane plane = kPlanes.at(*rc::gen::inRange<std::size_t>(0, kPlanes.size()));
  const bool clockwise = *rc::gen::arbitrary<bool>();
  const double radius_mm = 0.001 * *rc::gen::inRange(100, 50'000);
  const std::string modes = std::string(plane.word) + *rc::gen::element(" G90.1", " G91.1") +
                            *rc::gen::element(" G90", " G91") + " G21 G94 F300 G54\n";
  const Workshop shop;
  const CutBlocks found = blocks_of(shop, modes + "G0 X3 Y4 Z5\nG1 X4\nM2\n");
  const CutBlock& block = found.blocks.at(0);
  const NewMove wanted =
      quarter_from(block.start_mm, plane.first, plane.second, radius_mm, clockwise);
  Point at = block.start_mm;
  const auto texts = BlockText(Dialect::linuxcnc, kDigits).write(block, "", {&wanted, 1}, at);
  RC_ASSERT(texts.size() == 1U);
  const auto read =
      moves_read_back(modes + "G0 X3 Y4 Z5\n" + texts[0] + "\nM2\n", Dialect::linuxcnc);
  RC_ASSERT(read.size() == 2U);
  const interpret::Move& arc = read[1];
  RC_ASSERT(arc.kind == interpret::MoveKind::arc);
  RC_ASSERT(arc.turns == (clockwise ? -1 : 1));
  RC_ASSERT(arc.normal[3 - plane.first - plane.second] == 1.0);
  RC_ASSERT(geometry::distance(xyz_of(arc.end), wanted.end_mm) < kLastDigit_mm);
  RC_ASSERT(geometry::distance(arc.centre_mm, wanted.centre_mm) < kLastDigit_mm);
}

}  // namespace
}  // namespace steadyrest::nc::rewrite
