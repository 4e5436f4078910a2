// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/nc/interpret/state/step.hpp>
#include <steadyrest/nc/rewrite/prove/compare.hpp>
#include <steadyrest/nc/rewrite/prove/group_text.hpp>
#include <steadyrest/nc/rewrite/prove/shifts.hpp>
#include <steadyrest/nc/rewrite/prove/text_pair.hpp>
#include <steadyrest/nc/rewrite/prove/travel.hpp>
#include <steadyrest/nc/rewrite/prove/verify_moves.hpp>
#include <steadyrest/nc/rewrite/prove/window.hpp>
#include <steadyrest/nc/rewrite/text/inserted_lines.hpp>
#include <steadyrest/nc/rewrite/walk/survey.hpp>
#include <steadyrest/nc/rewrite/walk/walk.hpp>

namespace steadyrest::nc::rewrite {
namespace {

using interpret::Axes;
using interpret::Move;
using kernel::outcome::bad_input;
using kernel::outcome::Refusal;
using kernel::outcome::Result;

/// Runs both programs side by side, line by line.
class Prover {
 public:
  Prover(const Claim& claim, const interpret::Config& config, bool timed)
      : original_(claim.original),
        changed_(claim.changed),
        plan_(claim.plan),
        config_(with_unknown_offsets(config, claim.settings)),
        machine_(claim.machine),
        settings_(claim.settings),
        known_(claim.known),
        timed_(timed),
        shifts_(plan_),
        belongs_here_(plan_, settings_) {}

  Result<Proved> run() {
    PlainSurvey plain(config_.dialect);
    auto text = compare_text(original_, changed_, plain, plan_, settings_);
    auto surveyed = text ? survey(original_, config_, plain) : std::unexpected(text.error());
    if (!surveyed) {
      return std::unexpected(surveyed.error());
    }
    survey_ = std::move(*surveyed);
    inserted_ = InsertedLines(std::move(text->lines));
    groups_ = std::move(text->groups);
    head_lines_ = text->head_lines;
    proof_.inserted_lines = inserted_.size();
    if (!open() || !walk()) {
      return std::unexpected(refusal_);
    }
    proof_.largest_error_mm = shifts_.largest_error_mm();
    return Proved{.proof = proof_, .switchable = survey_.other != nullptr};
  }

 private:
  bool refuse(std::string what, std::string to_do = "make the changed program again") {
    return refuse_at(changed_, changed_run_ ? changed_run_->line() : 0, std::move(what),
                     std::move(to_do));
  }
  bool refuse_at(const std::string& file, std::uint32_t line, std::string what, std::string to_do) {
    refusal_ = bad_input(file, line, std::move(what), std::move(to_do));
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
    auto walk = Walk::make(original_, config_, survey_, settings_);
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
      return refuse_at(original_, taken->line, taken->what, taken->to_do);
    }
    if (changed_run_->step()) {
      return refuse("continues past the end of the original");
    }
    return at_end();
  }

  /// Runs the changed program up to and including the line that pairs with the original's.
  bool inserted_lines() {
    renew(modes_, changed_run_->state(), changed_run_->moved_alone());
    for (const AxisPlan& axis : plan_.axes) {
      shift_before_[axis.index] = shifts_.now(axis.index);
    }
    passed_inserted_ = false;
    for (bool as_it_was = true;;) {
      changed_moves_.clear();
      if (!changed_run_->step()) {
        const auto report = changed_run_->take();
        return report.refused.empty()
                   ? refuse("ends before the original")
                   : refuse(interpret::first_refusal(report, changed_), changed_);
      }
      const bool main = changed_run_->in_main();
      if (!main || !inserted_.has(changed_run_->line())) {
        const std::uint32_t before = main ? inserted_.before() : 0U;
        return (as_it_was ||
                refuse("the inserted lines before this one change more than an offset")) &&
               (changed_run_->line() - before == walk_->line() || refuse("executes another line"));
      }
      passed_inserted_ = true;
      // The head acts only after an abort; here it has no effect.
      executed_inserted_ += changed_run_->executed() && inserted_.before() >= head_lines_ ? 1U : 0U;
      if (!added_moves()) {
        return false;
      }
      offset_before_ = changed_run_->state().offset;
      as_it_was = modes_of(changed_run_->state()) == modes_;
    }
  }

  /// Moves of an inserted line: only a rapid of planned axes to their position in the original plus
  /// the correction.
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

  /// The same line in both programs: the correction in force, and every move.
  bool pair() {
    if (changed_run_->executed() != walk_->run().executed()) {
      return refuse("executes another line than the original");
    }
    acts_at_once_ = 0;
    belongs_here_.begin(*walk_);
    for (std::size_t i = 0; i < plan_.axes.size(); ++i) {
      const AxisPlan& axis = plan_.axes[i];
      if (!what_stands(i, offset_before_[axis.index] - walk_->before().offset[axis.index])) {
        return false;
      }
    }
    for (const AxisPlan& axis : plan_.axes) {
      const double shift_mm = shifts_.now(axis.index);
      if (restated_ && !same(shift_mm, shift_before_[axis.index]) &&
          !same(shift_mm, shifts_.wanted[axis.index])) {
        return refuse("an inserted line moves an axis where the plan does not want it");
      }
    }
    restated_ = false;
    offset_before_ = changed_run_->state().offset;
    return belongs() && compare_moves() && (!walk_->stores() || keeps_the_same());
  }

  /// The lines before this one are exactly those that belong here, character for character. Where
  /// none belong, the effect of others shows further down; if they have none, they are refused at
  /// the end.
  bool belongs() {
    const std::string& wanted = belongs_here_.text();
    const auto group = passed_inserted_ ? groups_.find(walk_->line()) : groups_.end();
    if (!walk_->run().in_main() || wanted == (group == groups_.end() ? "" : group->second)) {
      return true;
    }
    other_lines_ = other_lines_ == 0 ? changed_run_->line() : other_lines_;
    return wanted.empty() || refuse_other_lines();
  }

  bool refuse_other_lines() {
    return refuse_at(changed_, other_lines_,
                     "the lines inserted before this one do not belong here",
                     std::string(kAgainstOtherLines));
  }

  /// Nothing that outlives the program holds a correction, even at this line.
  bool keeps_the_same() {
    const std::string kept = kept_difference(walk_->run(), *changed_run_);
    return kept.empty() ||
           refuse_at(original_, walk_->top_line(),
                     "a correction would remain in " + kept + " after the program",
                     "do this before the first correction, or leave the axis out of the plan");
  }

  /// Before the paired line: the correction is still the last one, or changes here.
  bool what_stands(std::size_t index, double stands_mm) {
    const AxisPlan& axis = plan_.axes[index];
    double& wanted_mm = shifts_.wanted[axis.index];
    if (same(stands_mm, wanted_mm)) {
      belongs_here_.stays(index, wanted_mm);
      return true;
    }
    const bool frame = walk_->frame(axis.letter) == Frame::changed;
    if (same(stands_mm, 0.0) && walk_->may_write(axis.index) && (walk_->ends() || frame)) {
      belongs_here_.goes_off(index, wanted_mm);
      if (walk_->ends()) {
        wanted_mm = 0.0;
        ++proof_.changes;
        return true;
      }
      return !walk_->moves_axis(axis.index) ||
             refuse("the correction is removed in a line that moves its axis");
    }
    return changes(index, stands_mm);
  }

  bool changes(std::size_t index, double stands_mm) {
    const AxisPlan& axis = plan_.axes[index];
    double& wanted_mm = shifts_.wanted[axis.index];
    const double unit_mm = walk_->before().unit_mm;
    const auto step = std::ranges::find_if(axis.steps, [&](const PlannedStep& one) {
      return same(correction_mm(settings_, unit_mm, one.displacement_um), stands_mm);
    });
    if (step == axis.steps.end()) {
      return refuse(fmt::format(
          "{} is corrected by {:.6f} mm here; the plan has {:.6f} mm, or a later correction",
          axis.letter, stands_mm, wanted_mm));
    }
    stands_mm = correction_mm(settings_, unit_mm, step->displacement_um);  // without rounding
    if (std::abs(stands_mm) > settings_.clamp_mm + kHalfDigit_mm) {
      return refuse(fmt::format("{} is corrected by {:g} um; the machine file allows {:g} um",
                                axis.letter, stands_mm * 1e3, settings_.clamp_mm * 1e3));
    }
    if (!unit_free(settings_.method) && !walk_->units_said()) {
      return refuse("a correction begins before the program has set its units");
    }
    const Site site = walk_->site(axis.letter, axis.index);
    if (site == Site::none) {
      return refuse(fmt::format("{} is corrected where there is no safe place", axis.letter));
    }
    if (site == Site::clearance && !(restated_ && same(shifts_.now(axis.index), stands_mm))) {
      return refuse(fmt::format("a correction has no effect: {} is not programmed", axis.letter));
    }
    acts_at_once_ |= site == Site::clearance ? 0U : axis_bit(axis.index);
    belongs_here_.changes(index, wanted_mm, stands_mm, site);
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
      return refuse("makes different moves or events from the original here");
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
        return refuse_at(original_, walk_->top_line(),
                         "probes while a correction is on: the result would contain it",
                         "probe before the first correction");
      }
      if (!config_.start_known) {
        continue;
      }
      if (auto fault = over_travel(machine_.axes, plan_, before[i], after[i]); !fault.empty()) {
        return refuse_at(original_, walk_->top_line(), std::move(fault),
                         std::string(kAgainstTravel));
      }
    }
    return true;
  }

  bool at_end() {
    const std::string_view left = state_difference(walk_->run().state(), changed_run_->state());
    return (window_ == nullptr || in_time()) &&
           (left.empty() || refuse(fmt::format("leaves a different {} from the original", left))) &&
           keeps_the_same() && (other_lines_ == 0 || refuse_other_lines());
  }

  bool in_time() {
    const auto total = window_->finish();
    if (!total) {
      return refuse(total.error(), original_);
    }
    proof_.program_s = *total;
    return executed_inserted_ + head_lines_ == inserted_.size() ||
           refuse("some inserted line is not executed exactly once");
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
  std::size_t executed_inserted_ = 0;
  Modes modes_;
  std::optional<read::LineSource> changed_source_;
  KeptMoves changed_moves_;
  std::optional<interpret::ProgramRun> changed_run_;
  std::unique_ptr<Walk> walk_;
  std::unique_ptr<Window> window_;
  Shifts shifts_;
  std::map<std::uint32_t, std::string> groups_;  ///< inserted lines by the original's line
  GroupText belongs_here_;
  bool passed_inserted_ = false;   ///< lines were inserted before the current pair
  std::uint32_t other_lines_ = 0;  ///< the first line preceded by lines that do not belong there
  Axes offset_before_{};
  Axes shift_before_{};  ///< before the current inserted lines
  bool restated_ = false;
  std::uint32_t acts_at_once_ = 0;  ///< axes whose correction must act in this line, a mask
  Refusal refusal_;
  Proof proof_;
};

}  // namespace

Result<Proved> verify_moves(const Claim& claim, const interpret::Config& config, bool timed) {
  return Prover(claim, config, timed).run();
}

}  // namespace steadyrest::nc::rewrite
