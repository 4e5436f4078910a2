// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <steadyrest/thermal/offline/log/log.hpp>

/// The response of a thermal mode or a lagging sensor to a log: columns for least squares, in the
/// exact steps of online::ThermalModel (a row's inputs apply until the next).
namespace steadyrest::thermal::offline {

inline constexpr double kPer_rev_s = 60.0 / 1000.0;  ///< a speed in 1000 rpm

/// x' = ((n/1000 rpm)^power − x)/τ; x = 0 at the first row and after each gap. `rest_tau_s` applies
/// while the spindle is stopped; 0 = `tau_s`.
[[nodiscard]] Eigen::VectorXd lagged_power(const Log& log, std::span<const std::size_t> rows,
                                           double power, double tau_s, double rest_tau_s = 0.0);

/// The same with x' = (s − x)/τ, s the share of place `k` in a table of levels (level_table.hpp).
[[nodiscard]] Eigen::VectorXd lagged_share(const Log& log, std::span<const std::size_t> rows,
                                           std::span<const double> table_rev_s, std::size_t k,
                                           double tau_s, double rest_tau_s = 0.0);

/// θ' = (T − θ)/τ from the first temperature on; in a hole the last one is held.
[[nodiscard]] Eigen::VectorXd lagged_temperature(const Log& log, std::span<const std::size_t> rows,
                                                 const LogChannel& channel, double tau_s);

/// The remainder of a state of 1 at `start` (0 before it, and from the next gap on).
[[nodiscard]] Eigen::VectorXd fading(const Log& log, std::span<const std::size_t> rows,
                                     std::size_t start, double tau_s, double rest_tau_s = 0.0);

/// The first row of each stretch without gaps.
[[nodiscard]] std::vector<std::size_t> stretches(const Log& log);

}  // namespace steadyrest::thermal::offline
