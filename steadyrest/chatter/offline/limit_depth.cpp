// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <steadyrest/chatter/offline/limit_depth.hpp>

namespace steadyrest::chatter::offline {

namespace {
constexpr double kFirst = 1.0 / 256.0;  ///< of the greatest depth
constexpr double kGrowth = 0.06;        ///< step over depth
}  // namespace

std::optional<double> limit_depth_mm(DepthLine& line, double most_depth_mm) {
  double low = 0.0;
  double log_low = line.log_radius(0.0);
  while (low < most_depth_mm) {
    const double high =
        std::min(most_depth_mm, low + std::max(kFirst * most_depth_mm, kGrowth * low));
    const double log_high = line.log_radius(high);
    if (log_high >= 0.0) {
      return line.crossing_mm(low, log_low, high, log_high);
    }
    low = high;
    log_low = log_high;
  }
  return std::nullopt;
}

kernel::outcome::Result<std::optional<double>> limit_depth_mm(const Process& process,
                                                              double speed_rev_s,
                                                              const Modulation& modulation,
                                                              double most_depth_mm) {
  auto line = DepthLine::make(process, speed_rev_s, modulation, most_depth_mm);
  if (!line) {
    return std::unexpected(line.error());
  }
  return limit_depth_mm(*line, most_depth_mm);
}

}  // namespace steadyrest::chatter::offline
