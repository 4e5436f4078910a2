// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <vector>

#include <steadyrest/contour/offline/predict/model_run.hpp>
#include <steadyrest/contour/offline/predistort/shape/command_shape.hpp>
#include <steadyrest/math/geometry/path_pairing.hpp>
#include <steadyrest/nc/plan/path/planned_path.hpp>

namespace steadyrest::contour::offline {

/// Which run a line belongs to: the free blocks from one that stays, or a stop, to the next.
class CutRuns {
 public:
  CutRuns(const nc::plan::PlannedPath& path, const std::vector<SegmentUse>& use) {
    for (std::size_t i = 0; i < use.size(); ++i) {
      if (!use[i].free) {
        continue;
      }
      const bool joined = i > 0 && use[i - 1].free;
      if (!joined || use[i - 1].stops) {
        lines_.emplace_back();
        joined_.push_back(joined);
      }
      const std::uint32_t line = path.segments[i].line;
      if (of_.emplace(line, lines_.size() - 1).second) {
        lines_.back().push_back(line);
      }
    }
  }
  [[nodiscard]] std::size_t size() const noexcept { return lines_.size(); }
  [[nodiscard]] const std::vector<std::uint32_t>& lines(std::size_t run) const {
    return lines_[run];
  }
  /// It begins where the run before it ends.
  [[nodiscard]] bool is_joined(std::size_t run) const { return joined_[run]; }
  /// size() for a line that belongs to none.
  [[nodiscard]] std::size_t of(std::uint32_t line) const {
    const auto found = of_.find(line);
    return found == of_.end() ? lines_.size() : found->second;
  }

 private:
  std::vector<std::vector<std::uint32_t>> lines_;
  std::vector<bool> joined_;
  std::map<std::uint32_t, std::size_t> of_;
};

/// The error of each run, for the model and the others beside it.
class RunErrors {
 public:
  /// Behind a pause in the cut (a rapid, say) the axes still bring an error along from before. It
  /// counts in the RMS of the run that they are in, but it can be the largest only of the run that
  /// they come from.
  struct Wake {
    double lasts_s = 0.0;
    double pause_s = 0.02;  ///< without samples of a cut
  };
  RunErrors(const CutRuns& runs, std::size_t others, const Wake& wake)
      : runs_(&runs),
        models_(others + 1),
        wake_(wake),
        sums_(models_ * runs.size()),
        samples_(runs.size()) {}

  /// `line`: the command's on `original`. Where it has no run, the error is of the tool's: it is
  /// still where the run before has led it.
  void add(const ModelSample& sample, std::uint32_t line, kernel::signal::PathView original) {
    if (line != line_) {
      line_ = line;
      run_ = runs_->of(line);
    }
    const std::size_t run =
        run_ < runs_->size()
            ? run_
            : runs_->of(original[math::geometry::segment_at(original, sample.foot_mm)].line);
    if (sample.time_s > last_s_ + wake_.pause_s) {
      begin_s_ = sample.time_s;
    }
    last_s_ = sample.time_s;
    if (run == runs_->size()) {
      return;
    }
    from_ = early() && from_ < runs_->size() ? from_ : run;
    ++samples_[run];
    put(run, 0, std::abs(sample.error_mm), std::abs(sample.error_mm) + sample.more_mm);
    for (std::size_t i = 0; i < sample.others.size(); ++i) {
      put(run, i + 1, sample.others[i].error_mm, sample.others[i].peak_mm);
    }
  }

  /// The last sample is in the wake of a pause.
  [[nodiscard]] bool early() const noexcept { return since_s() < wake_.lasts_s; }
  /// From the end of the last pause to the last sample.
  [[nodiscard]] double since_s() const noexcept { return last_s_ - begin_s_; }

  struct Figures {
    double rms_mm = 0.0;
    double max_mm = 0.0;
  };
  /// 1 and the others; 0 is the model itself.
  [[nodiscard]] std::size_t models() const noexcept { return models_; }
  /// Of so many runs together.
  [[nodiscard]] Figures of(std::size_t run, std::size_t model, std::size_t runs = 1) const {
    Sum all;
    std::size_t samples = 0;
    for (std::size_t i = run; i < run + runs; ++i) {
      const Sum& sum = sums_[i * models_ + model];
      all = {.square_mm2 = all.square_mm2 + sum.square_mm2,
             .max_mm = std::max(all.max_mm, sum.max_mm)};
      samples += samples_[i];
    }
    const auto count = static_cast<double>(std::max<std::size_t>(1, samples));
    return {.rms_mm = std::sqrt(all.square_mm2 / count), .max_mm = all.max_mm};
  }
  [[nodiscard]] Figures model(std::size_t run) const { return of(run, 0); }
  /// Over all models.
  [[nodiscard]] Figures worst(std::size_t run, std::size_t runs = 1) const {
    Figures out;
    for (std::size_t i = 0; i < models_; ++i) {
      const Figures one = of(run, i, runs);
      out = {.rms_mm = std::max(out.rms_mm, one.rms_mm),
             .max_mm = std::max(out.max_mm, one.max_mm)};
    }
    return out;
  }
  /// No command wins more than this of the model's RMS without harm to another: what it does to
  /// one it does to all, and ‖before + effect‖ ≤ ‖before‖ bounds it by twice the least error.
  [[nodiscard]] double could_win_mm(std::size_t run) const {
    double least_mm = of(run, 0).rms_mm;
    for (std::size_t i = 1; i < models_; ++i) {
      least_mm = std::min(least_mm, of(run, i).rms_mm);
    }
    return 2.0 * least_mm + kRounding_mm;
  }

  static constexpr double kRounding_mm = 5e-4;  ///< of the text

 private:
  struct Sum {
    double square_mm2 = 0.0;
    double max_mm = 0.0;
  };
  void put(std::size_t run, std::size_t model, double error_mm, double peak_mm) {
    sums_[run * models_ + model].square_mm2 += error_mm * error_mm;
    double& max_mm = sums_[from_ * models_ + model].max_mm;
    max_mm = std::max(max_mm, peak_mm);
  }

  const CutRuns* runs_;
  std::size_t models_;
  Wake wake_;
  double begin_s_ = 0.0;
  double last_s_ = -1.0;
  std::vector<Sum> sums_;
  std::vector<std::size_t> samples_;
  std::uint32_t line_ = 0;
  std::size_t run_ = static_cast<std::size_t>(-1);
  std::size_t from_ =
      static_cast<std::size_t>(-1);  ///< the run whose largest error a sample can be
};

inline constexpr double kLargestGrows = 1.005;  ///< the program's largest error, at most

/// Which machines are held against each other.
enum class Guard : std::uint8_t {
  by_worst,  ///< the worst of all before and after; the program's largest of the model itself, too
  by_each    ///< each against itself
};

/// The runs whose error grows: RMS or largest, or its largest beyond that of the whole program. A
/// stop led beyond costs its run a little of what it takes off the next: two runs that share a stop
/// may be better together. The error of runs that stay (`barred`) comes from their neighbours' lag:
/// it may grow as long as it is not the largest.
[[nodiscard]] inline std::vector<std::size_t> worse_runs(const CutRuns& runs,
                                                         const RunErrors& before,
                                                         const RunErrors& after,
                                                         const std::set<std::uint32_t>& barred,
                                                         Guard guard) {
  constexpr double kRounding_mm = RunErrors::kRounding_mm;
  constexpr double kLarger = 1.05;  // the largest error of a run, as its RMS falls
  const bool each = guard == Guard::by_each;
  const std::size_t machines = each ? before.models() : 1;
  const auto of = [each](const RunErrors& errors, std::size_t run, std::size_t machine,
                         std::size_t count) {
    return each ? errors.of(run, machine, count) : errors.worst(run, count);
  };
  const auto most_mm = [&](const auto& largest_mm) {
    double most = 0.0;
    for (std::size_t i = 0; i < runs.size(); ++i) {
      most = std::max(most, largest_mm(i));
    }
    return kLargestGrows * most + kRounding_mm;
  };
  std::vector<double> most(machines);
  for (std::size_t m = 0; m < machines; ++m) {
    most[m] = most_mm([&](std::size_t i) { return of(before, i, m, 1).max_mm; });
  }
  const double nominal_mm = most_mm([&](std::size_t i) { return before.model(i).max_mm; });
  const auto grows = [&](std::size_t run, std::size_t machine, std::size_t count) {
    const auto was = of(before, run, machine, count);
    const auto is = of(after, run, machine, count);
    // What is in a wake counts elsewhere, but the largest was no less than the RMS.
    return is.rms_mm > was.rms_mm + kRounding_mm ||
           is.max_mm > kLarger * std::max(was.max_mm, was.rms_mm) + kRounding_mm;
  };
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const bool stays = std::ranges::all_of(
        runs.lines(i), [&](std::uint32_t line) { return barred.contains(line); });
    const bool shares = i + 1 < runs.size() && runs.is_joined(i + 1);
    bool worse = after.model(i).max_mm > nominal_mm;
    for (std::size_t m = 0; m < machines && !worse; ++m) {
      worse = (!stays && grows(i, m, 1) && !(shares && !grows(i, m, 2))) ||
              of(after, i, m, 1).max_mm > most[m];
    }
    if (worse) {
      out.push_back(i);
    }
  }
  return out;
}

}  // namespace steadyrest::contour::offline
