// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>
#include <utility>

#include <steadyrest/contour/offline/predistort/command_shape.hpp>
#include <steadyrest/contour/offline/predistort/corner_errors.hpp>
#include <steadyrest/contour/offline/predistort/joints.hpp>
#include <steadyrest/contour/offline/predistort/predistort.hpp>
#include <steadyrest/contour/offline/predistort/run_errors.hpp>
#include <steadyrest/contour/offline/predistort/segment_use.hpp>
#include <steadyrest/contour/offline/predistort/shift.hpp>
#include <steadyrest/contour/offline/predistort/small_rounding.hpp>
#include <steadyrest/contour/offline/predistort/uncertainty.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/nc/interpret/program.hpp>
#include <steadyrest/nc/plan/path/limits.hpp>
#include <steadyrest/nc/plan/path/path_builder.hpp>

namespace steadyrest::contour::offline {
namespace {

using kernel::machine::Machine;
using kernel::outcome::Result;
using nc::rewrite::CutBlock;
using nc::rewrite::Stays;

constexpr double kAcrossShare = 0.9;  ///< of the acceleration across the path, for kinks
constexpr double kWorse_mm = 5e-4;    ///< an error that grows by less is rounding of the text
constexpr double kLarger = 1.05;   ///< of its largest error, which a run may get as its RMS falls
constexpr int kMostRevisions = 3;  ///< runs that must stay are found at most so often
constexpr int kLastRounds = 2;     ///< with the best share at each corner
constexpr std::size_t kMostRemaining = 1000;
/// Tried at corners besides the default; parts that take longer are left with the default.
constexpr std::array kBeyond = {0.0, 0.3, 0.4, 0.5, 0.55, 0.65, 0.7, 0.8};
constexpr double kWorthwhile = 0.25;      ///< of the limit: a run whose error is less stays
constexpr double kMostTime = 1.02;        ///< of the program's own; a slower round does not count
constexpr double kShareOfLargest = 0.05;  ///< of the largest error, in the choice of a round
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
        inverse_(cautious(model_, how.gain_uncertainty), backlash_mm(machine.axes)) {}

  Result<Predistorted> run() {
    if (auto read = this->read(); !read) {
      return std::unexpected(read.error());
    }
    if (auto done = learn_from_parts(); !done) {
      return std::unexpected(done.error());
    }
    runs_.emplace(path_, use());
    // The control's own plan of the program as it is, on the path that the shape is made from.
    auto planned = write({});
    if (!planned) {
      return std::unexpected(planned.error());
    }
    auto before = follow(planned->path, {.start_mm = planned->start_mm, .end_mm = planned->end_mm},
                         planned->replaced.origin);
    if (!before) {
      return std::unexpected(before.error());
    }
    out_.before = std::move(before->figures);
    out_.seconds_before = before->seconds;
    if (out_.before.nominal().samples == 0) {
      return kernel::outcome::refuse(file_, "the program cuts nothing",
                                     "give a program with feed moves");
    }
    first_speed_ = std::move(before->speed);
    runs_before_ = std::move(before->runs);
    for (std::size_t i = 0; i < runs_->size(); ++i) {
      if (runs_before_->worst(i).max_mm <= kWorthwhile * how_.limit_mm) {
        barred_.insert(runs_->lines(i).begin(), runs_->lines(i).end());
      }
    }
    keep_original(std::move(planned->replaced));
    for (int revision = 0; revision <= kMostRevisions; ++revision) {
      speed_ = best_speed_ = first_speed_;
      if (auto done = rounds(how_.rounds); !done) {
        return std::unexpected(done.error());
      }
      if (revision == 0 && !corners_.empty() && out_.seconds_before < kLongestTried_s) {
        if (auto done = try_corners(); !done) {
          return std::unexpected(done.error());
        }
      }
      if (best_mm_ < 0.0 || !bar_worse()) {
        break;
      }
      // What was found has blocks that must stay.
      best_mm_ = -1.0;
      keep_original({});
    }
    report();
    return std::move(out_);
  }

 private:
  /// The result is the program as it is, until a round is better.
  void keep_original(nc::rewrite::Replaced replaced) {
    if (!replaced.text.empty()) {
      original_ = std::move(replaced);
    }
    out_.replaced = original_;
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
    // Merged lines would have no segment of their own. The changed program is planned as it is.
    shaped_as_ = machine_;
    shaped_as_.control.merge_share = 0.0;
    nc::plan::PathBuilder builder(shaped_as_);
    WithoutSmallRounding moves(builder);
    const auto report = nc::interpret::run_file(file_, config_, moves);
    if (!report) {
      return std::unexpected(report.error());
    }
    if (!report->refused.empty()) {
      return std::unexpected(nc::interpret::first_refusal(*report, file_));
    }
    auto path = builder.take();
    if (!path) {
      kernel::outcome::Refusal refusal = path.error();
      refusal.file = file_;
      return std::unexpected(std::move(refusal));
    }
    path_ = std::move(*path);
    for (const CutBlock& block : blocks_.blocks) {
      if (block.stays != Stays::free) {
        out_.stays[block.stays].push_back(block.line);
      }
    }
    return {};
  }

  [[nodiscard]] std::vector<SegmentUse> use() const { return segment_use(path_, blocks_, barred_); }

  /// What records have shown beyond the model.
  [[nodiscard]] std::function<kernel::signal::Point(double)> unknown() const {
    if (learnt_.empty()) {
      return nullptr;
    }
    return [this](double foot_mm) { return learnt_.unknown_mm(foot_mm); };
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

  Result<FollowedRun> follow(const nc::plan::PlannedPath& path, const PathMap& map,
                             const std::vector<std::uint32_t>& origin) {
    FollowedRun run{.figures = ErrorFigures(how_.limit_mm, others_.size()),
                    .speed = {},
                    .corner_mm = {},
                    .runs = RunErrors(*runs_, others_.size())};
    CornerErrors corner_errors(corners_);
    const auto seconds = run_model({.machine = machine_,
                                    .path = path,
                                    .original = path_,
                                    .map = map,
                                    .model = model_,
                                    .others = others_,
                                    .backlash_mm = backlash_mm(machine_.axes),
                                    .unknown = unknown()},
                                   [&](const ModelSample& sample) {
                                     run.speed.add(sample.progress_mm, sample.command_mm_s);
                                     corner_errors.add(sample);
                                     if (sample.cuts) {
                                       const std::uint32_t line = sample.line < origin.size()
                                                                      ? origin[sample.line]
                                                                      : sample.line;
                                       run.figures.add(sample, line);
                                       run.runs.add(sample, line);
                                     }
                                   });
    if (!seconds) {
      return std::unexpected(seconds.error());
    }
    run.seconds = *seconds;
    run.corner_mm = corner_errors.take();
    return run;
  }

  /// The pieces for a command at this speed.
  std::vector<Piece> pieces(const std::vector<SegmentUse>& use, const CommandSpeed& speed) {
    const ToolMotion motion(inverse_, path_, speed);
    const nc::plan::PathLimits limits(machine_.axes, machine_.control);
    ShapeConfig shape;
    shape.across_mm_s2 = kAcrossShare * limits.centripetal_share() *
                         limits.plane({0.0, 0.0, 1.0}).acceleration_mm_s2;
    auto made = CommandShape(path_, use, inverse_, motion, learnt_, shape).pieces();
    made = lead_corners(made, motion, corners_);
    return round_kinks(made, limits, kAcrossShare);
  }

  /// Rounds until the speeds agree; the best is kept.
  Result<void> rounds(int count) {
    auto use = this->use();
    for (int round = 0; round < count; ++round) {
      how_.progress(static_cast<double>(done_++) / ((kMostRevisions + 1) * how_.rounds), "shaping");
      std::vector<Piece> made = pieces(use, speed_);
      const Shift shift = shift_of(path_, made, how_.max_shift_mm);
      if (!shift.too_far.empty()) {
        out_.too_far.insert(out_.too_far.end(), shift.too_far.begin(), shift.too_far.end());
        barred_.insert(shift.too_far.begin(), shift.too_far.end());
        use = this->use();
        made = pieces(use, speed_);
      }
      if (auto done = try_pieces(made, shift.largest_mm); !done) {
        return done;
      }
    }
    return {};
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

  Result<void> try_pieces(const std::vector<Piece>& made, double shift_mm) {
    auto changed = write(made);
    if (!changed) {
      return std::unexpected(changed.error());
    }
    auto run = follow(changed->path, {.start_mm = changed->start_mm, .end_mm = changed->end_mm},
                      changed->replaced.origin);
    if (!run) {
      return std::unexpected(run.error());
    }
    const auto& figures = run->figures.nominal();
    const double score_mm = figures.rms_mm() + kShareOfLargest * figures.max_mm;
    const bool counts = run->seconds <= kMostTime * out_.seconds_before &&
                        figures.rms_mm() <= out_.before.nominal().rms_mm();
    if (counts && (best_mm_ < 0.0 || score_mm < best_mm_)) {
      best_mm_ = score_mm;
      runs_after_ = std::move(run->runs);
      best_speed_ = speed_;
      out_.replaced = std::move(changed->replaced);
      out_.after = std::move(run->figures);
      out_.seconds_after = run->seconds;
      out_.largest_shift_mm = std::min(shift_mm, how_.max_shift_mm);
    }
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

  /// Runs whose error grows, over all models, stay. True when there are new ones.
  bool bar_worse() {
    bool fresh = false;
    for (std::size_t i = 0; i < runs_->size(); ++i) {
      const auto before = runs_before_->worst(i);
      const auto after = runs_after_->worst(i);
      if (after.rms_mm <= before.rms_mm + kWorse_mm &&
          after.max_mm <= kLarger * before.max_mm + kWorse_mm) {
        continue;
      }
      for (const std::uint32_t line : runs_->lines(i)) {
        fresh = barred_.insert(line).second || fresh;
        out_.worse.push_back(line);
      }
    }
    return fresh;
  }

  void report() {
    const auto worst = [](const ErrorFigures& figures, auto&& value) {
      double most = value(figures.nominal());
      for (const auto& of : figures.others()) {
        most = std::max(most, value(of));
      }
      return most;
    };
    const auto largest = [](const ErrorFigures::Of& of) { return of.max_mm; };
    const auto rms = [](const ErrorFigures::Of& of) { return of.rms_mm(); };
    out_.worst_before_mm = worst(out_.before, largest);
    out_.worst_after_mm = worst(out_.after, largest);
    out_.worst_rms_before_mm = worst(out_.before, rms);
    out_.worst_rms_after_mm = worst(out_.after, rms);
    const auto& after = out_.after.nominal();
    for (std::size_t line = 0; line < after.by_line_mm.size(); ++line) {
      if (after.line_mm(line) > how_.limit_mm) {
        out_.remaining.push_back({.line = static_cast<std::uint32_t>(line),
                                  .before_mm = out_.before.nominal().line_mm(line),
                                  .after_mm = after.line_mm(line)});
      }
    }
    std::ranges::stable_sort(out_.remaining, std::ranges::greater{}, &Remaining::after_mm);
    out_.remaining.resize(std::min(out_.remaining.size(), kMostRemaining));
    std::ranges::sort(out_.worse);
    std::ranges::sort(out_.too_far);
  }

  const std::string& file_;
  const nc::interpret::Config& config_;
  const Machine& machine_;
  const PredistortConfig& how_;
  ServoModels model_;
  std::vector<ServoModels> others_;
  ServoInverse inverse_;
  Learnt learnt_;
  Machine shaped_as_;
  nc::rewrite::CutBlocks blocks_;
  nc::plan::PlannedPath path_;
  nc::rewrite::Replaced original_;  ///< with nothing replaced
  CommandSpeed first_speed_;        ///< of the program as it is
  CommandSpeed speed_;              ///< of the last run
  CommandSpeed best_speed_;         ///< that the best round's pieces were made for
  std::vector<Corner> corners_;     ///< as led in the last pieces
  std::vector<double> corner_mm_;   ///< their errors in the last run
  double best_mm_ = -1.0;
  int done_ = 0;
  std::set<std::uint32_t> barred_;  ///< lines that stay after all
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
