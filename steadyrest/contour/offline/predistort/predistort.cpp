// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include <steadyrest/contour/offline/predistort/barred_lines.hpp>
#include <steadyrest/contour/offline/predistort/command_pieces.hpp>
#include <steadyrest/contour/offline/predistort/feed_caps.hpp>
#include <steadyrest/contour/offline/predistort/followed_run.hpp>
#include <steadyrest/contour/offline/predistort/phase_progress.hpp>
#include <steadyrest/contour/offline/predistort/predistort.hpp>
#include <steadyrest/contour/offline/predistort/refinement.hpp>
#include <steadyrest/contour/offline/predistort/report.hpp>
#include <steadyrest/contour/offline/predistort/round_score.hpp>
#include <steadyrest/contour/offline/predistort/shape/joints.hpp>
#include <steadyrest/contour/offline/predistort/shape/segment_use.hpp>
#include <steadyrest/contour/offline/predistort/shape/shaped_path.hpp>
#include <steadyrest/contour/offline/predistort/uncertainty.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/nc/rewrite/replace/at_worst.hpp>
#include <steadyrest/nc/rewrite/tube/prove_made.hpp>

namespace steadyrest::contour::offline {
namespace {

using kernel::machine::Machine;
using kernel::outcome::Result;

constexpr int kMostRevisions = 3;      ///< runs that must stay are found at most so often
constexpr int kLastRounds = 2;         ///< with the best share at each corner
constexpr int kRefinements = 8;        ///< of a part of two minutes; longer parts get fewer …
constexpr int kFewestRefinements = 2;  ///< … but not fewer than this
constexpr double kRefinedTime_s = 120.0;
constexpr double kLeastShare = 0.125;  ///< of what is left, in one refinement
constexpr int kMostHolds = 16;
constexpr double kLeastFeed = 0.25;  ///< of the programmed one, where feeds fall
constexpr int kHoldRounds = 2;
/// Tried at corners in addition to the default; parts that take longer are left with the default.
constexpr std::array kBeyond = {0.0, 0.3, 0.4, 0.5, 0.55, 0.65, 0.7, 0.8};
constexpr int kCornerRuns = static_cast<int>(kBeyond.size()) + kLastRounds;
constexpr double kWorthwhile = 0.25;  ///< of the limit: a run whose error is less stays
constexpr double kLongestTried_s = 1200.0;

class Predistortion {
 public:
  Predistortion(const std::string& file, const nc::interpret::Config& config,
                const Machine& machine, const PredistortConfig& how)
      : file_(file),
        config_(config),
        machine_(machine),
        how_(how),
        // What is learnt is beyond the model whose inverse is written.
        model_(how.parts.empty() ? servo_models(machine.axes)
                                 : cautious(servo_models(machine.axes), how.gain_uncertainty)),
        others_(uncertain(model_, how.gain_uncertainty)),
        inverse_(cautious(model_, how.gain_uncertainty), backlash_mm(machine.axes)),
        progress_(how.progress, 1 + how.rounds + kCornerRuns + kRefinements +
                                    (how.hold_mm > 0.0 ? kMostHolds * kHoldRounds : 0)) {}

  Result<Predistorted> run() {
    progress_.phase("predicting the error", 1);
    auto ready = read();
    ready = ready ? learn_from_parts() : ready;
    if (!ready) {
      return std::unexpected(ready.error());
    }
    barred_.emplace(path_, machine_.axes, how_.max_shift_mm);
    runs_.emplace(path_, use());
    // The control's own plan of the program as it is, on the path that the shape is made from.
    auto planned = write({});
    if (!planned) {
      return std::unexpected(planned.error());
    }
    auto before = follow(judging(), *planned, corners_);
    if (!before) {
      return std::unexpected(before.error());
    }
    out_.before = std::move(before->figures);
    out_.seconds_before = before->seconds;
    if (out_.before.nominal().samples == 0) {
      return kernel::outcome::refuse(file_, "the program cuts nothing",
                                     "give a program with feed moves");
    }
    score_.emplace(how_.most_time, out_.seconds_before, out_.before.nominal());
    first_speed_ = std::move(before->speed);
    runs_before_ = std::move(before->runs);
    for (std::size_t i = 0; i < runs_->size(); ++i) {
      if (runs_before_->worst(i).max_mm <= kWorthwhile * how_.limit_mm) {
        barred_->bar(runs_->lines(i));
      }
    }
    original_ = std::move(planned->replaced);
    if (auto done = proved(); !done) {
      return std::unexpected(done.error());
    }
    out_.lines = std::move(best_.lines);
    out_.replaced = std::move(best_.replaced);
    out_.too_far = std::move(barred_->too_far);
    out_.past_travel = std::move(barred_->past_travel);
    out_.worse = std::move(barred_->worse);
    out_.unproved = blocks_.lines_that_stay(nc::rewrite::Stays::unproved);
    out_.slower = score_->slower(out_.after.nominal());
    add_report(out_, how_.limit_mm);
    return std::move(out_);
  }

 private:
  /// The best text that the proof accepts.
  Result<void> proved() {
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

  /// Attempts until no run gets worse.
  Result<void> revise(int& revision) {
    for (const int last = revision + kMostRevisions;;) {
      best_mm_ = -1.0;
      keep_original();
      if (auto done = attempt(revision); !done) {
        return done;
      }
      if (revision++ >= last || best_mm_ < 0.0 ||
          !barred_->bar_worse(worse_runs(*runs_, *runs_before_, *runs_after_, barred_->lines()),
                              *runs_)) {
        return {};
      }
    }
  }

  /// All rounds with the blocks that may be changed now.
  Result<void> attempt(int revision) {
    speed_ = best_speed_ = first_speed_;
    caps_.emplace(path_, std::max(kLeastFeed, machine_.contour.min_ratio));
    holds_ = false;
    learnt_.unrefine(0);
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
    return hold();
  }

  /// The result is the program as it is, until a round is better.
  void keep_original() {
    best_.lines.clear();
    best_.replaced = original_;
    out_.after = out_.before;
    out_.seconds_after = out_.seconds_before;
    out_.largest_shift_mm = 0.0;
  }

  Result<void> read() {
    auto blocks = nc::rewrite::cut_blocks(file_, config_);
    if (!blocks) {
      return std::unexpected(blocks.error());
    }
    blocks_ = std::move(*blocks);
    auto path = shaped_path(file_, config_, machine_);
    if (!path) {
      return std::unexpected(path.error());
    }
    path_ = std::move(*path);
    return {};
  }

  [[nodiscard]] std::vector<SegmentUse> use() const {
    return segment_use(path_, blocks_, barred_->lines());
  }

  Result<void> learn_from_parts() {
    auto learnt = learn_from(how_.parts, {.machine = machine_,
                                          .config = config_,
                                          .original = path_,
                                          .model = model_,
                                          .gain_uncertainty = how_.gain_uncertainty});
    if (!learnt) {
      return std::unexpected(learnt.error());
    }
    learnt_ = std::move(learnt->learnt);
    out_.learnt = std::move(learnt->figures);
    return {};
  }

  [[nodiscard]] Judging judging() { return judging(model_, others_); }
  [[nodiscard]] Judging judging(const ServoModels& model, const std::vector<ServoModels>& others) {
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

  /// Rounds until the speeds agree; the best is kept.
  Result<void> rounds(int count) {
    for (int round = 0; round < count; ++round) {
      auto changed =
          nc::rewrite::at_worst_they_stay(blocks_, [this] { return write(pieces_within()); });
      if (!changed) {
        return std::unexpected(changed.error());
      }
      if (auto done = try_text(std::move(*changed)); !done) {
        return done;
      }
    }
    return {};
  }

  /// The pieces for the speed in hand; lines whose pieces would go too far are barred.
  std::vector<Piece> pieces_within() {
    const CommandTask task{machine_, path_, inverse_, learnt_, *caps_};
    std::vector<Piece> made = command_pieces(task, use(), speed_, corners_);
    while (barred_->bar_beyond(made)) {
      made = command_pieces(task, use(), speed_, corners_);
    }
    return made;
  }

  [[nodiscard]] Result<Changed> write(const std::vector<Piece>& made) const {
    return write_pieces({.file = file_,
                         .config = config_,
                         .machine = machine_,
                         .blocks = blocks_,
                         .path = path_,
                         .told = how_.told},
                        made);
  }

  Result<void> try_text(Changed changed) {
    auto run = follow(judging(), changed, corners_);
    if (!run) {
      return std::unexpected(run.error());
    }
    progress_.ran();
    const auto& figures = run->figures.nominal();
    const double score_mm = score_->of_mm(figures);
    const bool in_time = holds_ || score_->in_time(run->seconds, learnt_.refinements() > 0);
    if (!in_time) {
      score_->note_slower(run->seconds, figures);
    }
    const bool better =
        holds_ ? run->over.size() < best_over_.size() : best_mm_ < 0.0 || score_mm < best_mm_;
    if (in_time && better && figures.rms_mm() <= out_.before.nominal().rms_mm()) {
      best_mm_ = score_mm;
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
    return {};
  }

  /// Tries other shares at all corners and keeps the best at each.
  Result<void> try_corners() {
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

  /// Where the path alone does not keep the limit the feed falls.
  Result<void> hold() {
    if (how_.hold_mm <= 0.0 || best_mm_ < 0.0) {
      return {};
    }
    progress_.phase("holding the limit", kMostHolds * kHoldRounds);
    holds_ = true;
    over_ = best_over_;
    speed_ = best_speed_;
    for (int i = 0; i < kMostHolds && caps_->tighten(over_, speed_, how_.hold_mm); ++i) {
      if (auto done = rounds(kHoldRounds); !done) {
        return done;
      }
    }
    return {};
  }

  /// What the best round leaves on the model whose inverse is written (cautious()).
  Result<std::vector<ErrorSample>> left() {
    const ServoModels sure = cautious(model_, how_.gain_uncertainty);
    if (sure == model_) {
      return best_errors_;
    }
    const std::vector<ServoModels> none;
    auto run = follow(judging(sure, none), best_, corners_);
    return run ? std::move(run->errors)
               : Result<std::vector<ErrorSample>>(std::unexpected(run.error()));
  }

  /// Takes half of it away, like what a record has shown; less where that is too much.
  Result<void> refine() {
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

  const std::string& file_;
  const nc::interpret::Config& config_;
  const Machine& machine_;
  const PredistortConfig& how_;
  ServoModels model_;
  std::vector<ServoModels> others_;
  ServoInverse inverse_;
  PhaseProgress progress_;
  Learnt learnt_;
  nc::rewrite::CutBlocks blocks_;
  nc::plan::PlannedPath path_;
  nc::rewrite::Replaced original_;  ///< with nothing replaced
  CommandSpeed first_speed_;        ///< of the program as it is
  CommandSpeed speed_;              ///< of the last run
  CommandSpeed best_speed_;         ///< that the best round's pieces were made for
  Changed best_;
  std::vector<ErrorSample> best_errors_;
  std::vector<ErrorPlace> best_over_;
  std::vector<ErrorPlace> over_;  ///< of the last run
  std::optional<FeedCaps> caps_;
  bool holds_ = false;             ///< feeds may fall
  std::vector<Corner> corners_;    ///< as led in the last pieces
  std::vector<double> corner_mm_;  ///< their errors in the last run
  std::optional<RoundScore> score_;
  double best_mm_ = -1.0;
  std::optional<BarredLines> barred_;
  std::optional<CutRuns> runs_;
  std::optional<RunErrors> runs_before_;
  std::optional<RunErrors> runs_after_;  ///< of the best round
  Predistorted out_;
};

}  // namespace

Result<Predistorted> predistort(const std::string& program, const nc::interpret::Config& config,
                                const Machine& machine, const PredistortConfig& how) {
  return Predistortion(program, config, machine, how).run();
}

}  // namespace steadyrest::contour::offline
