// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>
#include <string_view>

#include <fmt/core.h>

#include <steadyrest/nc/interpret/decode/codes.hpp>
#include <steadyrest/nc/rewrite/prove/compare.hpp>
#include <steadyrest/nc/rewrite/replace/block_words.hpp>
#include <steadyrest/nc/rewrite/tube/fresh_move.hpp>

namespace steadyrest::nc::rewrite {

using interpret::Move;
using interpret::MoveKind;

namespace {

constexpr double kLongestWait_s = 5.0;

/// G4 and its time in seconds, in the words of any control.
bool is_dwell_word(const read::Word& word) {
  constexpr std::string_view kTimes = "PFX";
  return (word.letter == 'G' && interpret::g::code_of(word.value) == interpret::g::kDwell) ||
         (word.letter != 0 && kTimes.find(word.letter) != std::string_view::npos &&
          !is_calculated(word));
}

}  // namespace

std::string words_fault(const read::Block& block) {
  const std::string_view word = word_beyond_a_cut(block);
  return word.empty()
             ? std::string{}
             : fmt::format("holds {}; a new line may hold a line or an arc and its feed alone",
                           word);
}

bool is_wait(const Permitted& permitted, std::span<const Move> moves) noexcept {
  return permitted.dwells && moves.size() == 1 && moves.front().kind == MoveKind::dwell;
}

std::string wait_fault(const read::Block& words, const Move& block, double seconds, bool begins) {
  if (!begins) {
    return "is a dwell that is not between a rapid and the block that it replaces";
  }
  if (words.words().size() != 2 || !std::ranges::all_of(words.words(), is_dwell_word)) {
    return "is a dwell with more words than its time in seconds";
  }
  if (block.feed_mode == interpret::FeedMode::per_revolution) {
    return "is a dwell at feeds per revolution, where a control may count turns";
  }
  return seconds <= kLongestWait_s
             ? std::string{}
             : fmt::format("is a dwell of {} s; {:g} s are allowed", seconds, kLongestWait_s);
}

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
