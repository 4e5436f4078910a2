// SPDX-License-Identifier: Apache-2.0
// Moves written in a turned and shifted work offset. Truth: the interpreter, which reads the text
// again.
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <steadyrest/math/geometry/vector.hpp>
#include <steadyrest/nc/rewrite/replace/block_text.hpp>
#include <steadyrest/nc/rewrite/replace/test/read_back.hpp>

namespace steadyrest::nc::rewrite {
namespace {

using kernel::signal::Point;
using read::Dialect;
using test::blocks_of;
using test::moves_read_back;
using test::quarter_from;
using test::Workshop;
using test::xyz_of;

constexpr double kTurnedDigit_mm = 1e-5;

// The work is turned about Z and shifted: what is meant is a place of the machine.
RC_GTEST_PROP(BlockText, AMoveGoesToItsPlaceInATurnedOffset, ()) {
  const int angle_deg = *rc::gen::inRange(-180, 180);
  const std::string modes = "G21 G17 G94 F300\nG10 L2 P1 X10 Y-20 Z5 R" +
                            std::to_string(angle_deg) + "\nG54 G90\nG0 X3 Y4 Z5\n" +
                            *rc::gen::element("G90\n", "G91\n");
  const Workshop shop;
  const CutBlocks found = blocks_of(shop, modes + "G1 X4\nM2\n");
  const CutBlock& block = found.blocks.at(0);
  const auto random_mm = [] { return 0.001 * *rc::gen::inRange(-50'000, 50'000); };
  const NewMove line{.end_mm = {random_mm(), random_mm(), random_mm()}};
  const NewMove arc = quarter_from(line.end_mm, 0, 1, 7.5, true);
  const std::vector<NewMove> moves = {line, arc};
  Point at = block.start_mm;
  std::string text;
  for (const auto& one : BlockText(Dialect::linuxcnc, 5).write(block, "", moves, at)) {
    text += one + "\n";
  }
  const auto read = moves_read_back(modes + text + "M2\n", Dialect::linuxcnc);
  RC_ASSERT(read.size() == 3U);
  for (std::size_t i = 0; i < moves.size(); ++i) {
    const Point end = xyz_of(machine_of(read[i + 1], read[i + 1].end));
    RC_ASSERT(math::geometry::distance(end, moves[i].end_mm) < kTurnedDigit_mm);
  }
  const auto& c = read[2].centre_mm;
  const Point centre = xyz_of(machine_of(read[2], {c[0], c[1], c[2]}));
  RC_ASSERT(math::geometry::distance(centre, arc.centre_mm) < 2.0 * kTurnedDigit_mm);
}

}  // namespace
}  // namespace steadyrest::nc::rewrite
