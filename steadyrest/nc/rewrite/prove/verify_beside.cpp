// SPDX-License-Identifier: Apache-2.0
#include <optional>
#include <utility>

#include <fmt/core.h>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/nc/interpret/program.hpp>
#include <steadyrest/nc/rewrite/prove/text_pair.hpp>
#include <steadyrest/nc/rewrite/prove/travel.hpp>
#include <steadyrest/nc/rewrite/prove/verify_beside.hpp>
#include <steadyrest/nc/rewrite/prove/window.hpp>
#include <steadyrest/nc/rewrite/text/place_of_head.hpp>
#include <steadyrest/nc/rewrite/text/tag.hpp>
#include <steadyrest/nc/rewrite/walk/survey.hpp>
#include <steadyrest/nc/rewrite/walk/walk.hpp>

namespace steadyrest::nc::rewrite {
namespace {

using kernel::outcome::bad_input;
using kernel::outcome::Refusal;
using kernel::outcome::Result;

// For corrections that bypass the program's coordinates (R-parameter, setting data): the original's
// blocks and moves stay the same, so the programs need not run side by side. Each group of lines
// must be the text of a planned step at a safe place, and the end must reset it.
class BesideProver {
 public:
  explicit BesideProver(const Claim& claim)
      : original_(claim.original),
        changed_(claim.changed),
        plan_(claim.plan),
        axis_(claim.plan.axes.front()),
        machine_(claim.machine),
        settings_(claim.settings),
        known_(claim.known) {}

  Result<Proved> run(const interpret::Config& config, bool timed) {
    timed_ = timed;
    start_known_ = config.start_known;
    PlainSurvey plain(config.dialect);
    auto text = compare_text(original_, changed_, plain, plan_, settings_);
    auto surveyed = survey(original_, config, plain);
    if (!text || !surveyed) {
      return std::unexpected(text ? surveyed.error() : text.error());
    }
    text_ = std::move(*text);
    // A subprogram file that was not searched could read or write the variable.
    if (!surveyed->subprogram_files.empty()) {
      return std::unexpected(subprogram_may_use_it());
    }
    auto walk = Walk::make(original_, config, *surveyed, settings_);
    auto window = Window::make(known_, machine_, plan_, settings_, original_);
    if (!walk || !window) {
      return std::unexpected(walk ? window.error() : walk.error());
    }
    while (!refusal_ && (*walk)->step()) {
      line(**walk, **window);
      // Only the requested position of the switch has times.
      if (timed_) {
        (*window)->feed(**walk);
      }
    }
    if (refusal_) {
      return std::unexpected(*refusal_);
    }
    if (const auto report = (*walk)->take(); !report.refused.empty()) {
      return std::unexpected(interpret::first_refusal(report, original_));
    }
    if (timed_) {
      const auto total = (*window)->finish();
      if (!total) {
        return std::unexpected(total.error());
      }
      proof_.program_s = *total;
    }
    proof_.inserted_lines = text_.lines.size();
    at_end();
    // Correct lines may still be where the control does not read them: the changed program must run
    // to its end.
    if (!refusal_) {
      run_changed(config);
    }
    if (refusal_) {
      return std::unexpected(*refusal_);
    }
    return Proved{.proof = proof_, .switchable = surveyed->other != nullptr};
  }

 private:
  void refuse(std::uint32_t line, std::string what) {
    if (!refusal_) {
      refusal_ = bad_input(original_, line, std::move(what), "make the changed program again");
    }
  }

  /// A subprogram that was not searched may use the parameter itself.
  [[nodiscard]] Refusal subprogram_may_use_it() const {
    return bad_input(original_,
                     fmt::format("a subprogram may use {} itself",
                                 settings_.method == Method::r_parameter
                                     ? fmt::format("R{}", settings_.r_parameter)
                                     : "the temperature compensation"),
                     fmt::format("{}, or use one file without external subprograms",
                                 against_own_use(settings_)));
  }

  // The text of a change from the correction in force to `to_mm`, which the file must have
  // character for character.
  [[nodiscard]] std::string text_to(double to_mm) const {
    return change_text(settings_,
                       {.letter = axis_.letter,
                        .from_mm = stands_mm_,
                        .to_mm = to_mm,
                        .unit_mm = 1.0,
                        .active_offset = 0,
                        .incremental = false},
                       "\n");
  }

  void line(const Walk& walk, Window& window) {
    // Erased when reached, so whatever remains at the end was never executed.
    if (const auto group = text_.groups.find(walk.line()); group != text_.groups.end()) {
      change(walk, window, group->second);
      text_.groups.erase(group);
    }
    proof_.moves += walk.moves().size();
    proof_.corrected += stands_mm_ == 0.0 ? 0U : walk.moves().size();
    if (start_known_ && stands_mm_ != 0.0) {
      travel(walk);
    }
  }

  // The PLC moves the axis by the correction, so the whole reach shifts by it.
  void travel(const Walk& walk) {
    for (const interpret::Move& move : walk.moves()) {
      const Reach own = reach_of(move, axis_.index);
      auto fault =
          over_travel(machine_.axes, axis_.letter, own,
                      {.low_mm = own.low_mm + stands_mm_, .high_mm = own.high_mm + stands_mm_});
      if (!fault.empty() && !refusal_) {
        refusal_ = bad_input(original_, walk.line(), std::move(fault), std::string(kAgainstTravel));
      }
    }
  }

  void change(const Walk& walk, Window& window, const std::string& group) {
    ++proof_.changes;
    // The last line: back to zero.
    if (walk.ends() && walk.may_write(axis_.index) && group == text_to(0.0)) {
      stands_mm_ = 0.0;
      return;
    }
    // No note names the step: the text does. plan_match checks the order at the end.
    for (const PlannedStep& step : axis_.steps) {
      const double to_mm = correction_mm(settings_, 1.0, step.displacement_um);
      if (group != text_to(to_mm)) {
        continue;
      }
      const Site site = walk.site(axis_.letter, axis_.index);
      // Not at a feed move: STOPRE stops, which leaves a mark in the cut.
      if (site != Site::rapid && site != Site::clearance) {
        refuse(
            walk.line(),
            fmt::format("a correction of {} begins before a line that is not a safe place for it",
                        axis_.letter));
      }
      if (timed_) {
        window.ask(0, {.line = walk.line(), .stands_mm = to_mm, .unit_mm = 1.0, .time_s = 0.0});
      }
      stands_mm_ = to_mm;
      return;
    }
    refuse(walk.line(),
           fmt::format("the inserted lines before this line belong to no step of the plan: {}",
                       group.substr(0, group.find('\n'))));
  }

  void at_end() {
    if (timed_ && !text_.groups.empty()) {
      refuse(text_.groups.begin()->first, "inserted lines that are never executed");
    }
    if (stands_mm_ != 0.0) {
      refuse(0, fmt::format("a correction of {} is left at the end", axis_.letter));
    }
  }

  /// Correct lines may still be where the control does not read them: before the name of the
  /// program, or after its end.
  void run_changed(const interpret::Config& config) {
    class Nothing final : public interpret::Sink {
      void on_move(const interpret::Move& /*move*/) override {}
      void on_event(const interpret::Event& /*event*/) override {}
    } nothing;
    const auto report = interpret::run_file(changed_, config, nothing);
    if (!report || !report->refused.empty()) {
      refusal_ = report ? interpret::first_refusal(*report, changed_) : report.error();
    } else if (report->moves != proof_.moves) {
      refuse(0, "makes more or fewer moves than the original");
    }
  }

  const std::string& original_;
  const std::string& changed_;
  const Plan& plan_;
  const AxisPlan& axis_;
  const kernel::machine::Machine& machine_;
  const Settings& settings_;
  const KnownTimes* known_;
  bool timed_ = true;
  bool start_known_ = false;
  Inserted text_;
  double stands_mm_ = 0.0;
  std::optional<Refusal> refusal_;
  Proof proof_;
};

}  // namespace

Result<Proved> verify_beside(const Claim& claim, const interpret::Config& config, bool timed) {
  return BesideProver(claim).run(config, timed);
}

}  // namespace steadyrest::nc::rewrite
