// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Cholesky>

#include <steadyrest/kernel/units/convert.hpp>
#include <steadyrest/thermal/offline/fit/fitted_axis.hpp>
#include <steadyrest/thermal/offline/plan/forecast.hpp>

// Bookkeeping between the fit's columns and the passport's fields, in both directions:
// fitted_axis() writes a passport, structure_of() and known_prior() read one back for another log.
namespace steadyrest::thermal::offline {

using kernel::machine::ThermalAmbient;
using kernel::machine::ThermalAxis;
using kernel::machine::ThermalMode;
using kernel::units::mm_from_um;
using kernel::units::um_from_mm;

namespace {

// The passport's table begins at 0 rpm with level 0, since the law has no heat there; a polynomial
// has no constant term for the same reason. Powers that the fit did not use are 0.
void put_levels(const Structure& structure, const Eigen::VectorXd& level_um, ThermalMode& mode) {
  if (!structure.table_rev_s.empty()) {
    mode.speed_rev_s = {0.0};
    mode.level_mm = {0.0};
    for (std::size_t k = 0; k < structure.table_rev_s.size(); ++k) {
      mode.speed_rev_s.push_back(structure.table_rev_s[k]);
      mode.level_mm.push_back(mm_from_um(level_um(static_cast<Eigen::Index>(k))));
    }
    return;
  }
  mode.polynomial_mm.assign(static_cast<std::size_t>(std::ranges::max(structure.power)), 0.0);
  for (std::size_t p = 0; p < structure.power.size(); ++p) {
    mode.polynomial_mm[static_cast<std::size_t>(structure.power[p]) - 1] =
        mm_from_um(level_um(static_cast<Eigen::Index>(p)));
  }
}

/// The places of the passport's levels and gains among the fit's; −1 for a polynomial's missing
/// first term and a table's level at 0 rpm, which are known to be zero.
std::vector<Eigen::Index> places(const Structure& structure, const ThermalMode& mode) {
  const auto levels = static_cast<Eigen::Index>(structure.levels());
  const auto gains = static_cast<Eigen::Index>(structure.ambient.size());
  const auto terms = static_cast<Eigen::Index>(structure.level_terms());
  std::vector<Eigen::Index> out;
  for (Eigen::Index first = 0; first < levels; first += terms) {
    for (std::size_t q = 1; q <= mode.polynomial_mm.size(); ++q) {
      const auto found = std::ranges::find(structure.power, static_cast<int>(q));
      out.push_back(found == structure.power.end() ? -1
                                                   : first + (found - structure.power.begin()));
    }
    for (std::size_t k = 0; k < mode.level_mm.size(); ++k) {
      out.push_back(k == 0 ? -1 : first + static_cast<Eigen::Index>(k) - 1);
    }
  }
  for (Eigen::Index j = 0; j < gains; ++j) {
    out.push_back(levels + j);
  }
  return out;
}

}  // namespace

// Written as of the log's last row: states, lagged temperatures and drift begin a forecast there.
ThermalAxis fitted_axis(const Structure& structure, const FitData& data, const LinearFit& fit,
                        const std::vector<double>& ln_tau_sd) {
  const Log& log = *data.log;
  // Rows of the columns at the log's two ends: each parameter's contribution to state and zero
  // there.
  const std::array last = {data.row.back()};
  const Eigen::VectorXd end = columns_of(structure, log, last).row(0);
  const std::array begin = {data.row.front()};
  const Eigen::VectorXd start = columns_of(structure, log, begin).row(0);
  const Eigen::VectorXd& a = fit.amplitude;
  const auto levels = static_cast<Eigen::Index>(structure.levels());
  const auto gains = static_cast<Eigen::Index>(structure.ambient.size());
  const auto terms = static_cast<Eigen::Index>(structure.level_terms());
  const auto starts = static_cast<Eigen::Index>(log.gap.size()) + 1;
  const Eigen::Index first_state = levels + gains + 1;
  ThermalAxis out;
  out.noise_mm = mm_from_um(data.noise_um);
  out.max_speed_rev_s = data.fastest_rev_s;
  for (std::size_t m = 0; m < structure.mode.size(); ++m) {
    const auto i = static_cast<Eigen::Index>(m);
    ThermalMode mode;
    mode.tau_s = structure.mode[m].tau_s;
    mode.rest_tau_s = structure.mode[m].rest_tau_s;
    mode.tau_sd_ratio = m < ln_tau_sd.size() ? ln_tau_sd[m] : 0.0;
    put_levels(structure, a.segment(i * terms, terms), mode);
    // The state of a mode at the log's end: the contribution of the levels plus the remainder of
    // each stretch's initial state.
    const auto from_levels = a.segment(i * terms, terms).dot(end.segment(i * terms, terms));
    const Eigen::Index state = first_state + i * starts;
    mode.state_mm =
        mm_from_um(from_levels + a.segment(state, starts).dot(end.segment(state, starts)));
    out.mode.push_back(std::move(mode));
  }
  double zero_um = data.zero_um + a(levels + gains);
  for (Eigen::Index j = 0; j < gains; ++j) {
    const Structure::Ambient& from = structure.ambient[static_cast<std::size_t>(j)];
    ThermalAmbient ambient;
    ambient.sensor = log.temperature[from.sensor].name;
    ambient.tau_s = from.tau_s;
    ambient.gain_mm_k = mm_from_um(a(levels + j));
    ambient.reference_c = start(levels + j);
    ambient.state_c = end(levels + j);
    // Gains count from the temperature at the first reading, so their share there moves into the
    // zero.
    zero_um += a(levels + j) * start(levels + j);
    out.ambient.push_back(std::move(ambient));
  }
  out.zero_mm = mm_from_um(zero_um);
  const std::vector<Eigen::Index> place = places(structure, out.mode.front());
  for (std::size_t r = 0; r < place.size(); ++r) {
    for (std::size_t c = 0; c <= r; ++c) {
      // In µm² as the lower triangle, in the passport's own order of parameters.
      out.covariance.push_back(place[r] < 0 || place[c] < 0 ? 0.0
                                                            : fit.covariance(place[r], place[c]));
    }
  }
  return out;
}

// A passport with a table keeps it; powers count only where there is none.
Structure structure_of(const ThermalAxis& axis, const Log& log) {
  Structure out;
  std::size_t powers = 1;
  for (const ThermalMode& mode : axis.mode) {
    out.mode.push_back({mode.tau_s, mode.rest_tau_s});
    powers = std::max(powers, mode.polynomial_mm.size());
    for (const double speed : mode.speed_rev_s) {
      if (speed > 0.0) {
        out.table_rev_s.push_back(speed);
      }
    }
  }
  // Modes may have different tables; the fit works with the union of their speeds.
  std::ranges::sort(out.table_rev_s);
  const auto twice = std::ranges::unique(out.table_rev_s);
  out.table_rev_s.erase(twice.begin(), twice.end());
  out.power.clear();
  for (std::size_t p = 1; p <= powers; ++p) {
    out.power.push_back(static_cast<int>(p));
  }
  for (const ThermalAmbient& ambient : axis.ambient) {
    const auto found = std::ranges::find(log.temperature, ambient.sensor, &LogChannel::name);
    if (found != log.temperature.end()) {
      out.ambient.push_back(
          {static_cast<std::size_t>(found - log.temperature.begin()), ambient.tau_s});
    }
  }
  return out;
}

void known_prior(const ThermalAxis& axis, double unsure, const Structure& structure,
                 LinearPrior& prior) {
  constexpr double kLeast = 0.05;
  std::vector<double> mean;
  std::vector<Eigen::Index> place;  // in the passport's covariance; -1: not included
  Eigen::Index first = 0;
  const auto model = online::ThermalModel::make(axis);
  for (std::size_t m = 0; m < axis.mode.size(); ++m) {
    const ThermalMode& mode = axis.mode[m];
    // By the model itself, so that a speed missing from this mode's table is interpolated.
    for (const double speed : structure.table_rev_s) {
      online::Drive drive;
      drive.speed_rev_s = speed;
      mean.push_back(model ? um_from_mm(model->level_mm(m, drive)) : 0.0);
      const auto at = std::ranges::find(mode.speed_rev_s, speed);
      place.push_back(at == mode.speed_rev_s.end() ? -1 : first + (at - mode.speed_rev_s.begin()));
    }
    for (std::size_t p = 0; p < structure.power.size() && structure.table_rev_s.empty(); ++p) {
      const bool has = p < mode.polynomial_mm.size();
      mean.push_back(has ? um_from_mm(mode.polynomial_mm[p]) : 0.0);
      place.push_back(has ? first + static_cast<Eigen::Index>(p) : -1);
    }
    first += static_cast<Eigen::Index>(mode.level_mm.size() + mode.polynomial_mm.size());
  }
  for (const ThermalAmbient& ambient : axis.ambient) {
    mean.push_back(um_from_mm(ambient.gain_mm_k));
    place.push_back(first++);
  }
  const Eigen::MatrixXd covariance = covariance_um2(axis);
  const auto n = static_cast<Eigen::Index>(mean.size());
  Eigen::MatrixXd spread = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto in = static_cast<std::size_t>(i);
    for (Eigen::Index j = 0; j < n && place[in] >= 0; ++j) {
      const Eigen::Index to = place[static_cast<std::size_t>(j)];
      spread(i, j) = to < 0 ? 0.0 : covariance(place[in], to);
    }
    // Two sources of doubt: the test's own covariance, and a machine that has changed by 15 %
    // since.
    const double changed = std::max(unsure * std::abs(mean[in]), kLeast);
    spread(i, i) += changed * changed;
    prior.mean(i) = mean[in];
  }
  const Eigen::LLT<Eigen::MatrixXd> root(spread);
  // Precision = L⁻ᵀ·L⁻¹, so L⁻¹ is its root.
  prior.root.topLeftCorner(n, n) = root.matrixL().solve(Eigen::MatrixXd::Identity(n, n)).eval();
}

// A cold start at the fastest speed: the largest extrapolation of every parameter.
double horizon_sd_um(const ThermalAxis& axis, double horizon_s) {
  const auto model = online::ThermalModel::make(axis);
  if (!model) {
    return 0.0;
  }
  Uncertainty uncertainty(*model);
  const Uncertainty::Answer cold = uncertainty.answer();
  online::Drive drive;
  drive.speed_rev_s = axis.max_speed_rev_s;
  for (std::size_t j = 0; j < axis.ambient.size(); ++j) {
    drive.ambient_c[j] = axis.ambient[j].reference_c;
  }
  online::ThermalModel::State state = model->state();
  state.mode_mm.fill(0.0);
  uncertainty.step(horizon_s, drive, state);
  return um_from_mm(std::sqrt(uncertainty.parameter_variance_mm2(cold)));
}

}  // namespace steadyrest::thermal::offline
