// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <steadyrest/thermal/offline/plan/forecast.hpp>

// Uncertainty by the first derivative: δ is linear in levels and gains, so φ = ∂δ/∂p is exact there
// and obeys the modes' own equation with unit levels; time constants enter by ∂x/∂ln τ. The
// variance is φᵀ·C·φ plus each τ's own share.
namespace steadyrest::thermal::offline {
namespace {

using kernel::machine::ThermalAxis;
using kernel::machine::ThermalMode;

constexpr double kUm2PerMm2 = 1e6;

}  // namespace

Eigen::MatrixXd covariance_um2(const ThermalAxis& axis) {
  const std::size_t n = axis.parameters();
  Eigen::MatrixXd out =
      Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(n), static_cast<Eigen::Index>(n));
  auto next = axis.covariance.begin();
  for (Eigen::Index row = 0; row < out.rows() && next != axis.covariance.end(); ++row) {
    // The passport stores the lower triangle, row by row.
    for (Eigen::Index column = 0; column <= row; ++column, ++next) {
      out(row, column) = *next;
      out(column, row) = *next;
    }
  }
  return out;
}

namespace {

std::size_t linear(const ThermalMode& mode) {
  return mode.level_mm.size() + mode.polynomial_mm.size();
}

/// For each linear parameter a mode in which only it is 1: the final level per unit. Uses the law's
/// own code with a 1 in one place, table or polynomial, ratios included, so nothing is
/// differentiated by hand.
std::vector<online::ThermalModel> unit_models(const ThermalAxis& axis) {
  std::vector<online::ThermalModel> out;
  for (const ThermalMode& mode : axis.mode) {
    for (std::size_t k = 0; k < linear(mode); ++k) {
      ThermalAxis alone;
      alone.mode.push_back(mode);
      ThermalMode& m = alone.mode.front();
      m.feed_s = 0.0;
      std::ranges::fill(m.level_mm, 0.0);
      std::ranges::fill(m.polynomial_mm, 0.0);
      (m.level_mm.empty() ? m.polynomial_mm : m.level_mm)[k] = 1.0;
      if (auto made = online::ThermalModel::make(alone)) {  // as the whole could be made
        out.push_back(std::move(*made));
      }
    }
  }
  return out;
}

}  // namespace

Uncertainty::Uncertainty(const online::ThermalModel& model)
    : model_(model),
      unit_(unit_models(model.config())),
      covariance_um2_(covariance_um2(model.config())),
      phi_(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(model.config().parameters()))),
      by_tau_mm_(model.config().mode.size(), 0.0),
      ambient_start_c_(model.config().ambient.size(), std::numeric_limits<double>::quiet_NaN()) {
  for (std::size_t j = 0; j < ambient_start_c_.size(); ++j) {
    ambient_start_c_[j] = model.state().ambient_c[j];
  }
}

void Uncertainty::step(double elapsed_s, const online::Drive& drive,
                       const online::ThermalModel::State& before) {
  const ThermalAxis& config = model_.config();
  model_.restore(before);
  Eigen::Index p = 0;
  for (std::size_t i = 0; i < config.mode.size(); ++i) {
    const double tau_s = model_.tau_s(i, drive);
    const double keep = std::exp(-elapsed_s / tau_s);
    const double away_mm = model_.level_mm(i, drive) - before.mode_mm[i];
    // x⁺ = G + (x − G)·e^(−h/τ); ∂/∂ln τ gives e^(−h/τ)·(∂x/∂ln τ − (G − x)·h/τ).
    by_tau_mm_[i] = keep * (by_tau_mm_[i] - away_mm * elapsed_s / tau_s);
    for (std::size_t k = 0; k < linear(config.mode[i]); ++k, ++p) {
      const double level = unit_[static_cast<std::size_t>(p)].level_mm(0, drive);
      phi_(p) = level + (phi_(p) - level) * keep;
    }
  }
  model_.update(elapsed_s, drive);
  for (std::size_t j = 0; j < config.ambient.size(); ++j, ++p) {
    const double lagged = model_.state().ambient_c[j];
    // A sensor that appears late counts from its first temperature: its earlier share is in the
    // zero.
    if (!std::isfinite(ambient_start_c_[j])) {
      ambient_start_c_[j] = lagged;
    }
    phi_(p) = std::isfinite(lagged) ? lagged - ambient_start_c_[j] : 0.0;
  }
  elapsed_s_ += elapsed_s;
}

double Uncertainty::parameter_variance_mm2(const Answer& since) const {
  // After a reading only the changes since then are uncertain.
  const Eigen::VectorXd phi = phi_ - since.linear;
  double variance = phi.dot(covariance_um2_ * phi) / kUm2PerMm2;
  for (std::size_t i = 0; i < by_tau_mm_.size(); ++i) {
    const double by_tau =
        (by_tau_mm_[i] - since.by_tau_mm[i]) * model_.config().mode[i].tau_sd_ratio;
    variance += by_tau * by_tau;
  }
  return std::max(variance, 0.0);
}

double Uncertainty::sd_mm() const {
  const ThermalAxis& config = model_.config();
  const Answer none{Eigen::VectorXd::Zero(phi_.size()),
                    std::vector<double>(by_tau_mm_.size(), 0.0)};
  // The unknown starts at 0 and grows to its own spread: d²·(1 − e^(−2t/τ_d)).
  const double drift =
      config.drift_mm * config.drift_mm * (1.0 - std::exp(-2.0 * elapsed_s_ / config.drift_tau_s));
  return std::sqrt(parameter_variance_mm2(none) + drift);
}

// Points are for a table and a drawing; the closed-form curve gives the largest displacement.
std::vector<ForecastPoint> forecast(online::ThermalModel model, const Cyclogram& cyclogram,
                                    double step_s, const std::vector<double>& ambient_c) {
  std::vector<ForecastPoint> points;
  Uncertainty uncertainty(model);
  double start_s = 0.0;
  std::size_t index = 0;
  points.push_back({0.0, 0, model.displacement_mm(), 0.0});
  for (const Transition& transition : cyclogram.transition) {
    online::Drive drive = drive_of(transition);
    std::copy_n(ambient_c.begin(), std::min(ambient_c.size(), drive.ambient_c.size()),
                drive.ambient_c.begin());
    // Steps are only for the table of points; each is exact.
    const auto steps = std::max(1.0, std::ceil(transition.seconds / step_s - 1e-9));
    double at_s = 0.0;
    for (double k = 1.0; k <= steps && transition.seconds > 0.0; k += 1.0) {
      const double to_s = k == steps ? transition.seconds : k * step_s;
      uncertainty.step(to_s - at_s, drive, model.state());
      model.update(to_s - at_s, drive);
      at_s = to_s;
      points.push_back({start_s + at_s, index, model.displacement_mm(), uncertainty.sd_mm()});
    }
    start_s += transition.seconds;
    ++index;
  }
  return points;
}

}  // namespace steadyrest::thermal::offline
