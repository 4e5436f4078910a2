// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
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
  if (block.flow().unknown != 0) {
    doubt(frames_.back().open.back());
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

bool FlowControl::in_doubt(const Frame& frame) noexcept {
  return frame.doubtful || frame.doubt_to != 0 || std::ranges::any_of(frame.open, &Open::doubtful);
}

bool FlowControl::in_doubt() const noexcept {
  return any_doubt_ && ((passing_over() && passing_in_doubt_) ||
                        std::ranges::any_of(frames_, [](const Frame& f) { return in_doubt(f); }));
}

void FlowControl::doubt(Open& open) noexcept {
  open.doubtful = true;
  any_doubt_ = true;
}

// What the rest of the turn, or further turns, would set is not seen.
void FlowControl::leave_in_doubt(Open* loop) noexcept {
  lose(Lost::all);
  if (loop != nullptr) {
    doubt(*loop);
    loop->left = true;
  }
}

// `while` is two words: the head of a while loop and, with the label of an open `do`, its foot.
bool FlowControl::head_of_while(const Block& block) {
  const bool goes_on = block.flow().values[0] != 0.0;
  const bool unknown = block.flow().unknown != 0;
  Open* const found = find(block, true);
  if (found != nullptr && found->kind == FlowKind::loop_do) {
    if (unknown) {
      lose(Lost::turn);
      doubt(*found);
    }
    if (goes_on && after_break_) {
      return refuse(block.line(), block.flow().label.view(), "loop_after_break",
                    "a do loop after a break out of a while loop: LinuxCNC 2.9 leaves it after its "
                    "first turn; end the while loop by its condition");
    }
    after_break_ = false;
    if (goes_on) {
      const Place head = found->head;
      // Blocks left open by the turn end with it; the do loop itself stays.
      frames_.back().open.resize(static_cast<std::size_t>(found - frames_.back().open.data()) + 1);
      return go(block.line(), head);
    }
    drop_to(*found);
    return true;
  }
  after_continue_ = false;
  if (!goes_on) {
    if (!define(block)) {
      return false;
    }
    pass(Passing::to_endwhile, block.flow().label.view());
    pass_in_doubt(unknown);
    return true;
  }
  return open_loop(block, unknown);
}

bool FlowControl::open_loop(const Block& block, bool unknown) {
  const Place head = files_.line_begin();
  if (!open(block, head)) {
    return false;
  }
  Frame& frame = frames_.back();
  frame.open.back().left = std::erase(frame.left_heads, head.line) != 0;
  if (unknown || frame.open.back().left) {
    doubt(frame.open.back());
  }
  return true;
}

void FlowControl::pass_in_doubt(bool unknown) noexcept {
  passing_in_doubt_ = unknown;
  any_doubt_ = any_doubt_ || unknown;
}

/// The end of a `while` or `repeat`: back to its head.
bool FlowControl::end_of_turn(const Block& block, FlowKind loop, std::string_view unmatched) {
  const Open* const found = find(block, false);
  if (found == nullptr || found->kind != loop) {
    return refuse(block.line(), block.flow().label.view(), "o_word_unmatched", unmatched);
  }
  // The head evaluates its condition again, and opens the loop again if it holds.
  const Place head = found->head;
  if (found->left) {
    frames_.back().left_heads.push_back(head.line);
  }
  drop_to(*found);
  return go(block.line(), head);
}

// LinuxCNC resets the count only at the end of the last turn: after a return, break or continue out
// of the loop, and in a call within it, the remaining turns continue.
bool FlowControl::head_of_repeat(const Block& block) {
  if (after_continue_) {
    return refuse(block.line(), block.flow().label.view(), "repeat_after_continue",
                  "a repeat after a continue in a do loop: LinuxCNC 2.9 makes more turns than its "
                  "count; write the do loop without continue, or repeat as a while loop");
  }
  const Place head = files_.line_begin();
  const bool unknown = block.flow().unknown != 0;
  const auto left =
      turns_left_.try_emplace({head.file, head.line}, std::round(block.flow().values[0])).first;
  if (left->second >= 1.0) {
    left->second -= 1.0;
    return open_loop(block, unknown);
  }
  turns_left_.erase(left);
  if (!define(block)) {
    return false;
  }
  pass(Passing::to_endrepeat, block.flow().label.view());
  pass_in_doubt(unknown);
  return true;
}

// `break` skips the rest of the loop, in a do loop up to its `while`. In LinuxCNC 2.9 a repeat has
// neither break nor continue.
bool FlowControl::leave_loop(const Block& block) {
  Open* const found = find(block, true);
  if (found == nullptr || found->kind == FlowKind::repeat) {
    return refuse(block.line(), block.flow().label.view(), "o_word_unmatched",
                  "break outside its while or do loop (a repeat has none)");
  }
  after_break_ = after_break_ || found->kind == FlowKind::loop_while;
  if (in_doubt()) {
    leave_in_doubt(found);
  }
  pass(found->kind == FlowKind::loop_do ? Passing::to_while : Passing::to_endwhile,
       block.flow().label.view());
  drop_to(*found);
  return true;
}

bool FlowControl::next_turn(const Block& block) {
  Open* const found = find(block, true);
  if (found == nullptr || found->kind == FlowKind::repeat) {
    return refuse(block.line(), block.flow().label.view(), "o_word_unmatched",
                  "continue outside its while or do loop (a repeat has none)");
  }
  after_continue_ = after_continue_ || found->kind == FlowKind::loop_do;
  if (in_doubt()) {
    leave_in_doubt(found);
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
