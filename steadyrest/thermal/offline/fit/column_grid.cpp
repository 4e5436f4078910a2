// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <steadyrest/thermal/offline/fit/column_grid.hpp>
#include <steadyrest/thermal/offline/fit/structure.hpp>
#include <steadyrest/thermal/offline/log/lagged.hpp>

// All columns that a search could need, made once: powers of the speed lagged by each time constant
// of the grid, the decay of each starting state, temperatures with each lag, and the readings last.
// A candidate is then a choice of columns, and its fit a choice of rows of their products.
namespace steadyrest::thermal::offline {
namespace {

constexpr double kKrpmPer_rev_s = 0.06;

void more_modes(std::vector<std::size_t>& chosen, std::size_t least, std::size_t most,
                std::vector<std::vector<std::size_t>>& out) {
  if (chosen.size() >= least) {
    out.push_back(chosen);
  }
  if (chosen.size() == most) {
    return;
  }
  for (std::size_t t = chosen.empty() ? 0 : chosen.back() + 1; t < kGridTau_min.size(); ++t) {
    // Closer ones would split one body into two modes of opposite sign.
    if (chosen.empty() || kGridTau_min[t] >= kSeparation * kGridTau_min[chosen.back()]) {
      chosen.push_back(t);
      more_modes(chosen, least, most, out);
      chosen.pop_back();
    }
  }
}

}  // namespace

ColumnGrid::ColumnGrid(const FitData& data, const std::vector<std::size_t>& sensors)
    : stretches_(offline::stretches(*data.log).size()) {
  const Log& log = *data.log;
  const auto starts = offline::stretches(log);
  const std::size_t count =
      1 + kGridTau_min.size() * (2 + stretches_) + sensors.size() * kGridLag_min.size();
  columns_.resize(static_cast<Eigen::Index>(data.rows()), static_cast<Eigen::Index>(count) + 1);
  columns_.col(0).setOnes();
  fastest_krpm_ = std::max(fastest_krpm_, data.fastest_rev_s * kKrpmPer_rev_s);
  for (std::size_t t = 0; t < kGridTau_min.size(); ++t) {
    const double tau_s = 60.0 * kGridTau_min[t];
    columns_.col(power(t, 1)) = lagged_power(log, data.row, 1.0, tau_s);
    // Scaled by the fastest speed, so that the coefficients of n and n² are similar in size and one
    // prior suits both.
    columns_.col(power(t, 2)) = lagged_power(log, data.row, 2.0, tau_s) / fastest_krpm_;
    for (std::size_t s = 0; s < stretches_; ++s) {
      columns_.col(start(t, s)) = fading(log, data.row, starts[s], tau_s);
    }
  }
  for (std::size_t s = 0; s < sensors.size(); ++s) {
    for (std::size_t l = 0; l < kGridLag_min.size(); ++l) {
      const Eigen::VectorXd v =
          lagged_temperature(log, data.row, log.temperature[sensors[s]], 60.0 * kGridLag_min[l]);
      // Without its mean, so that an input is not the constant in disguise.
      columns_.col(lag(s, l)) = v.array() - v.mean();
    }
  }
  columns_.rightCols(1) = data.reading_um;
}

std::vector<std::vector<std::size_t>> grid_modes(std::size_t least, std::size_t most) {
  std::vector<std::vector<std::size_t>> out;
  std::vector<std::size_t> chosen;
  more_modes(chosen, least, most, out);
  return out;
}

}  // namespace steadyrest::thermal::offline
