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
      if (i == 0 || !use[i - 1].free || use[i - 1].stops) {
        lines_.emplace_back();
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
  /// size() for a line that belongs to none.
  [[nodiscard]] std::size_t of(std::uint32_t line) const {
    const auto found = of_.find(line);
    return found == of_.end() ? lines_.size() : found->second;
  }

 private:
  std::vector<std::vector<std::uint32_t>> lines_;
  std::map<std::uint32_t, std::size_t> of_;
};

/// The error of each run, for the model and the others beside it.
class RunErrors {
 public:
  RunErrors(const CutRuns& runs, std::size_t others)
      : runs_(&runs), models_(others + 1), sums_(models_ * runs.size()) {}

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
    if (run == runs_->size()) {
      return;
    }
    put(run, 0, std::abs(sample.error_mm), sample.more_mm);
    for (std::size_t i = 0; i < sample.other_error_mm.size(); ++i) {
      put(run, i + 1, sample.other_error_mm[i], sample.more_mm);
    }
  }

  struct Worst {
    double rms_mm = 0.0;
    double max_mm = 0.0;
  };
  /// Of the model itself.
  [[nodiscard]] double nominal_max_mm(std::size_t run) const { return sums_[run * models_].max_mm; }
  /// Over all models.
  [[nodiscard]] Worst worst(std::size_t run) const {
    Worst out;
    for (std::size_t i = 0; i < models_; ++i) {
      const Sum& sum = sums_[run * models_ + i];
      const double mean =
          sum.samples == 0 ? 0.0 : sum.square_mm2 / static_cast<double>(sum.samples);
      out.rms_mm = std::max(out.rms_mm, std::sqrt(mean));
      out.max_mm = std::max(out.max_mm, sum.max_mm);
    }
    return out;
  }

 private:
  struct Sum {
    double square_mm2 = 0.0;
    double max_mm = 0.0;
    std::size_t samples = 0;
  };
  void put(std::size_t run, std::size_t model, double error_mm, double more_mm) {
    Sum& sum = sums_[run * models_ + model];
    sum.square_mm2 += error_mm * error_mm;
    sum.max_mm = std::max(sum.max_mm, error_mm + more_mm);
    ++sum.samples;
  }

  const CutRuns* runs_;
  std::size_t models_;
  std::vector<Sum> sums_;
  std::uint32_t line_ = 0;
  std::size_t run_ = static_cast<std::size_t>(-1);
};

inline constexpr double kLargestGrows = 1.005;  ///< the program's largest error, at most

/// The runs whose error grows: the RMS or the largest over all models, or beyond the largest of the
/// whole program. That of runs that stay (`barred`) comes from their neighbours' lag: it may grow
/// as long as it is not the largest.
[[nodiscard]] inline std::vector<std::size_t> worse_runs(const CutRuns& runs,
                                                         const RunErrors& before,
                                                         const RunErrors& after,
                                                         const std::set<std::uint32_t>& barred) {
  constexpr double kRounding_mm = 5e-4;  // of the text
  constexpr double kLarger = 1.05;       // the largest error of a run, as its RMS falls
  double most_mm = 0.0;
  double nominal_mm = 0.0;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    most_mm = std::max(most_mm, before.worst(i).max_mm);
    nominal_mm = std::max(nominal_mm, before.nominal_max_mm(i));
  }
  most_mm = kLargestGrows * most_mm + kRounding_mm;
  nominal_mm = kLargestGrows * nominal_mm + kRounding_mm;
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const auto was = before.worst(i);
    const auto is = after.worst(i);
    const bool stays = std::ranges::all_of(
        runs.lines(i), [&](std::uint32_t line) { return barred.contains(line); });
    const bool grows =
        is.rms_mm > was.rms_mm + kRounding_mm || is.max_mm > kLarger * was.max_mm + kRounding_mm;
    if ((grows && !stays) || is.max_mm > most_mm || after.nominal_max_mm(i) > nominal_mm) {
      out.push_back(i);
    }
  }
  return out;
}

}  // namespace steadyrest::contour::offline
