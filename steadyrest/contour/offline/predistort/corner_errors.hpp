// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include <steadyrest/contour/offline/predict/model_run.hpp>
#include <steadyrest/contour/offline/predistort/shape/joints.hpp>

namespace steadyrest::contour::offline {

/// The largest error near each corner while the tool passes it.
class CornerErrors {
 public:
  explicit CornerErrors(const std::vector<Corner>& corners)
      : corners_(corners), error_mm_(corners.size(), 0.0) {}

  void add(const ModelSample& sample) {
    while (next_ < corners_.size() && sample.foot_mm > corners_[next_].at_mm + reach_mm(next_)) {
      ++next_;
    }
    if (sample.cuts && next_ < corners_.size() &&
        sample.foot_mm > corners_[next_].at_mm - reach_mm(next_)) {
      error_mm_[next_] = std::max(error_mm_[next_], std::abs(sample.error_mm) + sample.more_mm);
    }
  }
  std::vector<double> take() { return std::move(error_mm_); }

 private:
  static constexpr double kReach = 2.0;  ///< of the lag, that belongs to a corner
  static constexpr double kSpare_mm = 0.3;

  [[nodiscard]] double reach_mm(std::size_t i) const {
    return kReach * corners_[i].behind_mm + kSpare_mm;
  }

  const std::vector<Corner>& corners_;
  std::vector<double> error_mm_;
  std::size_t next_ = 0;
};

}  // namespace steadyrest::contour::offline
