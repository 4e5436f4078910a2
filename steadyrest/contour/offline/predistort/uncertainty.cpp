// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <steadyrest/contour/offline/predistort/uncertainty.hpp>

namespace steadyrest::contour::offline {

std::vector<ServoModels> uncertain(const ServoModels& model, double share) {
  std::vector<ServoModels> out;
  for (unsigned signs = 0; share > 0.0 && signs < 8U; ++signs) {
    ServoModels other = model;
    for (std::size_t i = 0; i < 3; ++i) {
      other[i].gain_1_s *= (signs >> i & 1U) != 0U ? 1.0 + share : 1.0 - share;
    }
    out.push_back(other);
  }
  return out;
}

ServoModels cautious(const ServoModels& model, double share) {
  double low = 0.0;
  double high = 1e300;
  for (const online::AxisModel& axis : model) {
    low = std::max(low, axis.gain_1_s * (1.0 - share));
    high = std::min(high, axis.gain_1_s * (1.0 + share));
  }
  // They have a value in common where low ≤ high; else each takes its nearest to both ends.
  ServoModels out = model;
  for (online::AxisModel& axis : out) {
    const double least = axis.gain_1_s * (1.0 - share);
    const double most = axis.gain_1_s * (1.0 + share);
    axis.gain_1_s = std::clamp(0.5 * (low + high), least, most);
  }
  return out;
}

}  // namespace steadyrest::contour::offline
