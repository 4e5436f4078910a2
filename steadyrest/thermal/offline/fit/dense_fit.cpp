// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>

#include <steadyrest/kernel/machine/thermal.hpp>
#include <steadyrest/thermal/offline/fit/column_grid.hpp>
#include <steadyrest/thermal/offline/fit/dense_fit.hpp>
#include <steadyrest/thermal/offline/fit/structure.hpp>

// Evidence instead of choice: with gains N(0, s²) the readings are one normal vector, and its
// density integrates out the gains. With many similar sensors that is a fairer judge than the
// left-out hours, which a search among hundreds of pairs has already seen.
namespace steadyrest::thermal::offline {
namespace {

constexpr std::array<std::size_t, 3> kLag = {0, 2, 4};  ///< of the grid's
constexpr std::array kGain_um_k = {0.3, 1.0, 3.0, 10.0};
constexpr std::array kLevel_um = {10.0, 30.0, 100.0};
constexpr std::array kPower = {1, 2};
constexpr int kAlternations = 2;  ///< the error model and the rest, in turn

struct DenseCandidate {
  std::vector<std::size_t> tau;
  Structure::Usual usual;
};

/// Evidence of choices of columns, the error model taken as known.
class Evidence {
 public:
  Evidence(const FitData& data, const ErrorModel& error, const ColumnGrid& grid,
           std::size_t sensors)
      : grid_(grid) {
    Eigen::MatrixXd white = grid.columns();
    whiten(error, data.time_s, data.fresh, white);
    product_ = white.transpose() * white;
    // Column 0 is the constant: with inputs the zero is free, since lags begin at unknown
    // temperatures.
    inputs_.push_back(0);
    for (std::size_t s = 0; s < sensors; ++s) {
      for (const std::size_t l : kLag) {
        inputs_.push_back(grid.lag(s, l));
      }
    }
  }

  /// Up to a constant of the readings.
  [[nodiscard]] double of(const DenseCandidate& c) const {
    std::vector<Eigen::Index> column = inputs_;
    std::vector<double> sd(inputs_.size(), c.usual.gain_um_k);
    sd.front() = kFree;
    for (const std::size_t t : c.tau) {
      for (const int p : kPower) {
        column.push_back(grid_.power(t, p));
        sd.push_back(c.usual.level_um / grid_.fastest_krpm());
      }
      for (std::size_t s = 0; s < grid_.stretches(); ++s) {
        column.push_back(grid_.start(t, s));
        sd.push_back(c.usual.state_um);
      }
    }
    const auto p = static_cast<Eigen::Index>(column.size());
    Eigen::MatrixXd normal(p, p);
    Eigen::VectorXd right(p);
    for (Eigen::Index i = 0; i < p; ++i) {
      const auto in = static_cast<std::size_t>(i);
      for (Eigen::Index j = 0; j <= i; ++j) {
        const auto jn = static_cast<std::size_t>(j);
        // In units of the prior: S·XᵀX·S + 1 has no eigenvalue below 1, so Cholesky is safe even
        // with nearly parallel columns.
        normal(i, j) = sd[in] * sd[jn] * product_(column[in], column[jn]);
      }
      normal(i, i) += 1.0;
      right(i) = sd[in] * product_(column[in], grid_.reading());
    }
    const Eigen::LLT<Eigen::MatrixXd> root(normal);
    if (root.info() != Eigen::Success) {
      return -std::numeric_limits<double>::infinity();
    }
    const Eigen::VectorXd half = root.matrixL().solve(right);
    const double log_root = root.matrixLLT().diagonal().array().log().sum();
    // ln p = ½·yᵀX S (1 + S XᵀX S)⁻¹ S Xᵀy − ½·ln det(1 + S XᵀX S), up to a constant of y.
    return 0.5 * half.squaredNorm() - log_root;
  }

 private:
  const ColumnGrid& grid_;
  Eigen::MatrixXd product_;
  std::vector<Eigen::Index> inputs_;
};

// All combinations of modes, levels and gains: each costs one Cholesky factorisation.
DenseCandidate best(const Evidence& evidence, const std::vector<std::vector<std::size_t>>& modes,
                    std::size_t rows) {
  DenseCandidate out;
  double most = -std::numeric_limits<double>::infinity();
  for (const auto& tau : modes) {
    // A chosen time constant counts like a parameter in Bayes' criterion.
    const double chosen =
        0.5 * static_cast<double>(tau.size()) * std::log(static_cast<double>(rows));
    for (const double level : kLevel_um) {
      for (const double gain : kGain_um_k) {
        DenseCandidate c{tau, {level, gain, Structure::Usual{}.state_um}};
        const double here = evidence.of(c) - chosen;
        if (here > most) {
          most = here;
          out = std::move(c);
        }
      }
    }
  }
  return out;
}

Structure structure_of(const DenseCandidate& choice, const std::vector<std::size_t>& sensors) {
  Structure out;
  out.dense = true;
  out.usual = choice.usual;
  out.power.assign(kPower.begin(), kPower.end());
  for (const std::size_t t : choice.tau) {
    out.mode.push_back({60.0 * kGridTau_min[t], 0.0});
  }
  for (const std::size_t s : sensors) {
    for (const std::size_t l : kLag) {
      out.ambient.push_back({s, 60.0 * kGridLag_min[l]});
    }
  }
  return out;
}

}  // namespace

std::optional<Dense> dense_fit(const FitData& data, const ErrorModel& guess,
                               const SearchLimits& limits, std::size_t least_modes) {
  const std::vector<std::size_t>& sensors = limits.sensor;
  const std::size_t most = kernel::machine::kMaxThermalAmbients / kLag.size();
  // With as many sensors as a structure may take, the search has tried them all.
  if (sensors.size() <= limits.most_ambients || sensors.size() > most) {
    return std::nullopt;
  }
  const ColumnGrid grid(data, sensors);
  const auto modes = grid_modes(least_modes, limits.most_modes);
  // Two rounds are enough: the choice hardly changes once the drift is about right.
  Dense out{{}, guess};
  for (int round = 0; round < kAlternations; ++round) {
    const Evidence evidence(data, out.error, grid, sensors.size());
    out.structure = structure_of(best(evidence, modes, data.rows()), sensors);
    out.error = likely_error(columns_of(out.structure, *data.log, data.row), data,
                             wide_prior(out.structure, data));
  }
  return out;
}

}  // namespace steadyrest::thermal::offline
