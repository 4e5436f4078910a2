// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <steadyrest/apps/thermal_page/thermal_page.hpp>
#include <steadyrest/thermal/offline/log.hpp>

namespace steadyrest::apps::thermal_page {

/// A displacement over the temperature that follows it best, stretch by stretch of one spindle
/// speed: the paper's figure 1.
struct Hysteresis {
  struct Stretch {
    double speed_rev_s = 0.0;
    double start_s = 0.0;
    double seconds = 0.0;
    std::vector<double> temperature_c;
    std::vector<double> displacement_mm;
  };
  std::string channel;
  std::string sensor;
  double correlation = 0.0;  ///< of both over the log
  double spread_mm = 0.0;    ///< largest difference of displacement within half a kelvin
  std::vector<Stretch> stretch;
};

/// Of each displacement in the log; at most `points` rows of each stretch are kept. Empty when the
/// log has no temperature.
[[nodiscard]] std::vector<Hysteresis> hysteresis_of(const thermal::offline::Log& log,
                                                    std::size_t points = 200);

/// The page of `thermal fit`: what the temperatures alone cannot tell.
[[nodiscard]] std::string hysteresis_page(const Json& answer, const thermal::offline::Log& log);

}  // namespace steadyrest::apps::thermal_page
