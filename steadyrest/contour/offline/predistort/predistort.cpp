// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <limits>
#include <utility>

#include <steadyrest/contour/offline/predistort/best_part.hpp>
#include <steadyrest/contour/offline/predistort/polish/polish_rounds.hpp>
#include <steadyrest/contour/offline/predistort/predistortion.hpp>
#include <steadyrest/contour/offline/predistort/report.hpp>
#include <steadyrest/contour/offline/predistort/shape/segment_use.hpp>
#include <steadyrest/contour/offline/predistort/uncertainty.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/math/geometry/moves.hpp>
#include <steadyrest/nc/plan/path/plan_program.hpp>
#include <steadyrest/nc/rewrite/replace/at_worst.hpp>
#include <steadyrest/nc/rewrite/tube/prove_made.hpp>

namespace steadyrest::contour::offline {
namespace {

using kernel::machine::Machine;
using kernel::outcome::Result;

constexpr int kMostRevisions = 3;  ///< runs that must stay are found at most so often
constexpr int kSifts = 8;
constexpr int kMostWaits = 7;  ///< runs in which waits are found
constexpr int kSiftRounds = 2;
constexpr double kLeastFeed = 0.25;   ///< of the programmed one, where feeds fall
constexpr double kWorthwhile = 0.25;  ///< of the limit: a run whose error is less stays
constexpr double kHopeless = 0.25;    ///< of its RMS: a run that could win no more stays
constexpr double kLongestTried_s = 1200.0;
constexpr double kFittedGain = 0.002;  ///< to which a record shows how far gains are apart

/// A record shows the gains to two standard deviations, and what is in all of them alike, such as
/// half a cycle of its delay, bends no line.
GainUncertainty gains_by(const std::vector<FittedAxis>& fitted, double by_file) {
  if (fitted.empty()) {
    return {.each = by_file, .apart = by_file};
  }
  double each = kFittedGain;
  for (const FittedAxis& axis : fitted) {
    each = std::max(each, 2.0 * axis.gain_sd_1_s / axis.is.gain_1_s);
  }
  return {.each = std::min(each, by_file), .apart = std::min(kFittedGain, by_file)};
}

}  // namespace

Predistortion::Predistortion(const std::string& file, const nc::interpret::Config& config,
                             const Machine& machine, const PredistortConfig& how,
                             const GainUncertainty& gains)
    : file_(file),
      config_(config),
      machine_(machine),
      how_(how),
      gains_(gains),
      // What is learnt is beyond the model whose inverse is written.
      model_(how.parts.empty() ? servo_models(machine.axes)
                               : cautious(servo_models(machine.axes), gains.apart)),
      inverse_(cautious(model_, gains.apart), backlash_mm(machine.axes)),
      progress_(how.progress, 1 + how.rounds + kCornerRuns + kPolishRuns + kRefinements +
                                  (how.hold_mm > 0.0 ? kHoldRuns + kMostHolds * kHoldRounds : 0)) {}

Result<Predistorted> Predistortion::run() {
  progress_.phase("predicting the error", 1);
  auto ready = read();
  ready = ready ? learn_from_parts() : ready;
  if (!ready) {
    return std::unexpected(ready.error());
  }
  barred_.emplace(path_, machine_.axes, how_.max_shift_mm);
  runs_.emplace(path_, use());
  if (auto done = begin_with(); !done) {
    return std::unexpected(done.error());
  }
  out_.before = first_->figures;
  out_.seconds_before = first_->seconds;
  if (out_.before.nominal().samples == 0) {
    return kernel::outcome::refuse(file_, "the program cuts nothing",
                                   "give a program with feed moves");
  }
  if (auto done = wait_behind_rapids(); !done) {
    return std::unexpected(done.error());
  }
  bar_hopeless();
  if (auto done = proved(); !done) {
    return std::unexpected(done.error());
  }
  if (auto done = keep_best_part(); !done) {
    return std::unexpected(done.error());
  }
  out_.lines = std::move(best_.lines);
  out_.replaced = std::move(best_.replaced);
  out_.too_far = std::move(barred_->too_far);
  out_.past_travel = std::move(barred_->past_travel);
  out_.worse = std::move(barred_->worse);
  out_.unproved = blocks_.lines_that_stay(nc::rewrite::Stays::unproved);
  out_.slower = score_->slower(out_.after.nominal());
  if (!out_.kept_part) {
    out_.waits = std::move(waits_);
    std::erase_if(out_.waits, [&](const auto& wait) { return !out_.lines.contains(wait.first); });
  }
  add_report(out_, how_.limit_mm);
  learnt_.unrefine(0);
  out_.taught = std::move(learnt_);
  out_.axes = std::move(machine_.axes);
  out_.gain_uncertainty = gains_.each;
  return std::move(out_);
}

// The control's own plan of it, on the path that the shape is made from.
Result<void> Predistortion::begin_with() {
  auto planned = write({});
  if (!planned) {
    return std::unexpected(planned.error());
  }
  auto run = follow(judging(), *planned, corners_);
  if (!run) {
    return std::unexpected(run.error());
  }
  score_.emplace(how_.most_time, run->seconds, run->figures.nominal(), how_.limit_mm);
  runs_before_ = std::move(run->runs);
  first_ = First{.lines = std::move(planned->lines),
                 .replaced = std::move(planned->replaced),
                 .figures = std::move(run->figures),
                 .seconds = run->seconds,
                 .speed = std::move(run->speed),
                 .starts = std::move(run->starts),
                 .over = std::move(run->over)};
  return {};
}

Result<void> Predistortion::wait_behind_rapids() {
  const OtherModels none;
  RapidWaits rapids(path_, use(), how_.hold_mm, softest_gain_1_s(model_));
  std::vector<ErrorPlace> over = first_->over;
  for (int i = 0; i < kMostWaits && rapids.adjust(over); ++i) {
    waits_ = rapids.waits();
    const auto planned = write({});
    auto run = planned ? follow(judging(model_, none), *planned, corners_)
                       : std::unexpected(planned.error());
    if (!run) {
      return std::unexpected(run.error());
    }
    over = std::move(run->over);
  }
  return waits_.empty() ? Result<void>{} : begin_with();
}

Result<void> Predistortion::drop_waits() {
  const auto gone = std::erase_if(waits_, [&](const auto& wait) {
    return blocks_.find(wait.first)->stays != nc::rewrite::Stays::free;
  });
  return gone == 0 ? Result<void>{} : begin_with();
}

Result<void> Predistortion::keep_best_part() {
  if (how_.parts.empty()) {
    return {};
  }
  const Lessons same = lessons();
  auto better =
      better_part({.file = file_, .lessons = same, .parts = how_.parts, .told = how_.told}, best_);
  if (!better) {
    return std::unexpected(better.error());
  }
  if (!*better) {
    return {};
  }
  const auto proof = nc::rewrite::prove_made(file_, (*better)->program.replaced, config_, machine_);
  if (!proof) {
    // A full disk, say, is no fault of the program.
    return proof.error().kind == kernel::outcome::Kind::unavailable
               ? Result<void>(std::unexpected(proof.error()))
               : Result<void>();
  }
  out_.kept_part = (*better)->part;
  out_.largest_shift_mm = (*better)->largest_shift_mm;
  best_ = std::move((*better)->program);
  learnt_.unrefine(0);
  auto run = follow(judging(), best_, corners_);
  if (!run) {
    return std::unexpected(run.error());
  }
  out_.after = std::move(run->figures);
  out_.seconds_after = run->seconds;
  return {};
}

void Predistortion::bar_hopeless() {
  const bool each = judged_by_each();
  const auto is_good = [&](std::size_t run) {
    return run == runs_->size() ||
           (each ? runs_before_->model(run) : runs_before_->worst(run)).max_mm <=
               kWorthwhile * how_.limit_mm;
  };
  for (std::size_t i = 0; i < runs_->size(); ++i) {
    if (each && runs_before_->could_win_mm(i) < kHopeless * runs_before_->model(i).rms_mm) {
      barred_->bar_worse({i}, *runs_);
    } else if (is_good(i) && is_good(i + 1)) {
      // What a run leaves at its end is an error of the next.
      barred_->bar(runs_->lines(i));
    }
  }
}

Result<void> Predistortion::proved() {
  Result<void> revised;
  int revision = 0;
  const auto proof =
      nc::rewrite::at_worst_they_stay(blocks_, [&]() -> Result<nc::rewrite::TubeProof> {
        revised = revise(revision);
        return revised ? nc::rewrite::prove_made(file_, best_.replaced, config_, machine_)
                       : nc::rewrite::TubeProof{};
      });
  return proof ? revised : std::unexpected(proof.error());
}

Result<void> Predistortion::revise(int& revision) {
  if (auto done = drop_waits(); !done) {
    return done;
  }
  if (judged_by_each()) {
    if (auto done = sift(); !done) {
      return done;
    }
  }
  for (const int last = revision + kMostRevisions; revision <= last; ++revision) {
    if (auto done = attempt(revision); !done) {
      return done;
    }
    if (!bar_worse()) {
      return {};
    }
  }
  return sift();
}

bool Predistortion::bar_worse() {
  return best_mm_ >= 0.0 &&
         barred_->bar_worse(worse_runs(*runs_, *runs_before_, *runs_after_, barred_->lines(),
                                       judged_by_each() ? Guard::by_each : Guard::by_worst),
                            *runs_);
}

void Predistortion::begin_caps() {
  caps_.emplace(path_, std::max(kLeastFeed, machine_.contour.min_ratio));
}

bool Predistortion::begin() {
  best_mm_ = -1.0;
  keep_original();
  speed_ = best_speed_ = first_->speed;
  starts_ = first_->starts;
  begin_caps();
  holds_ = false;
  if (hold_mm() > 0.0) {
    held_.emplace(path_, use(), hold_mm());
    best_cost_s_ = std::numeric_limits<double>::infinity();
  }
  learnt_.unrefine(0);
  return std::ranges::any_of(use(), &SegmentUse::free);
}

Result<void> Predistortion::sift() {
  progress_.phase("shaping the path", kSifts * kSiftRounds);
  for (int i = 0; i < kSifts && begin(); ++i) {
    if (auto done = rounds(kSiftRounds); !done) {
      return done;
    }
    if (!bar_worse()) {
      return {};
    }
  }
  begin();
  return {};
}

Result<void> Predistortion::attempt(int revision) {
  if (!begin()) {
    return {};
  }
  progress_.phase("shaping the path", how_.rounds);
  if (auto done = rounds(how_.rounds); !done) {
    return done;
  }
  progress_.phase("leading corners", kCornerRuns);
  if (revision == 0 && !corners_.empty() && out_.seconds_before < kLongestTried_s) {
    if (auto done = try_corners(); !done) {
      return done;
    }
  }
  progress_.phase("refining the path", kRefinements);
  if (auto done = refine(); !done) {
    return done;
  }
  if (hold_mm() > 0.0) {
    return hold();
  }
  progress_.phase("polishing the path", kPolishRuns);
  return polish();
}

void Predistortion::keep_original() {
  best_.lines = first_->lines;
  best_.replaced = first_->replaced;
  out_.after = first_->figures;
  out_.seconds_after = first_->seconds;
  out_.largest_shift_mm = 0.0;
}

Result<void> Predistortion::read() {
  auto blocks = nc::rewrite::cut_blocks(file_, config_);
  if (!blocks) {
    return std::unexpected(blocks.error());
  }
  blocks_ = std::move(*blocks);
  auto path = nc::plan::plan_programmed_file(file_, config_, machine_);
  if (!path) {
    return std::unexpected(path.error());
  }
  path_ = std::move(*path);
  // What the lags do is part of what records show.
  const auto lag = how_.parts.empty() ? how_.lag_uncertainty : 0.0;
  const auto by = ServoUncertainty::of(machine_.axes, gains_.each, lag);
  out_.others = uncertain(model_, by, path_.segments);
  for (std::size_t i = 0; i < std::min<std::size_t>(3, machine_.axes.size()); ++i) {
    if (math::geometry::moves(path_.segments, i)) {
      out_.lag_uncertainty = std::max(out_.lag_uncertainty, by.lag[i]);
      if (!machine_.axes[i].velocity_lag_known) {
        out_.unknown_lags.push_back(machine_.axes[i].name);
      }
    }
  }
  return {};
}

std::vector<SegmentUse> Predistortion::use() const {
  return segment_use(path_, blocks_, barred_->lines());
}

Lessons Predistortion::lessons() const {
  return {.machine = machine_,
          .config = config_,
          .original = path_,
          .model = model_,
          .gain_uncertainty = gains_.each};
}

Result<void> Predistortion::learn_from_parts() {
  auto learnt = learn_from(how_.parts, lessons());
  if (!learnt) {
    return std::unexpected(learnt.error());
  }
  learnt_ = std::move(learnt->learnt);
  out_.learnt = std::move(learnt->figures);
  return {};
}

Result<Predistorted> predistort(const std::string& program, const nc::interpret::Config& config,
                                const Machine& machine, const PredistortConfig& how) {
  if (how.parts.empty()) {
    return Predistortion(program, config, machine, how,
                         {.each = how.gain_uncertainty, .apart = how.gain_uncertainty})
        .run();
  }
  const auto path = nc::plan::plan_programmed_file(program, config, machine);
  if (!path) {
    return std::unexpected(path.error());
  }
  Machine shown = machine;
  auto fitted = fit_axes(how.parts,
                         {.machine = machine,
                          .config = config,
                          .original = *path,
                          .model = servo_models(machine.axes),
                          .gain_uncertainty = how.gain_uncertainty},
                         shown.axes);
  if (!fitted) {
    return std::unexpected(fitted.error());
  }
  auto out =
      Predistortion(program, config, shown, how, gains_by(*fitted, how.gain_uncertainty)).run();
  if (out) {
    out->fitted = std::move(*fitted);
  }
  return out;
}

}  // namespace steadyrest::contour::offline
