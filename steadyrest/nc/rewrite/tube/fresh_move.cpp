// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>
#include <string_view>

#include <fmt/core.h>

#include <steadyrest/nc/rewrite/prove/compare.hpp>
#include <steadyrest/nc/rewrite/tube/fresh_move.hpp>

namespace steadyrest::nc::rewrite {

using interpret::Move;
using interpret::MoveKind;

std::string fresh_move_difference(const Permitted& permitted, const Move& block, Move move) {
  if (move.kind != MoveKind::linear && move.kind != MoveKind::arc) {
    return "is a new line that does not cut along a line or an arc";
  }
  if (auto fault = feed_fault(permitted, block, move); !fault.empty()) {
    return fault;
  }
  auto fault = spindle_fault(permitted, block.spindle_rev_s, move.spindle_rev_s);
  if (!fault.empty()) {
    return fault;
  }
  for (std::size_t i = 3; i < move.end.size(); ++i) {
    if (!same(move.start[i], move.end[i]) || !same(move.end[i], block.end[i])) {
      return "moves an axis beyond X, Y and Z";
    }
  }
  if (move.machine_axes != 0 ||
      !std::ranges::equal(move.offset, block.offset,
                          [](double x, double y) { return same(x, y); })) {
    return "differs from the block that it replaces in its offset";
  }
  move.kind = block.kind;
  move.normal = block.normal;
  move.turns = block.turns;
  move.feed_mm_s = block.feed_mm_s;
  move.spindle_rev_s = block.spindle_rev_s;
  const std::string_view other = first_difference(block, move);
  return other.empty() ? std::string{}
                       : fmt::format("differs from the block that it replaces in its {}", other);
}

}  // namespace steadyrest::nc::rewrite
