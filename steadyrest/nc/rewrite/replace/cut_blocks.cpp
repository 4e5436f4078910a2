// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include <steadyrest/kernel/units/convert.hpp>
#include <steadyrest/nc/interpret/program.hpp>
#include <steadyrest/nc/interpret/state/step.hpp>
#include <steadyrest/nc/interpret/state/words.hpp>
#include <steadyrest/nc/rewrite/prove/compare.hpp>
#include <steadyrest/nc/rewrite/replace/block_words.hpp>
#include <steadyrest/nc/rewrite/replace/by_control.hpp>
#include <steadyrest/nc/rewrite/replace/cut_blocks.hpp>
#include <steadyrest/nc/rewrite/replace/survey_program.hpp>
#include <steadyrest/nc/rewrite/text/replaced_text.hpp>
#include <steadyrest/nc/rewrite/text/tag.hpp>
#include <steadyrest/nc/rewrite/walk/kept_moves.hpp>
#include <steadyrest/nc/rewrite/walk/survey.hpp>

namespace steadyrest::nc::rewrite {
namespace {

constexpr std::uint32_t kSpace = 0b111;  ///< X, Y and Z, a mask of axes

using interpret::Move;
using interpret::MoveKind;

bool turns_others(const Move& move) {
  return !std::equal(move.start.begin() + 3, move.start.end(), move.end.begin() + 3);
}

/// What depends on whether the operator lets blocks be skipped (`/`): a block that begins there, or
/// takes its motion, feed or modes from there, is another one in the other position of the switch.
class BySwitch {
 public:
  /// Of a block that can be skipped: notes what it changes.
  void skippable(const std::vector<Move>& moves, const Modes& before, Modes after) noexcept {
    for (const Move& move : moves) {
      for (std::size_t i = 0; i < place_.size(); ++i) {
        place_[i] = place_[i] || move.start[i] != move.end[i];
      }
    }
    motion_ = motion_ || after.motion != before.motion;
    feed_ = feed_ || after.feed_mm_s != before.feed_mm_s;
    after.motion = before.motion;
    after.feed_mm_s = before.feed_mm_s;
    after.spindle_speed_rev_s = before.spindle_speed_rev_s;
    after.spindle_direction = before.spindle_direction;
    after.coolant = before.coolant;
    after.selected_tool = before.selected_tool;
    modes_ = modes_ || after != before;
  }

  /// Of a block that cannot be skipped. Whatever the block states itself no longer depends.
  bool depends(const Says& said, const read::Block& block, bool incremental) noexcept {
    motion_ = motion_ && !said.motion;
    feed_ = feed_ && !said.feed;
    const bool depends = modes_ || motion_ || feed_ || place_[0] || place_[1] || place_[2];
    if (!incremental && !modes_) {
      for (const read::Word& word : block.words()) {
        if (word.letter >= 'X' && word.letter <= 'Z') {
          place_[static_cast<std::size_t>(word.letter - 'X')] = false;
        }
      }
    }
    return depends;
  }

 private:
  std::array<bool, 3> place_{};
  bool motion_ = false;
  bool feed_ = false;
  bool modes_ = false;  ///< for good: what they were is not known again
};

/// G40 without a move leaves the tool beside the contour, and the control accepts no arc until a
/// straight move has taken it there.
class AfterCompensation {
 public:
  /// Of each block once it has been executed.
  void block(const read::Block& block, const std::vector<Move>& moves, bool was_on, bool is_on) {
    if (was_on && !is_on) {
      beside_ = !moves_straight(block);
    } else if (is_on || goes(moves)) {
      beside_ = false;
    }
  }
  /// Of the block at hand, before block(): it has to be straight.
  [[nodiscard]] bool needs_line() const noexcept { return beside_; }

 private:
  static bool goes(const std::vector<Move>& moves) {
    return std::ranges::any_of(moves,
                               [](const Move& move) { return move.kind != MoveKind::dwell; });
  }
  /// The moves of the block with G40 are those that compensation had kept back: its words decide.
  static bool moves_straight(const read::Block& block) {
    constexpr std::string_view kAxes = "XYZABCUVW";
    bool axis = false;
    for (const read::Word& word : block.words()) {
      axis = axis || (word.letter != 0 && kAxes.find(word.letter) != std::string_view::npos);
      if (word.letter == 'G') {
        const int code = interpret::g::code_of(word.value);
        if (code != interpret::g::kCutterOff && code != interpret::g::kRapid &&
            code != interpret::g::kLinear) {
          return false;
        }
      }
    }
    return axis;
  }

  bool beside_ = false;
};

/// Runs a program and notes what cuts.
class CutSurvey {
 public:
  CutSurvey(interpret::ProgramRun& run, KeptMoves& kept, read::Dialect dialect)
      : run_(run), kept_(kept), dialect_(dialect) {}

  void line(std::string_view text) {
    const std::uint32_t number = run_.line();
    const bool main = run_.in_main();
    const bool again = main && number < seen_.size() && seen_[number];
    if (main) {
      marks_.mark(number, seen_, false);
    }
    const Says said = says(run_.block(), dialect_);
    const bool cuts = std::ranges::any_of(kept_.moves, [](const Move& move) {
      return move.kind == MoveKind::linear || move.kind == MoveKind::arc ||
             move.kind == MoveKind::spline;
    });
    // A dwell takes no motion word.
    const bool moves = std::ranges::any_of(
        kept_.moves, [](const Move& move) { return move.kind != MoveKind::dwell; });
    inherit(said, moves || said.keeps, cuts || said.keeps);
    if (run_.doubt().line) {
      hold_last();
    }
    cut_last_ = cut_last_ && !moves;
    used_ |= axes_used(run_.block(), kept_.moves);
    by_switch_now_ = false;
    if (run_.block().deleted()) {
      by_switch_.skippable(kept_.moves, before_, modes_of(run_.state()));
    } else {
      by_switch_now_ = by_switch_.depends(said, run_.block(), run_.state().incremental);
    }
    if (cuts && main && !again && !is_inserted(text)) {
      add(number, said, text);
    }
    const bool was_on = before_.cutter_side != 0;
    before_ = modes_of(run_.state());
    counted_ = run_.state().position;
    after_compensation_.block(run_.block(), kept_.moves, was_on, before_.cutter_side != 0);
    kept_.clear();
  }

  CutBlocks take() {
    for (CutBlock& block : found_.blocks) {
      const bool arc = block.motion != interpret::g::kLinear;
      if (marks_.is_repeated(block.line)) {
        block.stays = Stays::repeated;
      } else if (block.stays == Stays::free && block.inherited && arc) {
        block.stays = Stays::motion_needed;
      }
    }
    found_.assumed = run_.unknown();
    return std::move(found_);
  }

 private:
  void inherit(const Says& said, bool moves, bool cuts) {
    if (found_.blocks.empty()) {
      return;
    }
    CutBlock& last = found_.blocks.back();
    motion_open_ = motion_open_ && !said.motion;
    feed_open_ = feed_open_ && !said.feed;
    last.inherited = last.inherited || (moves && motion_open_);
    last.feed_inherited = last.feed_inherited || (cuts && feed_open_);
  }

  void add(std::uint32_t number, const Says& said, std::string_view text) {
    const interpret::State& state = run_.state();
    const Move& move = kept_.moves.front();
    CutBlock block;
    block.line = number;
    block.motion = state.motion;
    block.feed_mode = state.feed_mode;
    block.feed = block.feed_mode == interpret::FeedMode::per_minute
                     ? kernel::units::mm_min_from_mm_s(state.feed_mm_s) / state.feed_unit_mm
                     : state.feed_mm_s / state.feed_unit_mm;
    block.unit_mm = state.unit_mm;
    block.incremental = state.incremental;
    block.centre_absolute = state.centre_absolute;
    block.plane = state.plane;
    block.rotation_deg = move.rotation_deg;
    block.begins_beside = begins_beside(move);
    const interpret::Axes start = machine_of(move, move.start);
    const interpret::Axes end = machine_of(move, move.end);
    for (std::size_t i = 0; i < 3; ++i) {
      block.offset_mm[i] = move.offset[i];
      block.start_mm[i] = start[i];
      block.end_mm[i] = end[i];
    }
    block.plane_known = plane_known(run_.doubt(), dialect_);
    block.unknown_axes = state.incremental ? 0U : run_.doubt().axes;
    block.stays = judge(said, text);
    found_.blocks.push_back(block);
    motion_open_ = true;
    feed_open_ = true;
    cut_last_ = true;
  }

  /// In another run another line may follow the last block that cuts: it finds the machine, the
  /// motion word and the feed where the original has them.
  void hold_last() {
    if (found_.blocks.empty()) {
      return;
    }
    CutBlock& last = found_.blocks.back();
    last.inherited = true;
    last.feed_inherited = true;
    if (cut_last_ && (takes_feed(last.stays) || last.stays == Stays::after_switch)) {
      last.stays = Stays::before_control;
    }
  }

  /// The machine is elsewhere than the control counts with (MoveOutput::beside).
  [[nodiscard]] bool begins_beside(const Move& move) const noexcept {
    return !std::equal(move.start.begin(), move.start.begin() + 3, counted_.begin(), same);
  }

  Stays judge(const Says& said, std::string_view text) const {
    const interpret::State& state = run_.state();
    const Move& move = kept_.moves.front();
    Modes after = modes_of(state);
    after.motion = before_.motion;
    after.feed_mm_s = before_.feed_mm_s;
    if (!run_.at_top()) {
      return Stays::repeated;
    }
    if (run_.block().deleted()) {
      return Stays::switchable;
    }
    if (state.cutter_side != 0 || before_.cutter_side != 0) {
      return Stays::compensated;
    }
    if (kept_.moves.size() != 1 || (move.kind != MoveKind::linear && move.kind != MoveKind::arc)) {
      return Stays::spline;
    }
    if (said.calculated) {
      return Stays::calculated;
    }
    if (!said.plain || !kept_.events.empty() || after != before_ ||
        !active_comment(dialect_, text).empty()) {
      return Stays::more_words;
    }
    if (state.feed_mode == interpret::FeedMode::inverse_time) {
      return Stays::feed_mode;
    }
    if (state.diameter) {
      return Stays::diameter;
    }
    if (state.text_frame.on || state.polar.on) {
      return Stays::framed;
    }
    if (turns_others(move)) {
      return Stays::rotary;
    }
    if (move.override_locked) {
      return Stays::locked;
    }
    if (too_long_to_keep(dialect_, text)) {
      return Stays::too_long;
    }
    // What comes in its place moves the axes that it moves, in space; the others may be anywhere.
    const std::uint32_t named = (used_ & kSpace) | axes_used(run_.block(), kept_.moves);
    if (depends_on_control(run_.doubt(), state, move, named, dialect_)) {
      return Stays::by_control;
    }
    if (by_switch_now_) {
      return Stays::after_switch;
    }
    if (after_compensation_.needs_line()) {
      return Stays::line_needed;
    }
    return begins_beside(move) ? Stays::beside : Stays::free;
  }

  interpret::ProgramRun& run_;
  KeptMoves& kept_;
  read::Dialect dialect_;
  CutBlocks found_;
  Modes before_;
  interpret::Axes counted_{};  ///< where the control thinks it is, before the block at hand
  BySwitch by_switch_;
  bool by_switch_now_ = false;  ///< of the block at hand
  AfterCompensation after_compensation_;
  Survey marks_;  ///< the lines executed twice
  std::vector<bool> seen_;
  std::uint32_t used_ = 0;    ///< axes that have moved so far, a mask
  bool cut_last_ = false;     ///< the last move was that of the last block found
  bool motion_open_ = false;  ///< no motion word since the last block found
  bool feed_open_ = false;
};

}  // namespace

const CutBlock* CutBlocks::find(std::uint32_t line) const noexcept {
  const auto found = std::ranges::lower_bound(blocks, line, {}, &CutBlock::line);
  return found != blocks.end() && found->line == line ? &*found : nullptr;
}

std::size_t CutBlocks::keep_near(std::uint32_t line, std::size_t count) {
  std::size_t kept = 0;
  const auto after = std::ranges::upper_bound(blocks, line, {}, &CutBlock::line);
  for (auto at = after; at != blocks.begin() && kept < count;) {
    --at;
    if (takes_feed(at->stays)) {
      at->stays = Stays::unproved;
      ++kept;
    }
  }
  for (auto at = after; at != blocks.end() && kept < count; ++at) {
    if (takes_feed(at->stays)) {
      at->stays = Stays::unproved;
      ++kept;
    }
  }
  return kept;
}

std::vector<std::uint32_t> CutBlocks::lines_that_stay(Stays why) const {
  std::vector<std::uint32_t> lines;
  for (const CutBlock& block : blocks) {
    if (block.stays == why) {
      lines.push_back(block.line);
    }
  }
  return lines;
}

kernel::outcome::Result<CutBlocks> cut_blocks(const std::string& path,
                                              const interpret::Config& config) {
  auto found = survey_program<CutSurvey>(path, config);
  if (found) {
    std::ranges::stable_sort(found->blocks, {}, &CutBlock::line);
  }
  return found;
}

}  // namespace steadyrest::nc::rewrite
