// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstddef>

#include <steadyrest/trial/timing/quantiles.hpp>

// Sorted once; a quantile is a value that occurred, none is interpolated.
namespace steadyrest::trial::timing {

Quantiles quantiles(std::vector<double> values) {
  if (values.empty()) {
    return {};
  }
  std::ranges::sort(values);
  const auto at = [&](double share) {
    // 0.999 of 1000 values is 999 of them, whatever the last bit of the product.
    const double count = std::ceil(share * static_cast<double>(values.size()) - 1e-6);
    return values[static_cast<std::size_t>(count) - 1];
  };
  return {.p50 = at(0.5), .p999 = at(0.999), .worst = values.back()};
}

}  // namespace steadyrest::trial::timing
