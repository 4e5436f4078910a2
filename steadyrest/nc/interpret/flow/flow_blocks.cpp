// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <string>

#include <steadyrest/nc/interpret/flow/flow_control.hpp>

// Conditions and loops: if, while, do, repeat, break and continue.
namespace steadyrest::nc::interpret {

using read::Block;
using read::FlowKind;

// A label heads one block of its subprogram.
bool FlowControl::define(const Block& block) {
  // A label belongs to one subprogram of one file: the same label may head a block in another. A
  // loop returns to the same line, which is not a second head.
  const std::string key = frames_.back().sub + '\n' + std::to_string(files_.line_begin().file) +
                          '\n' + std::string{block.flow().label.view()};
  const auto [known, fresh] = heads_.try_emplace(key, files_.line_begin());
  return fresh || known->second.line == files_.line_begin().line ||
         refuse(block.line(), block.flow().label.view(), "o_word_twice",
                "this label already heads another block, in line " +
                    std::to_string(known->second.line + 1));
}

// Open blocks belong to the frame: a return leaves them all at once.
bool FlowControl::open(const Block& block, const Place& head) {
  if (!define(block)) {
    return false;
  }
  frames_.back().open.push_back(
      {.kind = block.flow().kind, .label = std::string{block.flow().label.view()}, .head = head});
  return true;
}

bool FlowControl::condition(const Block& block) {
  if (!open(block, files_.line_begin())) {
    return false;
  }
  // The reader has already evaluated the condition; 0 is false, anything else true, as in LinuxCNC.
  if (block.flow().values[0] == 0.0) {
    pass(Passing::to_else, block.flow().label.view());
  }
  return true;
}

// Reached while executing: the branch taken ends here.
bool FlowControl::otherwise(const Block& block) {
  const Open* const found = find(block, false);
  if (found == nullptr || found->kind != FlowKind::when) {
    return refuse(block.line(), block.flow().label.view(), "o_word_unmatched",
                  "elseif or else without its if");
  }
  pass(Passing::to_endif, block.flow().label.view());
  return true;
}

// An end must match the innermost open block in label and kind.
bool FlowControl::close(const Block& block, FlowKind head) {
  const Open* const found = find(block, false);
  if (found == nullptr || found->kind != head) {
    return refuse(block.line(), block.flow().label.view(), "o_word_unmatched",
                  "an end without its beginning");
  }
  drop_to(*found);
  return true;
}

// `while` is two words: the head of a while loop and, with the label of an open `do`, its foot.
bool FlowControl::head_of_while(const Block& block) {
  const bool goes_on = block.flow().values[0] != 0.0;
  const Open* const found = find(block, true);
  if (found != nullptr && found->kind == FlowKind::loop_do) {
    if (goes_on) {
      const Place head = found->head;
      // Blocks left open by the turn end with it; the do loop itself stays.
      frames_.back().open.resize(static_cast<std::size_t>(found - frames_.back().open.data()) + 1);
      return go(block.line(), head);
    }
    drop_to(*found);
    return true;
  }
  if (!goes_on) {
    if (!define(block)) {
      return false;
    }
    pass(Passing::to_endwhile, block.flow().label.view());
    return true;
  }
  return open(block, files_.line_begin());
}

/// The end of a `while` or `repeat`: back to its head.
bool FlowControl::end_of_turn(const Block& block, FlowKind loop, std::string_view unmatched) {
  const Open* const found = find(block, false);
  if (found == nullptr || found->kind != loop) {
    return refuse(block.line(), block.flow().label.view(), "o_word_unmatched", unmatched);
  }
  // The head evaluates its condition again, and opens the loop again if it holds.
  const Place head = found->head;
  drop_to(*found);
  return go(block.line(), head);
}

// LinuxCNC resets the count only at the end of the last turn: after a return, break or continue out
// of the loop, and in a call within it, the remaining turns continue.
bool FlowControl::head_of_repeat(const Block& block) {
  const Place head = files_.line_begin();
  const auto left =
      turns_left_.try_emplace({head.file, head.line}, std::round(block.flow().values[0])).first;
  if (left->second >= 1.0) {
    left->second -= 1.0;
    return open(block, head);
  }
  turns_left_.erase(left);
  if (!define(block)) {
    return false;
  }
  pass(Passing::to_endrepeat, block.flow().label.view());
  return true;
}

// `break` skips the rest of the loop, in a do loop up to its `while`. In LinuxCNC 2.9 a repeat has
// neither break nor continue.
bool FlowControl::leave_loop(const Block& block) {
  const Open* const found = find(block, true);
  if (found == nullptr || found->kind == FlowKind::repeat) {
    return refuse(block.line(), block.flow().label.view(), "o_word_unmatched",
                  "break outside its while or do loop (a repeat has none)");
  }
  pass(found->kind == FlowKind::loop_do ? Passing::to_while : Passing::to_endwhile,
       block.flow().label.view());
  drop_to(*found);
  return true;
}

bool FlowControl::next_turn(const Block& block) {
  const Open* const found = find(block, true);
  if (found == nullptr || found->kind == FlowKind::repeat) {
    return refuse(block.line(), block.flow().label.view(), "o_word_unmatched",
                  "continue outside its while or do loop (a repeat has none)");
  }
  // In a do loop `continue` goes forward to the `while`, where the condition is; in a while loop it
  // goes back to the head.
  if (found->kind == FlowKind::loop_do) {
    frames_.back().open.resize(static_cast<std::size_t>(found - frames_.back().open.data()) + 1);
    pass(Passing::to_condition, block.flow().label.view());
    return true;
  }
  const Place head = found->head;
  drop_to(*found);
  return go(block.line(), head);
}

}  // namespace steadyrest::nc::interpret
