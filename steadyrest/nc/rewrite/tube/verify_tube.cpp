// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include <fmt/core.h>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/nc/interpret/program.hpp>
#include <steadyrest/nc/rewrite/prove/compare.hpp>
#include <steadyrest/nc/rewrite/replace/block_text.hpp>
#include <steadyrest/nc/rewrite/replace/block_words.hpp>
#include <steadyrest/nc/rewrite/replace/by_control.hpp>
#include <steadyrest/nc/rewrite/replace/cut_blocks.hpp>
#include <steadyrest/nc/rewrite/tube/changed_lines.hpp>
#include <steadyrest/nc/rewrite/tube/fresh_move.hpp>
#include <steadyrest/nc/rewrite/tube/running.hpp>
#include <steadyrest/nc/rewrite/tube/same_line.hpp>
#include <steadyrest/nc/rewrite/tube/stretch.hpp>
#include <steadyrest/nc/rewrite/tube/verify_tube.hpp>
#include <steadyrest/nc/rewrite/walk/survey.hpp>

namespace steadyrest::nc::rewrite {
namespace {

using interpret::Move;
using kernel::outcome::bad_input;
using kernel::outcome::Refusal;
using kernel::outcome::Result;
using kernel::signal::Point;

constexpr std::string_view kMakeChangedAgain = "make the changed program again from this original";

/// Modes that a new line must leave as they were.
Modes lasting(Modes modes) {
  modes.motion = 0;
  modes.feed_mm_s = 0.0;
  return modes;
}

/// Runs both programs side by side, line by line.
class TubeProver {
 public:
  TubeProver(const std::string& original, const std::string& changed, const Permitted& permitted,
             const ChangedLines& lines, read::Dialect dialect)
      : original_(original),
        changed_(changed),
        permitted_(permitted),
        lines_(lines),
        dialect_(dialect),
        stretch_(permitted.tube_mm) {}

  Result<TubeProof> run(const interpret::Config& config,
                        const std::function<void(double share, std::string_view what)>& progress) {
    auto blocks = cut_blocks(original_, config);
    auto before = blocks ? Running::open(original_, config) : std::unexpected(blocks.error());
    auto after = before ? Running::open(changed_, config) : std::unexpected(before.error());
    if (!after) {
      return std::unexpected(after.error());
    }
    blocks_ = std::move(*blocks);
    a_ = std::move(*before);
    b_ = std::move(*after);
    b_->run->read_with(*a_->run);
    start_known_ = config.start_known;
    constexpr std::uint32_t kEvery = 1U << 14U;
    const double lines =
        std::max<double>(1.0, blocks_.blocks.empty() ? 1.0 : blocks_.blocks.back().line);
    while (a_->step()) {
      if (!line()) {
        return std::unexpected(refusal_);
      }
      if (progress && a_->run->line() % kEvery == 0) {
        progress(std::min(1.0, a_->run->line() / lines), "proving");
      }
    }
    if (!end()) {
      return std::unexpected(refusal_);
    }
    proof_.assumed = blocks_.assumed;
    proof_.replaced_lines = lines_.replaced();
    proof_.new_lines = lines_.fresh();
    proof_.tube_mm = permitted_.tube_mm;
    proof_.farthest_mm = stretch_.farthest_mm();
    proof_.farthest_line = stretch_.farthest_line();
    return proof_;
  }
  /// The program has lines that the operator can skip.
  [[nodiscard]] bool switchable() const noexcept { return switchable_; }

 private:
  bool refuse(std::string what, std::string to_do = std::string(kMakeChangedAgain)) {
    return refuse_at(changed_, b_->run->line(), std::move(what), std::move(to_do));
  }
  bool refuse_at(const std::string& file, std::uint32_t line, std::string what, std::string to_do) {
    refusal_ = bad_input(file, line, std::move(what), std::move(to_do));
    return false;
  }
  /// Why a run ended; `what` where it was not refused itself.
  bool refuse_end(Running& of, std::string_view what) {
    if (const auto report = of.run->take(); !report.refused.empty()) {
      refusal_ = interpret::first_refusal(report, of.path);
      return false;
    }
    return refuse(std::string(what));
  }

  /// The next line of the changed program that is not the mark in its head.
  bool next_changed() {
    do {
      if (!b_->step()) {
        return refuse_end(*b_, "ends before the original");
      }
    } while (b_->run->in_main() && lines_.kind(b_->run->line()) == ChangedLines::Kind::head);
    return true;
  }

  /// The line that the original has just executed, and what the changed program makes of it.
  bool line() {
    switchable_ = switchable_ || a_->run->block().deleted();
    if (!next_changed()) {
      return false;
    }
    const std::uint32_t number = a_->run->line();
    const bool main = a_->run->in_main();
    const std::uint32_t of = b_->run->in_main() ? lines_.origin(b_->run->line()) : b_->run->line();
    if (main != b_->run->in_main() || of != number) {
      return refuse("executes another line than the original");
    }
    const std::uint32_t fresh = main ? lines_.in_place_of(number) : ChangedLines::kNone;
    const bool done = fresh == ChangedLines::kNone ? kept() : replaced(number, fresh);
    a_->note_position();
    b_->note_position();
    return done;
  }

  /// A line that both programs have.
  bool kept() {
    if (b_->run->executed() != a_->run->executed()) {
      return refuse("is not executed as in the original");
    }
    if (auto fault = parted(*a_, *b_, rounding_mm(), !permitted_.speeds); !fault.empty()) {
      return refuse(std::move(fault));
    }
    const auto& a = a_->kept.moves;
    const auto& b = b_->kept.moves;
    proof_.moves += b.size();
    if ((!a.empty() || !a_->kept.events.empty()) && !close()) {
      return false;
    }
    const LinePair pair{.original = a,
                        .changed = b,
                        .rounding_mm = rounding_mm(),
                        .replaceable = b_->run->in_main() && may_be_replaced(a_->run->line())};
    if (auto fault = event_difference(a_->kept.events, b_->kept.events, permitted_);
        !fault.empty()) {
      return refuse(std::move(fault));
    }
    if (auto fault = line_difference(pair, permitted_); !fault.empty()) {
      return refuse(std::move(fault));
    }
    for (std::size_t i = 0; i < a.size(); ++i) {
      if (is_moved_arc(a[i], b[i]) && !moved_arc(a[i], b[i])) {
        return false;
      }
      note_feed(a[i], b[i]);
    }
    return true;
  }

  /// An arc that a replaced block before it has moved a little.
  bool moved_arc(const Move& a, const Move& b) {
    stretch_.begin(machine_point(a, a.start), machine_point(b, b.start));
    stretch_.block(a);
    stretch_.fresh(b);
    return close();
  }

  /// Half of the last digit that new blocks are written with.
  [[nodiscard]] double rounding_mm() const {
    constexpr double kHalf = 0.51;
    const double unit_mm = b_->run->state().unit_mm;
    return kHalf * std::pow(10.0, -decimals_of(dialect_, unit_mm)) * unit_mm;
  }

  bool replaced(std::uint32_t number, std::uint32_t fresh) {
    if (!b_->kept.moves.empty() || !b_->kept.events.empty()) {
      return refuse("a comment that keeps a replaced line does something");
    }
    if (may_be_replaced(number)) {
      return replaced_block(*blocks_.find(number), fresh);
    }
    const auto was = b_->run->line();
    if (fresh > 0 && !b_->step()) {
      return refuse_end(*b_, "ends before the original");
    }
    const auto kind = lines_.kind(b_->run->line());
    if (permitted_.feeds && kind == ChangedLines::Kind::same) {
      return kept() && feeds_alone(fresh - 1);
    }
    // The values of S and F may change in any line that is executed side by side.
    if (permitted_.speeds && fresh == 1 && kind >= ChangedLines::Kind::fresh) {
      return differs_in_values_alone(a_->run->block(), b_->run->block())
                 ? kept()
                 : refuse("replaces a line that must stay, and differs in more than S and F");
    }
    const CutBlock* block = blocks_.find(number);
    return refuse_at(changed_, was,
                     fmt::format("replaces line {} of the original, which must stay: {}", number,
                                 block == nullptr ? "it does not cut" : sentence(block->stays)),
                     std::string(kMakeChangedAgain));
  }

  [[nodiscard]] bool may_be_replaced(std::uint32_t number) const {
    const CutBlock* block = blocks_.find(number);
    return block != nullptr && (takes_feed(block->stays) || block->stays == Stays::after_switch);
  }

  void note_feed(const Move& block, const Move& move) {
    const double ratio = move.feed_mm_s / block.feed_mm_s;
    if (block.feed_mode == move.feed_mode && ratio < proof_.least_feed_ratio) {
      proof_.least_feed_ratio = ratio;
      proof_.slowest_line = b_->run->line();
    }
  }

  /// F after a line that stays: the feed that the next block takes over.
  bool feeds_alone(std::uint32_t lines) {
    for (; lines > 0; --lines) {
      b_->note_position();
      if (!b_->step()) {
        return refuse_end(*b_, "ends before the original");
      }
      const auto words = b_->run->block().words();
      const bool feed = words.size() == 1 && words[0].letter == 'F' && !is_calculated(words[0]);
      // In a subprogram that is only read, neither is executed.
      const bool alike = b_->run->executed() == a_->run->executed();
      if (lines_.kind(b_->run->line()) != ChangedLines::Kind::fresh || !alike ||
          (b_->run->executed() && !feed)) {
        return refuse("is a new line after one that must stay, and holds more than F");
      }
    }
    return true;
  }

  bool replaced_block(const CutBlock& of, std::uint32_t fresh) {
    if (a_->kept.moves.size() != 1 || !a_->kept.events.empty()) {
      return refuse("replaces a line that does more than cut");
    }
    const Move& block = a_->kept.moves.front();
    const Point start = machine_point(block, block.start);
    const bool begins = !stretch_.open();
    if (begins) {
      stretch_.begin(start, b_->at_mm.value_or(start));
    }
    stretch_.block(block);
    for (std::uint32_t i = 0; i < fresh; ++i) {
      if (!b_->step()) {
        return refuse_end(*b_, "ends before the original");
      }
      if (asks_control(of, b_->run->block(), b_->kept.moves)) {
        return refuse(std::string(kAsksControl));
      }
      if (!fresh_line(block, begins && a_->behind_rapid && i == 0)) {
        return false;
      }
    }
    if (!same_modes()) {
      return refuse("leaves another mode in force than the block that it replaces");
    }
    return true;
  }

  [[nodiscard]] bool same_modes() const {
    Modes a = lasting(modes_of(a_->run->state()));
    const Modes b = lasting(modes_of(b_->run->state()));
    a.spindle_speed_rev_s = (permitted_.speeds ? b : a).spindle_speed_rev_s;
    return a == b;
  }

  /// A line in place of a block, which has made its moves.
  bool fresh_line(const Move& block, bool begins) {
    const interpret::ProgramRun& run = *b_->run;
    const auto& moves = b_->kept.moves;
    if (!run.in_main() || lines_.kind(run.line()) < ChangedLines::Kind::fresh) {
      return refuse("executes another line than the original");
    }
    const bool waits = is_wait(permitted_, moves);
    auto fault = waits ? wait_fault(run.block(), block, moves.front().dwell_s, begins)
                       : words_fault(run.block());
    if (fault.empty() &&
        (!run.executed() || !run.at_top() || run.block().deleted() || !b_->kept.events.empty())) {
      fault = "is a new line that does more than cut";
    }
    for (std::size_t i = 0; i < moves.size() && fault.empty() && !waits; ++i) {
      fault = fresh_move_difference(permitted_, block, moves[i]);
      stretch_.fresh(moves[i]);
      note_feed(block, moves[i]);
    }
    proof_.moves += moves.size();
    b_->note_position();
    return fault.empty() || refuse(std::move(fault));
  }

  /// Both programs are together again: the path since they parted.
  bool close() {
    const auto fault = stretch_.close();
    if (!fault) {
      return true;
    }
    constexpr std::string_view kAgainstTube =
        "make the changed program with a smaller shift, or allow a wider tube with --tube-mm";
    return refuse_at(fault->of_original ? original_ : changed_, fault->line, fault->what,
                     std::string(kAgainstTube));
  }

  bool end() {
    if (const auto report = a_->run->take(); !report.refused.empty()) {
      refusal_ = interpret::first_refusal(report, original_);
      return false;
    }
    if (b_->step()) {
      return refuse("continues past the end of the original");
    }
    if (const auto report = b_->run->take(); !report.refused.empty()) {
      refusal_ = interpret::first_refusal(report, changed_);
      return false;
    }
    return close() && (!start_known_ || within_travel()) && ends_the_same();
  }

  bool within_travel() {
    auto fault = travel_fault(permitted_.axes, a_->used, b_->used);
    return !fault || refuse_at(changed_, fault->line, std::move(fault->what),
                               "make the changed program with a smaller shift");
  }

  bool ends_the_same() {
    const interpret::State& a = a_->run->state();
    interpret::State b = b_->run->state();
    for (std::size_t i = 0; i < a.position.size(); ++i) {
      if (std::abs(a.position[i] - b.position[i]) > std::max(kSameEnd_mm, rounding_mm())) {
        return refuse("ends at another position than the original");
      }
    }
    // The last block may be a new one: its motion word and feed stay in force.
    b.motion = a.motion;
    b.feed_mm_s = a.feed_mm_s;
    if (permitted_.speeds) {
      b.spindle_speed_rev_s = a.spindle_speed_rev_s;
    }
    if (const auto left = state_difference(a, b); !left.empty()) {
      return refuse(fmt::format("leaves a different {} from the original", left));
    }
    const std::string kept = kept_difference(*a_->run, *b_->run);
    return kept.empty() || refuse("leaves another value in " + kept + " than the original");
  }

  const std::string& original_;
  const std::string& changed_;
  const Permitted& permitted_;
  const ChangedLines& lines_;
  read::Dialect dialect_;
  CutBlocks blocks_;
  std::unique_ptr<Running> a_;
  std::unique_ptr<Running> b_;
  Stretch stretch_;
  bool switchable_ = false;
  bool start_known_ = false;
  TubeProof proof_;
  Refusal refusal_;
};

}  // namespace

Result<TubeProof> verify_tube(
    const std::string& original, const std::string& changed, const interpret::Config& config,
    const Permitted& permitted,
    const std::function<void(double share, std::string_view what)>& progress) {
  auto lines = ChangedLines::compare(original, changed);
  if (!lines) {
    return std::unexpected(lines.error());
  }
  TubeProver prover(original, changed, permitted, *lines, config.dialect);
  auto proof = prover.run(config, progress);
  // The same text does the same with every switch, even where the control would refuse it.
  if (proof && proof->replaced_lines > 0 && prover.switchable()) {
    TubeProver other(original, changed, permitted, *lines, config.dialect);
    if (auto also = other.run(switched(config), progress); !also) {
      return std::unexpected(of_other_position(std::move(also.error()), config));
    }
  }
  return proof;
}

}  // namespace steadyrest::nc::rewrite
