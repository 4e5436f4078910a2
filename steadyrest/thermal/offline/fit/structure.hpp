// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <steadyrest/thermal/offline/fit/fit_data.hpp>

namespace steadyrest::thermal::offline {

inline constexpr double kFree = 1e5;  ///< µm: wide enough to be no prior

/// What defines a fitted model, except for its linear parameters.
struct Structure {
  struct Mode {
    double tau_s = 3600.0;
    double rest_tau_s = 0.0;  ///< 0 = the same
  };
  struct Ambient {
    std::size_t sensor = 0;  ///< of the log's temperatures
    double tau_s = 0.0;
  };
  /// Usual sizes: standard deviations of the prior.
  struct Usual {
    double level_um = 200.0;  ///< of each power's part of a mode's level, at the fastest speed
    double gain_um_k = 30.0;
    double state_um = 30.0;
  };
  std::vector<Mode> mode;
  std::vector<int> power = {1};  ///< of the speed, in each mode's level
  /// If not empty: levels at these speeds (ascending, none 0) instead of powers of the speed.
  std::vector<double> table_rev_s;
  std::vector<Ambient> ambient;
  bool dense = false;  ///< all temperatures, with fixed lags; small gains are usual
  Usual usual;

  /// Linear parameters of the passport: levels, then gains.
  [[nodiscard]] std::size_t levels() const noexcept { return mode.size() * level_terms(); }
  /// Of one mode.
  [[nodiscard]] std::size_t level_terms() const noexcept {
    return table_rev_s.empty() ? power.size() : table_rev_s.size();
  }
  [[nodiscard]] std::size_t linear() const noexcept { return levels() + ambient.size(); }
  /// All that is fitted, except for the log's initial states.
  [[nodiscard]] std::size_t parameters() const noexcept;
};

inline constexpr double kLeastTau_s = 2.0 * 60.0;
inline constexpr double kMostTau_s = 600.0 * 60.0;
inline constexpr double kSeparation = 2.0;  ///< of the modes' time constants, at least

/// The columns of least squares over rows of the log: levels mode by mode, gains, a constant, then
/// for each mode and each stretch of the log its initial state.
[[nodiscard]] Eigen::MatrixXd columns_of(const Structure& structure, const Log& log,
                                         std::span<const std::size_t> rows);

}  // namespace steadyrest::thermal::offline
