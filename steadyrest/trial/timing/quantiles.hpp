// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace steadyrest::trial::timing {

/// Median, p99.9 and worst of some values, in their unit; 0 where there are none.
struct Quantiles {
  double p50 = 0.0;
  double p999 = 0.0;
  double worst = 0.0;
};

/// A quantile is the smallest value that the given share does not exceed.
[[nodiscard]] Quantiles quantiles(std::vector<double> values);

}  // namespace steadyrest::trial::timing
