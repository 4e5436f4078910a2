// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <steadyrest/thermal/offline/log/log.hpp>

/// What temperatures alone reveal about a displacement: the paper's figure 1.
namespace steadyrest::apps::page {

/// Rows of a log with the spindle at one speed: a duty regime, or a rest.
struct Regime {
  double speed_rev_s = 0.0;
  double start_s = 0.0;
  double seconds = 0.0;
  std::vector<std::size_t> row;  ///< thinned
};

/// At most `points` rows of each regime; a stretch shorter than five minutes is not a regime.
[[nodiscard]] std::vector<Regime> regimes_of(const thermal::offline::Log& log,
                                             std::size_t points = 200);

/// A displacement over one temperature, over all rows where both are known.
struct Hysteresis {
  std::string sensor;
  double correlation = 0.0;
  /// The least-squares line: displacement = mean + slope·(T − mean T).
  double mean_mm = 0.0;
  double mean_c = 0.0;
  double slope_mm_k = 0.0;
  double residual_mm = 0.0;   ///< RMS of the line's residual
  double spread_mm = 0.0;     ///< largest difference of displacement within half a kelvin,
  double spread_at_c = 0.0;   ///< found here,
  double spread_from_mm = 0;  ///< from here upwards
};

/// Over each temperature of the log, in its order.
[[nodiscard]] std::vector<Hysteresis> hysteresis_of(const thermal::offline::Log& log,
                                                    const thermal::offline::LogChannel& channel);

/// The temperature that the displacement follows best, by |correlation|; there must be one.
[[nodiscard]] std::size_t best_of(const std::vector<Hysteresis>& all);

}  // namespace steadyrest::apps::page
