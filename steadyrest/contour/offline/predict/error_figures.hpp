// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <steadyrest/contour/offline/predict/model_run.hpp>

namespace steadyrest::contour::offline {

/// The contour error of a predicted run while it cuts, mm: of the whole, and the largest by line.
class ErrorFigures {
 public:
  explicit ErrorFigures(double limit_mm = 0.0, std::size_t others = 0)
      : limit_mm_(limit_mm), others_(others) {}

  /// `line`: of the original.
  void add(const ModelSample& sample, std::uint32_t line) {
    const double error = std::abs(sample.error_mm);
    put(nominal_, error, sample.more_mm, line);
    over_ += error > limit_mm_ ? 1U : 0U;
    for (std::size_t i = 0; i < others_.size(); ++i) {
      others_[i].add(sample.others[i].error_mm, sample.others[i].peak_mm);
    }
  }

  struct Whole {
    double max_mm = 0.0;
    double sum_mm2 = 0.0;
    std::size_t samples = 0;
    [[nodiscard]] double rms_mm() const noexcept {
      return samples == 0 ? 0.0 : std::sqrt(sum_mm2 / static_cast<double>(samples));
    }
    void add(double error_mm, double peak_mm) noexcept {
      max_mm = std::max(max_mm, peak_mm);
      sum_mm2 += error_mm * error_mm;
      ++samples;
    }
  };
  struct Of : Whole {
    std::vector<float> by_line_mm;  ///< largest, by line number
    [[nodiscard]] double line_mm(std::size_t line) const noexcept {
      return line < by_line_mm.size() ? static_cast<double>(by_line_mm[line]) : 0.0;
    }
  };
  [[nodiscard]] const Of& nominal() const noexcept { return nominal_; }
  [[nodiscard]] std::span<const Whole> others() const noexcept { return others_; }
  [[nodiscard]] double share_over() const noexcept {
    return nominal_.samples == 0
               ? 0.0
               : static_cast<double>(over_) / static_cast<double>(nominal_.samples);
  }

 private:
  static void put(Of& of, double error_mm, double more_mm, std::uint32_t line) {
    of.add(error_mm, error_mm + more_mm);
    if (line >= of.by_line_mm.size()) {
      of.by_line_mm.resize(line + 1U, 0.0F);
    }
    of.by_line_mm[line] = std::max(of.by_line_mm[line], static_cast<float>(error_mm + more_mm));
  }

  double limit_mm_;
  Of nominal_;
  std::vector<Whole> others_;
  std::size_t over_ = 0;
};

/// A program and its changed version, both predicted.
struct PredictedChange {
  double seconds_before = 0.0;
  double seconds_after = 0.0;
  ErrorFigures before;
  ErrorFigures after;
};

}  // namespace steadyrest::contour::offline
