// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include <steadyrest/nc/interpret/step.hpp>
#include <steadyrest/nc/rewrite/compare.hpp>
#include <steadyrest/nc/rewrite/inserted_lines.hpp>
#include <steadyrest/nc/rewrite/shifts.hpp>
#include <steadyrest/nc/rewrite/survey.hpp>
#include <steadyrest/nc/rewrite/text_pair.hpp>
#include <steadyrest/nc/rewrite/travel.hpp>
#include <steadyrest/nc/rewrite/verify_moves.hpp>
#include <steadyrest/nc/rewrite/walk.hpp>
#include <steadyrest/nc/rewrite/window.hpp>

namespace steadyrest::nc::rewrite {
namespace {

using interpret::Axes;
using interpret::Move;
using kernel::outcome::Kind;
using kernel::outcome::Refusal;
using kernel::outcome::Result;

/// Runs both programs, line beside line.
class Prover {
 public:
  Prover(const std::string& original, const std::string& changed, const Plan& plan,
         const interpret::Config& config, const kernel::machine::Machine& machine,
         const Settings& settings, const KnownTimes* known, bool timed)
      : original_(original),
        changed_(changed),
        plan_(plan),
        config_(with_unknown_offsets(config, settings)),
        machine_(machine),
        settings_(settings),
        known_(known),
        timed_(timed),
        shifts_(plan) {}

  Result<Proved> run() {
    PlainSurvey plain(config_.dialect);
    auto text = compare_text(original_, changed_, plain, true);
    if (!text) {
      return std::unexpected(text.error());
    }
    inserted_ = InsertedLines(std::move(text->lines));
    groups_ = std::move(text->groups);
    head_lines_ = text->head_lines;
    head_before_ = text->head_before;
    proof_.inserted_lines = inserted_.size();
    // The head changes nothing in this run: its text is compared.
    if (text->head != whole_head(plan_, settings_)) {
      refuse("the head is not the one that belongs to this plan, machine and way of writing",
             "strip the program and compensate it again: another version may have written it");
      return std::unexpected(refusal_);
    }
    auto surveyed = survey(original_, config_, plain);
    if (!surveyed) {
      return std::unexpected(surveyed.error());
    }
    survey_ = std::move(*surveyed);
    if (!open() || !walk()) {
      return std::unexpected(refusal_);
    }
    proof_.largest_error_mm = shifts_.largest_error_mm();
    return Proved{.proof = proof_, .switchable = survey_.other != nullptr};
  }

 private:
  bool refuse(std::string what, std::string to_do = "make the changed program anew") {
    return refuse_at(changed_, changed_run_ ? changed_run_->line() : 0, std::move(what),
                     std::move(to_do));
  }
  bool refuse_at(const std::string& file, std::uint32_t line, std::string what, std::string to_do) {
    refusal_ = {Kind::bad_input, file, line, std::move(what), std::move(to_do)};
    return false;
  }
  bool refuse(Refusal refusal, const std::string& file) {
    refusal_ = std::move(refusal);
    refusal_.file = refusal_.file.empty() ? file : refusal_.file;
    return false;
  }

  bool open() {
    auto source = read::LineSource::open(changed_);
    if (!source) {
      return refuse(source.error(), changed_);
    }
    changed_source_.emplace(std::move(*source));
    auto run = interpret::ProgramRun::make(*changed_source_, config_, changed_moves_);
    if (!run) {
      return refuse(run.error(), changed_);
    }
    changed_run_.emplace(std::move(*run));
    offset_before_ = changed_run_->state().offset;
    auto walk = Walk::make(original_, config_, survey_, settings_.method);
    if (!walk) {
      return refuse(walk.error(), original_);
    }
    walk_ = std::move(*walk);
    changed_run_->read_with(walk_->run());
    if (!timed_) {
      return true;
    }
    auto window = Window::make(known_, machine_, plan_, settings_, changed_);
    if (!window) {
      return refuse(window.error(), {});
    }
    window_ = std::move(*window);
    return true;
  }

  bool walk() {
    constexpr std::uint32_t kEvery = 1U << 14U;
    while (walk_->step()) {
      if (!inserted_lines() || !pair()) {
        return false;
      }
      if (window_ != nullptr) {
        window_->feed(*walk_);
      }
      if (settings_.progress && walk_->line() % kEvery == 0) {
        settings_.progress(0.5 + 0.5 * walk_->line() / std::max(survey_.end_line, 1U), "proving");
      }
    }
    if (const auto report = walk_->take(); !report.refused.empty()) {
      return refuse(interpret::first_refusal(report, original_), original_);
    }
    if (const auto& taken = walk_->taken(); taken && corrects(plan_)) {
      return refuse_at(original_, taken->line, taken->what, std::string(kAgainstTaken));
    }
    if (changed_run_->step()) {
      return refuse("goes on where the original has ended");
    }
    return at_end();
  }

  /// Runs the changed program up to and with the line that pairs with the original's.
  bool inserted_lines() {
    renew(modes_, changed_run_->state(), changed_run_->moved_alone());
    for (const AxisPlan& axis : plan_.axes) {
      shift_before_[axis.index] = shifts_.now(axis.index);
    }
    for (bool as_it_was = true;;) {
      changed_moves_.clear();
      if (!changed_run_->step()) {
        const auto report = changed_run_->take();
        return report.refused.empty()
                   ? refuse("ends before the original does")
                   : refuse(interpret::first_refusal(report, changed_), changed_);
      }
      const bool main = changed_run_->in_main();
      if (!main || !inserted_.has(changed_run_->line())) {
        const std::uint32_t before = main ? inserted_.before() : 0U;
        if (!as_it_was) {
          return refuse("the inserted lines before this one change more than an offset");
        }
        return changed_run_->line() - before == walk_->line() || refuse("another line is executed");
      }
      // The head acts after an abort alone, or does here what is done already.
      executed_inserted_ += changed_run_->executed() && inserted_.before() >= head_lines_ ? 1U : 0U;
      if (!added_moves()) {
        return false;
      }
      offset_before_ = changed_run_->state().offset;
      as_it_was = modes_of(changed_run_->state()) == modes_;
    }
  }

  /// Moves of an inserted line: a rapid of planned axes alone, to where they stand in the original
  /// and what is to stand.
  bool added_moves() {
    const bool head = inserted_.before() < head_lines_;
    if (std::ranges::any_of(changed_moves_.events, [head](const interpret::Event& event) {
          return !head || event.kind != interpret::EventKind::stop;
        })) {
      return refuse("an inserted line does more than move an axis");
    }
    for (const Move& move : changed_moves_.moves) {
      if (auto fault = shifts_.add(move, 2.0 * settings_.clamp_mm); !fault.empty()) {
        return refuse(std::move(fault));
      }
      ++proof_.added;
      restated_ = true;
    }
    return true;
  }

  /// The same line in both: what stands, and every move.
  bool pair() {
    if (head_before_ == walk_->line() && walk_->run().in_main() && proof_.moves > 0) {
      return refuse("the head stands behind the first move");
    }
    if (changed_run_->executed() != walk_->run().executed()) {
      return refuse("executes another line than the original");
    }
    const Walk::Before& before = walk_->before();
    acts_at_once_ = 0;
    for (std::size_t i = 0; i < plan_.axes.size(); ++i) {
      const AxisPlan& axis = plan_.axes[i];
      if (!what_stands(i, offset_before_[axis.index] - before.offset[axis.index])) {
        return false;
      }
    }
    for (const AxisPlan& axis : plan_.axes) {
      const double shift_mm = shifts_.now(axis.index);
      if (restated_ && !same(shift_mm, shift_before_[axis.index]) &&
          !same(shift_mm, shifts_.wanted[axis.index])) {
        return refuse("an inserted line moves an axis to where the plan does not want it");
      }
    }
    restated_ = false;
    offset_before_ = changed_run_->state().offset;
    return compare_moves() && (!walk_->stores() || keeps_the_same());
  }

  /// What outlives the program holds no correction, at this line already.
  bool keeps_the_same() {
    const std::string kept = kept_difference(walk_->run(), *changed_run_);
    return kept.empty() || refuse("a correction would stay in " + kept + " after the program",
                                  "do this before the first correction, or leave the axis out of "
                                  "the plan");
  }

  /// Before the paired line: the correction that stands is the last one, or changes here.
  bool what_stands(std::size_t index, double stands_mm) {
    const AxisPlan& axis = plan_.axes[index];
    double& wanted_mm = shifts_.wanted[axis.index];
    if (same(stands_mm, wanted_mm)) {
      const bool back = (framed_ & (1U << index)) != 0;
      framed_ &= ~(1U << index);
      return !back || is_written(axis, 0.0, wanted_mm);
    }
    const bool frame = walk_->frame(axis.letter) == Frame::changed;
    if (same(stands_mm, 0.0) && walk_->may_write(axis.index) && (walk_->ends() || frame)) {
      framed_ |= walk_->ends() ? 0U : 1U << index;
      if (!is_written(axis, wanted_mm, 0.0)) {
        return false;
      }
      if (walk_->ends()) {
        wanted_mm = 0.0;
        ++proof_.changes;
        return true;
      }
      return !walk_->moves_axis(axis.index) ||
             refuse("the correction is off in a line that moves its axis");
    }
    return changes(index, stands_mm);
  }

  /// The lines before this one hold, character for character, what makes this change: its checks
  /// and notes change nothing here, and would be missed after an abort.
  bool is_written(const AxisPlan& axis, double from_mm, double to_mm) {
    const Walk::Before& before = walk_->before();
    const std::string text = change_text(settings_,
                                         {.letter = axis.letter,
                                          .from_mm = from_mm,
                                          .to_mm = to_mm,
                                          .unit_mm = before.unit_mm,
                                          .active_offset = before.active_offset,
                                          .incremental = before.incremental},
                                         "\n");
    const auto group = groups_.find(walk_->line());
    return (group != groups_.end() && group->second.find(text) != std::string::npos) ||
           refuse(fmt::format("{} is corrected here by other lines than those that belong here",
                              axis.letter),
                  "strip the program and compensate it again: another version may have written it");
  }

  bool changes(std::size_t index, double stands_mm) {
    const AxisPlan& axis = plan_.axes[index];
    double& wanted_mm = shifts_.wanted[axis.index];
    const double unit_mm = walk_->before().unit_mm;
    if (std::ranges::none_of(axis.steps, [&](const PlannedStep& step) {
          return same(correction_mm(settings_, unit_mm, step.displacement_um), stands_mm);
        })) {
      return refuse(fmt::format(
          "{} stands corrected by {:.6f} mm here; the plan wants {:.6f} mm, or a later correction",
          axis.letter, stands_mm, wanted_mm));
    }
    if (std::abs(stands_mm) > settings_.clamp_mm + kHalfDigit_mm) {
      return refuse(
          fmt::format("{} stands corrected by {:g} um here; the machine file allows {:g} um",
                      axis.letter, stands_mm * 1e3, settings_.clamp_mm * 1e3));
    }
    if (!unit_free(settings_.method) && !walk_->units_said()) {
      return refuse("a correction begins where the program has not said its units");
    }
    const Site site = walk_->site(axis.letter, axis.index);
    if (site == Site::none) {
      return refuse(
          fmt::format("a correction of {} begins before a line that is no safe place for "
                      "it",
                      axis.letter));
    }
    const double shift_mm = shifts_.now(axis.index);
    if (site == Site::clearance && !(restated_ && same(shift_mm, stands_mm))) {
      return refuse(
          fmt::format("a correction of {} does not act: the axis is not programmed "
                      "here",
                      axis.letter));
    }
    acts_at_once_ |= site == Site::clearance ? 0U : std::uint32_t{1} << axis.index;
    if (!is_written(axis, wanted_mm, stands_mm)) {
      return false;
    }
    if (window_ != nullptr) {
      window_->ask(index, {.line = changed_run_->line(),
                           .stands_mm = stands_mm,
                           .unit_mm = unit_mm,
                           .time_s = 0.0});
    }
    wanted_mm = stands_mm;
    ++proof_.changes;
    return true;
  }

  bool compare_moves() {
    const auto& before = walk_->moves();
    const auto& after = changed_moves_.moves;
    if (before.size() != after.size() || !equal_events(walk_->events(), changed_moves_.events)) {
      return refuse("makes other moves, or other events, than the original here");
    }
    const Frames frames = {
        .incremental = walk_->before().incremental || walk_->run().state().incremental,
        .machine = walk_->machine_frame(),
        .acts_at_once = acts_at_once_};
    for (std::size_t i = 0; i < before.size(); ++i) {
      ++proof_.moves;
      if (const auto other = first_difference(before[i], after[i]); !other.empty()) {
        return refuse(fmt::format("differs from the original in its {}", other));
      }
      if (before[i].kind == interpret::MoveKind::dwell) {
        continue;
      }
      if (auto fault = shifts_.pair(before[i], after[i], frames); !fault.empty()) {
        return refuse(std::move(fault));
      }
      proof_.corrected += shifts_.any() ? 1U : 0U;
      if (before[i].kind == interpret::MoveKind::probe && shifts_.any()) {
        return refuse("probes while a correction stands: what it finds would hold it",
                      "probe before the first correction");
      }
      if (!config_.start_known) {
        continue;
      }
      if (auto fault = over_travel(machine_, plan_, before[i], after[i]); !fault.empty()) {
        return refuse_at(original_, walk_->top_line(), std::move(fault),
                         std::string(kAgainstTravel));
      }
    }
    return true;
  }

  bool at_end() {
    if (window_ != nullptr && !in_time()) {
      return false;
    }
    const std::string_view left = state_difference(walk_->run().state(), changed_run_->state());
    return (left.empty() ||
            refuse(fmt::format("leaves another {} behind than the original", left))) &&
           keeps_the_same();
  }

  bool in_time() {
    const auto total = window_->finish();
    if (!total) {
      return refuse(total.error(), original_);
    }
    proof_.program_s = *total;
    return executed_inserted_ + head_lines_ == inserted_.size() ||
           refuse("not every inserted line is executed exactly once");
  }

  const std::string& original_;
  const std::string& changed_;
  const Plan& plan_;
  interpret::Config config_;
  const kernel::machine::Machine& machine_;
  const Settings& settings_;
  const KnownTimes* known_;
  bool timed_;
  Survey survey_;
  InsertedLines inserted_;
  std::size_t head_lines_ = 0;
  std::uint32_t head_before_ = 0;  ///< line of the original
  std::size_t executed_inserted_ = 0;
  Modes modes_;
  std::optional<read::LineSource> changed_source_;
  KeptMoves changed_moves_;
  std::optional<interpret::ProgramRun> changed_run_;
  std::unique_ptr<Walk> walk_;
  std::unique_ptr<Window> window_;
  Shifts shifts_;
  std::map<std::uint32_t, std::string> groups_;  ///< inserted lines by the original's line
  std::uint32_t framed_ = 0;  ///< axes of the plan, taken off for a line that changes the frame
  Axes offset_before_{};
  Axes shift_before_{};  ///< before the inserted lines in hand
  bool restated_ = false;
  std::uint32_t acts_at_once_ = 0;  ///< axes whose correction must act in this line, a mask
  Refusal refusal_;
  Proof proof_;
};

}  // namespace

Result<Proved> verify_moves(const std::string& original, const std::string& changed,
                            const Plan& plan, const interpret::Config& config,
                            const kernel::machine::Machine& machine, const Settings& settings,
                            const KnownTimes* known, bool timed) {
  return Prover(original, changed, plan, config, machine, settings, known, timed).run();
}

}  // namespace steadyrest::nc::rewrite
