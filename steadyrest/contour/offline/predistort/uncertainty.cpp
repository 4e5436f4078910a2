// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <vector>

#include <steadyrest/contour/offline/predistort/uncertainty.hpp>
#include <steadyrest/math/geometry/moves.hpp>

namespace steadyrest::contour::offline {
namespace {

std::vector<online::AxisModel> corners(const online::AxisModel& model, double gain, double lag) {
  const double more_s = lag / model.gain_1_s;
  std::vector<online::AxisModel> out;
  for (const double share : {1.0 - gain, 1.0 + gain}) {
    for (const double lag_s :
         {std::max(0.0, model.velocity_lag_s - more_s), model.velocity_lag_s + more_s}) {
      out.push_back({.gain_1_s = share * model.gain_1_s,
                     .feed_forward = model.feed_forward,
                     .velocity_lag_s = lag_s});
      if (lag == 0.0) {
        break;
      }
    }
    if (gain == 0.0) {
      break;
    }
  }
  return out;
}

}  // namespace

ServoUncertainty ServoUncertainty::of(std::span<const kernel::machine::Axis> axes, double gain,
                                      std::optional<double> lag) {
  ServoUncertainty out{.gain = gain};
  for (std::size_t i = 0; i < std::min<std::size_t>(3, axes.size()); ++i) {
    out.lag[i] = lag.value_or(axes[i].velocity_lag_known ? 0.0 : kUnknownLag);
  }
  return out;
}

OtherModels uncertain(const ServoModels& model, const ServoUncertainty& by,
                      kernel::signal::PathView path) {
  OtherModels out;
  for (std::size_t i = 0; i < 3; ++i) {
    const bool at_rest = !math::geometry::moves(path, i);
    out.axis[i] = corners(model[i], at_rest ? 0.0 : by.gain, at_rest ? 0.0 : by.lag[i]);
  }
  return out.size() == 1 ? OtherModels{} : out;
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
