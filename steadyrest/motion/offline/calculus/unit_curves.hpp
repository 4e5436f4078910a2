// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include <steadyrest/kernel/outcome/result.hpp>

/// The data of the source's figures 3 and 5 as curves, in the units of its axes.
///
/// Source and equations: unit_calculus.hpp.
namespace steadyrest::motion::offline {

struct Curve {
  std::string name;
  std::vector<double> x;
  std::vector<double> y;
};

using Curves = kernel::outcome::Result<std::vector<Curve>>;

/// Fig. 3a: counts/tick over the feed in mm/min, one curve for each control cycle.
[[nodiscard]] Curves figure_3a(double count_mm, std::span<const double> cycles_hz,
                               double max_feed_mm_min = 20000.0, std::size_t points = 101);

/// Fig. 3b: counts/tick² over the overload in g, one curve for each control cycle.
[[nodiscard]] Curves figure_3b(double count_mm, std::span<const double> cycles_hz,
                               double max_overload_g = 2.0, std::size_t points = 101);

/// Fig. 5: over the feed in mm/min, the most lines per revolution (eq. 6) and the count in µm that
/// they give (eq. 8).
[[nodiscard]] Curves figure_5(double max_frequency_hz, double lead_mm,
                              double min_feed_mm_min = 1000.0, double max_feed_mm_min = 60000.0,
                              std::size_t points = 119);

}  // namespace steadyrest::motion::offline
