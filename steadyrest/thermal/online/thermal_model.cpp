// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <ranges>
#include <string>
#include <utility>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/thermal/online/thermal_model.hpp>

// The law of the README, one step at a time. Inputs are constant within a step, so each mode and
// each lag moves by its exact exponential: a millisecond and an hour are equally exact.
namespace steadyrest::thermal::online {

using kernel::machine::ThermalMode;
using kernel::outcome::refuse;
using kernel::outcome::Result;

namespace {

constexpr double kReference_rev_s = 1000.0 / 60.0;  ///< of a polynomial's n

bool usable_mode(const ThermalMode& mode) {
  // Either a table or a polynomial, never both; a lag or rest τ of 0 means none.
  return mode.tau_s > 0.0 && mode.rest_tau_s >= 0.0 &&
         mode.speed_rev_s.size() == mode.level_mm.size() &&
         mode.level_mm.empty() != mode.polynomial_mm.empty() &&
         std::ranges::is_sorted(mode.speed_rev_s);
}

double by_table(const ThermalMode& mode, double speed_rev_s) noexcept {
  const auto& n = mode.speed_rev_s;
  const auto& g = mode.level_mm;
  const auto above = std::ranges::upper_bound(n, speed_rev_s);
  if (above == n.begin()) {
    return g.front();
  }
  if (above == n.end()) {
    return g.back();
  }
  const auto i = static_cast<std::size_t>(above - n.begin());
  return g[i - 1] + (g[i] - g[i - 1]) * (speed_rev_s - n[i - 1]) / (n[i] - n[i - 1]);
}

double by_polynomial(const ThermalMode& mode, double speed_rev_s) noexcept {
  const double n = speed_rev_s / kReference_rev_s;
  double level = 0.0;
  for (const double coefficient : std::views::reverse(mode.polynomial_mm)) {
    // Horner without a constant term: a polynomial gives 0 at standstill.
    level = (level + coefficient) * n;
  }
  return level;
}

}  // namespace

Result<ThermalModel> ThermalModel::make(const Config& config) {
  const bool fits =
      config.mode.size() <= kMaxThermalModes && config.ambient.size() <= kMaxThermalAmbients &&
      std::ranges::all_of(config.mode, usable_mode) &&
      std::ranges::all_of(config.ambient, [](const auto& a) { return a.tau_s >= 0.0; });
  if (!fits) {
    return refuse("the thermal passport of " + config.name + " is incomplete",
                  "give each mode a positive time constant and either a rising "
                  "table of levels or a polynomial");
  }
  return ThermalModel(config);
}

ThermalModel::ThermalModel(Config config) : config_(std::move(config)) {
  for (std::size_t j = 0; j < config_.ambient.size(); ++j) {
    const auto& ambient = config_.ambient[j];
    const auto end = lag_decay_.begin() + static_cast<std::ptrdiff_t>(lags_);
    // Inputs with the same lag share one exponential: a passport with all temperatures has three
    // lags and dozens of inputs.
    const auto found = std::find_if(lag_decay_.begin(), end, [&ambient](const Decay& decay) {
      return decay.tau_s == ambient.tau_s;
    });
    lag_of_[j] = static_cast<std::size_t>(found - lag_decay_.begin());
    if (found == end) {
      lag_decay_[lags_++].tau_s = ambient.tau_s;
    }
    gain_mm_k_[j] = ambient.gain_mm_k;
    reference_c_[j] = ambient.reference_c;
  }
  reset();
}

void ThermalModel::reset() noexcept {
  state_.mode_mm.fill(0.0);
  // Not 0 °C: a sensor's first reading counts as its settled value.
  state_.ambient_c.fill(std::numeric_limits<double>::quiet_NaN());
  ambient_mm_ = 0.0;
}

void ThermalModel::restore(const State& state) noexcept {
  state_ = state;
  sum_up_ambient();
}

double ThermalModel::level_mm(std::size_t mode, const Drive& drive) const noexcept {
  const ThermalMode& m = config_.mode[mode];
  // Heat is independent of the direction of rotation.
  const double n = std::abs(drive.speed_rev_s);
  double level = m.level_mm.empty() ? by_polynomial(m, n) : by_table(m, n);
  // Only the share of time in feed moves heats by cutting: ratio 1 + share·(c − 1).
  level *= drive.cutting ? 1.0 + drive.cutting_share * (m.cutting_ratio - 1.0) : 1.0;
  level *= drive.coolant ? m.coolant_ratio : 1.0;
  // The ratios apply only to the speed's part.
  return level + m.feed_s * drive.feed_mm_s;
}

double ThermalModel::tau_s(std::size_t mode, const Drive& drive) const noexcept {
  const ThermalMode& m = config_.mode[mode];
  // A turning spindle moves air and oil and cools faster; at rest the same body may take longer.
  return drive.speed_rev_s == 0.0 && m.rest_tau_s > 0.0 ? m.rest_tau_s : m.tau_s;
}

double ThermalModel::kept(Decay& decay, double tau_s, double elapsed_s) noexcept {
  // Steps usually have one period, so the exponential is computed once.
  if (decay.tau_s != tau_s || decay.elapsed_s != elapsed_s) {
    const double factor = tau_s > 0.0 ? std::exp(-elapsed_s / tau_s) : 0.0;
    decay = {.tau_s = tau_s, .elapsed_s = elapsed_s, .factor = factor};
  }
  return decay.factor;
}

void ThermalModel::sum_up_ambient() noexcept {
  // Four sums, so that no addition waits for the one before.
  std::array<double, 4> part{};
  static_assert(kMaxThermalAmbients % part.size() == 0);
  for (std::size_t j = 0; j < config_.ambient.size(); j += part.size()) {
    for (std::size_t k = 0; k < part.size(); ++k) {
      const double away_mm = gain_mm_k_[j + k] * (state_.ambient_c[j + k] - reference_c_[j + k]);
      // A sensor never seen displaces nothing. Slots beyond the inputs have gain 0 or NaN
      // temperatures and drop out here too.
      part[k] += std::isfinite(away_mm) ? away_mm : 0.0;
    }
  }
  ambient_mm_ = (part[0] + part[1]) + (part[2] + part[3]);
}

void ThermalModel::lag(double elapsed_s, const Drive& drive) noexcept {
  if (elapsed_s != lag_elapsed_s_) {
    lag_elapsed_s_ = elapsed_s;
    for (std::size_t j = 0; j < config_.ambient.size(); ++j) {
      left_[j] = kept(lag_decay_[lag_of_[j]], config_.ambient[j].tau_s, elapsed_s);
    }
  }
  for (std::size_t j = 0; j < config_.ambient.size(); ++j) {
    const double temperature = drive.ambient_c[j];
    const double lagged = state_.ambient_c[j];
    const double next = temperature + (lagged - temperature) * left_[j];
    // The first reading counts as settled; a lost sensor keeps its last lagged value.
    const double seen = std::isfinite(lagged) ? next : temperature;
    state_.ambient_c[j] = std::isfinite(temperature) ? seen : lagged;
  }
  sum_up_ambient();
}

double ThermalModel::update(double elapsed_s, const Drive& drive) noexcept {
  const bool fit = elapsed_s >= 0.0 && std::isfinite(elapsed_s) &&
                   std::isfinite(drive.speed_rev_s) && std::isfinite(drive.feed_mm_s);
  if (!fit) {
    return displacement_mm();
  }
  for (std::size_t i = 0; i < config_.mode.size(); ++i) {
    const double level = level_mm(i, drive);
    double& x = state_.mode_mm[i];
    // Exact for constant inputs, whatever the step.
    x = level + (x - level) * decay(i, elapsed_s, drive);
  }
  if (!config_.ambient.empty()) {
    lag(elapsed_s, drive);
  }
  return displacement_mm();
}

double ThermalModel::displacement_mm() const noexcept {
  double sum = ambient_mm_;
  for (std::size_t i = 0; i < config_.mode.size(); ++i) {
    sum += state_.mode_mm[i];
  }
  return sum;
}

}  // namespace steadyrest::thermal::online
