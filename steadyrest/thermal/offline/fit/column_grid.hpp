// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include <steadyrest/thermal/offline/fit/fit_data.hpp>

namespace steadyrest::thermal::offline {

inline constexpr std::array kGridTau_min = {3.0,  6.0,   12.0,  20.0,  30.0,  40.0, 55.0,
                                            80.0, 120.0, 180.0, 280.0, 420.0, 600.0};
inline constexpr std::array kGridLag_min = {0.0, 20.0, 60.0, 150.0, 400.0};

/// The columns of least squares for every time constant of a grid, so that a structure is a choice
/// of columns: 1; for each time constant a mode's response to the speed and to its square (the
/// square divided by the fastest speed, in 1000 rev/min) and the remainder of each stretch's
/// initial state; for each temperature, less its mean, each lag; last the readings, µm.
class ColumnGrid {
 public:
  ColumnGrid(const FitData& data, const std::vector<std::size_t>& sensors);

  [[nodiscard]] const Eigen::MatrixXd& columns() const noexcept { return columns_; }
  [[nodiscard]] Eigen::Index reading() const noexcept { return columns_.cols() - 1; }
  [[nodiscard]] std::size_t stretches() const noexcept { return stretches_; }
  /// `power` is 1 or 2.
  [[nodiscard]] Eigen::Index power(std::size_t tau, int power) const noexcept {
    return static_cast<Eigen::Index>(1 + tau * (2 + stretches_)) + power - 1;
  }
  [[nodiscard]] Eigen::Index start(std::size_t tau, std::size_t stretch) const noexcept {
    return static_cast<Eigen::Index>(1 + tau * (2 + stretches_) + 2 + stretch);
  }
  /// `sensor` among the given ones.
  [[nodiscard]] Eigen::Index lag(std::size_t sensor, std::size_t lag) const noexcept {
    return static_cast<Eigen::Index>(1 + kGridTau_min.size() * (2 + stretches_) +
                                     sensor * kGridLag_min.size() + lag);
  }
  [[nodiscard]] double fastest_krpm() const noexcept { return fastest_krpm_; }

 private:
  std::size_t stretches_;
  double fastest_krpm_ = 0.1;
  Eigen::MatrixXd columns_;
};

/// Sets of up to `most` time constants of the grid that are far enough apart, by their places.
[[nodiscard]] std::vector<std::vector<std::size_t>> grid_modes(std::size_t least, std::size_t most);

}  // namespace steadyrest::thermal::offline
