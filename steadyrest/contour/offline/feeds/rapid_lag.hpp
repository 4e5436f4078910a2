// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include <steadyrest/contour/offline/predict/model_run.hpp>

namespace steadyrest::contour::offline {

/// What a rapid before a cut leaves of the contour error: the tool still follows it for a few 1/k.
/// No feed changes that:  e·exp(−k·t), e the lag along the path when the rapid ended, t the time
/// since, k the lowest gain.
class RapidLag {
 public:
  explicit RapidLag(double gain_1_s) noexcept : gain_1_s_(gain_1_s) {}

  /// The part of |ε| that the feed accounts for, mm. `feed`: the command is in a feed move.
  double of_feed_mm(const ModelSample& sample, bool feed) noexcept {
    if (!feed) {
      ended_s_ = sample.time_s;
      lag_mm_ = sample.progress_mm - sample.foot_mm;
      return 0.0;
    }
    return std::abs(sample.error_mm) - lag_mm_ * std::exp(-gain_1_s_ * (sample.time_s - ended_s_));
  }

 private:
  double gain_1_s_;
  double ended_s_ = 0.0;
  double lag_mm_ = 0.0;
};

}  // namespace steadyrest::contour::offline
