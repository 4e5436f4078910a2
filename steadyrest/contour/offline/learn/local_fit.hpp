// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

#include <steadyrest/kernel/signal/path.hpp>

namespace steadyrest::contour::offline {

struct LocalLine {
  kernel::signal::Point value{};
  kernel::signal::Point slope_1_s{};
};

/// The straight line in time through vectors, fitted with the weights exp(−(t − t_j)²/2σ²), at t_j.
/// In the interior of evenly spaced samples the value has the response exp(−ω²σ²/2) and the slope
/// jω times that; at the ends it stays exact for straight lines. A single sample has no slope.
[[nodiscard]] LocalLine local_line(std::span<const double> time_s,
                                   std::span<const kernel::signal::Point> value, std::size_t j,
                                   double sigma_s) noexcept;

}  // namespace steadyrest::contour::offline
