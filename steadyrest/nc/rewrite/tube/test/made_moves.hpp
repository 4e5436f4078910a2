// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include <steadyrest/kernel/signal/path.hpp>
#include <steadyrest/nc/interpret/state/move.hpp>

namespace steadyrest::nc::rewrite::test {

/// A feed move in coordinates that are the machine's, as long as it is given no offset.
inline interpret::Move made_line(const kernel::signal::Point& from, const kernel::signal::Point& to,
                                 double feed_mm_s = 10.0) {
  interpret::Move move;
  move.kind = interpret::MoveKind::linear;
  for (std::size_t i = 0; i < 3; ++i) {
    move.start[i] = from[i];
    move.end[i] = to[i];
  }
  move.feed_mm_s = feed_mm_s;
  return move;
}

/// An arc in the XY plane; `turns` as in interpret::Move.
inline interpret::Move made_arc(const kernel::signal::Point& from, const kernel::signal::Point& to,
                                const kernel::signal::Point& centre, int turns) {
  interpret::Move move = made_line(from, to);
  move.kind = interpret::MoveKind::arc;
  move.centre_mm = centre;
  move.normal = {0.0, 0.0, 1.0};
  move.turns = turns;
  return move;
}

/// The move of this line of its program.
inline interpret::Move at_line(std::uint32_t line, interpret::Move move) {
  move.line = line;
  return move;
}

}  // namespace steadyrest::nc::rewrite::test
