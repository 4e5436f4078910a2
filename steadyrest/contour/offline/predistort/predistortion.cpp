// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <utility>

#include <steadyrest/contour/offline/predistort/command_pieces.hpp>
#include <steadyrest/contour/offline/predistort/polish/polish_rounds.hpp>
#include <steadyrest/contour/offline/predistort/predistortion.hpp>
#include <steadyrest/contour/offline/predistort/refinement.hpp>
#include <steadyrest/contour/offline/predistort/shape/segment_use.hpp>
#include <steadyrest/contour/offline/predistort/uncertainty.hpp>
#include <steadyrest/nc/rewrite/replace/at_worst.hpp>

namespace steadyrest::contour::offline {
namespace {

using kernel::outcome::Result;

constexpr int kUnitesLate = 2;      ///< PolishSweeps
constexpr double kCoarse = 0.05;    ///< of the largest shift: the fit that windows begin with
constexpr double kCoarsest = 10.0;  ///< of the limit
constexpr double kSmoothJoint =
    0.15;  ///< … and its joints that bend less have no bend where one would stop the control
constexpr int kFewestRefinements = 2;  ///< … but not fewer than this
constexpr double kRefinedTime_s = 120.0;
constexpr double kLeastShare = 0.125;  ///< of what is left, in one refinement

}  // namespace

Judging Predistortion::judging(const ServoModels& model, const OtherModels& others) {
  return {.machine = machine_,
          .original = path_,
          .model = model,
          .others = others,
          .learnt = learnt_,
          .runs = *runs_,
          .limit_mm = how_.limit_mm,
          .hold_mm = how_.hold_mm,
          .progress = [this](double share) { progress_.run(share); }};
}

Result<void> Predistortion::rounds(int count) {
  for (int round = 0; round < count; ++round) {
    auto changed = nc::rewrite::at_worst_they_stay(blocks_, [this] {
      made_ = pieces_within();
      return write(made_);
    });
    if (!changed) {
      return std::unexpected(changed.error());
    }
    if (auto done = try_text(std::move(*changed)); !done) {
      return done;
    }
  }
  return {};
}

std::vector<Piece> Predistortion::pieces_within() {
  const CommandTask task{machine_, path_, inverse_, learnt_, *caps_, tolerance_mm_, smooth_};
  std::vector<Piece> made = command_pieces(task, use(), speed_, corners_);
  while (barred_->bar_beyond(made)) {
    made = command_pieces(task, use(), speed_, corners_);
  }
  return made;
}

Result<Changed> Predistortion::write(const std::vector<Piece>& made) const {
  return write_pieces({.file = file_,
                       .config = config_,
                       .machine = machine_,
                       .blocks = blocks_,
                       .path = path_,
                       .told = how_.told,
                       .waits = waits_},
                      made);
}

std::vector<double> Predistortion::harmed_mm(const RunErrors& after) const {
  std::vector<double> out;
  for (const std::size_t run : worse_runs(*runs_, *runs_before_, after, barred_->lines(),
                                          judged_by_each() ? Guard::by_each : Guard::by_worst)) {
    for (const auto& segment : path_.segments) {
      if (runs_->of(segment.line) == run) {
        out.push_back(segment.position_mm + 0.5 * segment.length_mm);
      }
    }
  }
  return out;
}

Result<void> Predistortion::try_text(Changed changed) {
  // Windows are judged by the model alone, the stretches taken from them by all machines.
  const OtherModels none;
  const bool sketch = holds_ && by_ == HeldStretches::By::windows;
  auto run = follow(sketch ? judging(model_, none) : judging(), changed, corners_);
  if (!run) {
    return std::unexpected(run.error());
  }
  progress_.ran();
  const auto& figures = run->figures.nominal();
  // Who measures his parts wants the last micrometre: there a block and time cost nothing.
  const double blocks =
      learnt_.empty() ? static_cast<double>(changed.path.segments.size()) /
                            static_cast<double>(std::max<std::size_t>(1, path_.segments.size()))
                      : 1.0;
  const double score_mm = score_->of_mm(figures, blocks, learnt_.empty() ? run->seconds : 0.0);
  // Holding a limit may begin from anything.
  const bool in_time = holds_ || (hold_mm() > 0.0 && best_mm_ < 0.0) ||
                       score_->in_time(run->seconds, learnt_.refinements() > 0);
  last_ = {.score_mm = score_mm,
           .time = hold_mm() > 0.0 ? 1.0 : score_->time(run->seconds, learnt_.refinements() > 0)};
  if (!in_time) {
    score_->note_slower(run->seconds, figures);
  }
  if (held_) {
    held_->note(made_, *run, sketch ? std::vector<double>{} : harmed_mm(run->runs), by_);
    last_.score_mm = by_ == HeldStretches::By::windows ? held_->open_cost_s() : score_mm;
  }
  const double cost_s = held_ ? held_->cost_s(*run) : 0.0;
  const bool better = holds_ ? cost_s < best_cost_s_ : best_mm_ < 0.0 || score_mm < best_mm_;
  if (in_time && better && !sketch && figures.rms_mm() <= first_->figures.nominal().rms_mm()) {
    best_mm_ = score_mm;
    best_cost_s_ = cost_s;
    best_over_ = run->over;
    runs_after_ = std::move(run->runs);
    best_errors_ = std::move(run->errors);
    best_speed_ = speed_;
    best_ = std::move(changed);
    out_.after = std::move(run->figures);
    out_.seconds_after = run->seconds;
    out_.largest_shift_mm = best_.lines.empty() ? 0.0 : barred_->largest_shift_mm();
  }
  over_ = std::move(run->over);
  speed_ = std::move(run->speed);
  corner_mm_ = std::move(run->corner_mm);
  starts_ = std::move(run->starts);
  return {};
}

PolishTask Predistortion::polish_task() {
  PolishTask task{.machine = machine_,
                  .path = path_,
                  .models = cautious(model_, gains_.apart),
                  .price = {.limit_mm = how_.limit_mm},
                  .most_shift_mm = how_.max_shift_mm,
                  .progress = [this](double share) {
                    progress_.run(share);
                    if (share >= 1.0) {
                      progress_.ran();
                    }
                  }};
  if (!learnt_.empty()) {
    task.unknown = [this](double foot_mm) { return learnt_.unknown_mm(foot_mm); };
  }
  return task;
}

void Predistortion::be_coarse() {
  tolerance_mm_ =
      std::clamp(kCoarse * barred_->largest_shift_mm(), how_.limit_mm, kCoarsest * how_.limit_mm);
  if (machine_.control.junction_share < 1.0) {
    smooth_ = kSmoothJoint;
  }
}

void Predistortion::be_fine() {
  tolerance_mm_ = ShapeConfig{}.tolerance_mm;
  smooth_ = ShapeConfig{}.smooth;
}

std::vector<Piece> Predistortion::coarse_pieces() {
  be_coarse();
  auto out = pieces_within();
  be_fine();
  return out;
}

Result<TriedPieces> Predistortion::try_pieces(const std::vector<Piece>& made) {
  auto changed = write(made);
  if (!changed) {
    return std::unexpected(changed.error());
  }
  made_ = made;
  const auto tried = try_text(std::move(*changed));
  return tried ? Result<TriedPieces>(last_) : std::unexpected(tried.error());
}

// From the alternating arcs of a close fit the windows do not get away: they begin with a coarse
// one.
Result<void> Predistortion::polish() {
  learnt_.unrefine(0);
  caps_.emplace(path_, 1.0);
  speed_ = best_mm_ < 0.0 ? first_->speed : best_speed_;
  PolishTask task = polish_task();
  PolishSweeps sweeps;
  if (hold_mm() > 0.0) {
    task.price.time = PolishTask::kTimeToHold;
    task.price.over = kOverHeld;
  } else {
    // What parts have taught is there from the start.
    sweeps = {.patient = true, .unites_in = learnt_.empty() ? kUnitesLate : 0};
    held_.emplace(path_, use(), how_.limit_mm, HeldStretches::Price::all_errors);
  }
  auto done = polish_rounds(
      std::move(task), coarse_pieces(), starts_,
      [this](const std::vector<Piece>& made) { return try_pieces(made); }, sweeps);
  if (done && hold_mm() == 0.0) {
    // What a sweep wins in one stretch it may lose in another.
    if (const auto best = held_->best(); !best.empty()) {
      const auto tried = try_pieces(best);
      done = tried ? done : std::unexpected(tried.error());
    }
    held_.reset();
  }
  return done;
}

Result<void> Predistortion::try_corners() {
  std::vector<Corner> best = corners_;
  std::vector<double> best_mm = corner_mm_;
  for (const double beyond : kBeyond) {
    for (Corner& corner : corners_) {
      corner.beyond = beyond;
    }
    speed_ = best_speed_;
    if (auto done = rounds(1); !done) {
      return done;
    }
    for (std::size_t i = 0; i < std::min(best.size(), corner_mm_.size()); ++i) {
      if (corner_mm_[i] < best_mm[i]) {
        best_mm[i] = corner_mm_[i];
        best[i].beyond = beyond;
      }
    }
  }
  corners_ = std::move(best);
  speed_ = best_speed_;
  return rounds(kLastRounds);
}

Result<std::vector<ErrorSample>> Predistortion::left() {
  const ServoModels sure = cautious(model_, gains_.apart);
  if (sure == model_) {
    return best_errors_;
  }
  const OtherModels none;
  auto run = follow(judging(sure, none), best_, corners_);
  return run ? std::move(run->errors)
             : Result<std::vector<ErrorSample>>(std::unexpected(run.error()));
}

Result<void> Predistortion::refine() {
  const double of_all = kRefinedTime_s / std::max(kRefinedTime_s, out_.seconds_before);
  const int most = std::max(kFewestRefinements, static_cast<int>(of_all * kRefinements));
  double share = 0.5;
  for (int i = 0; i < most && best_mm_ >= 0.0 && share >= kLeastShare; ++i) {
    const double before_mm = best_mm_;
    auto errors = left();
    if (!errors) {
      return std::unexpected(errors.error());
    }
    learnt_.refine(refinement(std::move(*errors), path_, use(), model_, share));
    speed_ = best_speed_;
    if (auto done = rounds(1); !done) {
      return done;
    }
    if (best_mm_ >= before_mm) {
      learnt_.unrefine(learnt_.refinements() - 1);
      share *= 0.5;
    }
  }
  return {};
}

}  // namespace steadyrest::contour::offline
