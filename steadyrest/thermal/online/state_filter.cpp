// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <ranges>
#include <utility>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/thermal/online/state_filter.hpp>

// A Kalman filter over modes, bias and one scale of all levels. The modes themselves are in the
// ThermalModel, which steps them exactly; the filter adds the scale's effect on that step and
// propagates the covariance with the same step. Hᵀ = (1, …, 1, 1, 0): a reading sees modes and
// bias, and the scale only through its effect on the modes.
namespace steadyrest::thermal::online {

using kernel::outcome::Reason;
using kernel::outcome::refuse;
using kernel::outcome::Result;

namespace {

constexpr double kNormal999 = 3.2905;  ///< |N(0,1)| keeps below it in 99.9 %
constexpr double kUpper999 = 3.0902;   ///< N(0,1) keeps below it in 99.9 %

/// 99.9 % point of χ² with n degrees of freedom; Wilson and Hilferty 1931, within 2 % from n = 4.
double chi_square_999(double n) noexcept {
  // The cube root of χ²/n is nearly normal.
  const double root = 1.0 - 2.0 / (9.0 * n) + kUpper999 * std::sqrt(2.0 / (9.0 * n));
  return n * root * root * root;
}

bool not_negative(double value) noexcept {
  return std::isfinite(value) && value >= 0.0;
}

bool usable(const StateFilter::Config& c) noexcept {
  return not_negative(c.start_sd_mm) && not_negative(c.gain_sd_ratio) &&
         not_negative(c.walk_mm_sqrt_s) && not_negative(c.max_bias_mm) &&
         not_negative(c.axis.drift_mm) && not_negative(c.axis.noise_mm) &&
         c.axis.drift_tau_s > 0.0 && c.reading_sd_mm > 0.0 && c.gate_sd > 0.0 && c.min_gain > 0.0 &&
         c.min_gain <= 1.0 && c.max_gain >= 1.0 && std::isfinite(c.max_gain);
}

bool all_finite(const auto& values) noexcept {
  return std::ranges::all_of(values, [](double value) { return std::isfinite(value); });
}

}  // namespace

Result<StateFilter> StateFilter::make(const Config& config) {
  auto model = ThermalModel::make(config.axis);
  if (!model) {
    return std::unexpected(std::move(model.error()));
  }
  if (!usable(config)) {
    return refuse("the filter for " + config.axis.name + " has bad settings",
                  "give standard deviations ≥ 0, a gate > 0, and scale limits on either side of 1");
  }
  return StateFilter(config, std::move(*model));
}

StateFilter::StateFilter(const Config& config, ThermalModel model)
    : config_(config), model_(std::move(model)), modes_(config.axis.mode.size()) {
  reset();
}

void StateFilter::reset() noexcept {
  model_.reset();
  state_ = {};
  // The modes begin at 0 with no variance: a cold machine is known exactly.
  state_.covariance[kBias][kBias] = config_.start_sd_mm * config_.start_sd_mm;
  state_.covariance[kGain][kGain] = config_.gain_sd_ratio * config_.gain_sd_ratio;
}

void StateFilter::start(const ThermalModel::State& state) noexcept {
  reset();
  if (all_finite(state.mode_mm)) {
    model_.restore(state);
  }
}

double StateFilter::update(double elapsed_s, const Drive& drive) noexcept {
  const bool fit = elapsed_s >= 0.0 && std::isfinite(elapsed_s) &&
                   std::isfinite(drive.speed_rev_s) && std::isfinite(drive.feed_mm_s);
  if (!fit) {
    return displacement_mm();
  }
  std::array<double, kMaxThermalModes> left{};
  const std::array<double, kMaxThermalModes> before_mm = model_.state().mode_mm;
  for (std::size_t i = 0; i < modes_; ++i) {
    left[i] = model_.decay(i, elapsed_s, drive);
  }
  model_.update(elapsed_s, drive);
  // The model has stepped with the scale 1: its step shows what its levels contributed.
  std::array<double, kMaxThermalModes> after_mm = model_.state().mode_mm;
  std::array<double, kMaxThermalModes> gained_mm{};
  for (std::size_t i = 0; i < modes_; ++i) {
    // (1 − a)·G, the level's part of the step.
    gained_mm[i] = after_mm[i] - left[i] * before_mm[i];
    after_mm[i] += (state_.gain - 1.0) * gained_mm[i];
  }
  model_.set_modes(after_mm);
  spread(elapsed_s, left, gained_mm);
  state_.bias_mm *= bias_step_.left;
  return displacement_mm();
}

/// P ← F·P·Fᵀ + Q, with F the step's own: row i is left_i·x_i + gained_i·g.
void StateFilter::spread(double elapsed_s, const std::array<double, kMaxThermalModes>& left,
                         const std::array<double, kMaxThermalModes>& gained_mm) noexcept {
  if (bias_step_.elapsed_s != elapsed_s) {
    const auto& axis = config_.axis;
    const bool walks = axis.drift_mm == 0.0;
    bias_step_ = {.elapsed_s = elapsed_s,
                  .left = walks ? 1.0 : std::exp(-elapsed_s / axis.drift_tau_s),
                  // d²·(1 − e^(−2h/τ)) by expm1: for a millisecond and a τ of hours the difference
                  // would lose all digits.
                  .variance_mm2 = walks
                                      ? config_.walk_mm_sqrt_s * config_.walk_mm_sqrt_s * elapsed_s
                                      : -axis.drift_mm * axis.drift_mm *
                                            std::expm1(-2.0 * elapsed_s / axis.drift_tau_s)};
  }
  Covariance& p = state_.covariance;
  const double gain = p[kGain][kGain];
  for (std::size_t i = 0; i < modes_; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      // In place: first the modes' block, while their covariances with the gain are still the old
      // ones; then those with bias and gain.
      p[i][j] = left[i] * left[j] * p[i][j] + left[i] * gained_mm[j] * p[i][kGain] +
                gained_mm[i] * left[j] * p[j][kGain] + gained_mm[i] * gained_mm[j] * gain;
      p[j][i] = p[i][j];
    }
  }
  for (std::size_t i = 0; i < modes_; ++i) {
    p[i][kBias] = bias_step_.left * (left[i] * p[i][kBias] + gained_mm[i] * p[kBias][kGain]);
    p[kBias][i] = p[i][kBias];
    p[i][kGain] = left[i] * p[i][kGain] + gained_mm[i] * gain;
    p[kGain][i] = p[i][kGain];
  }
  p[kBias][kBias] = bias_step_.left * bias_step_.left * p[kBias][kBias] + bias_step_.variance_mm2;
  p[kBias][kGain] *= bias_step_.left;
  p[kGain][kBias] = p[kBias][kGain];
}

double StateFilter::variance_mm2() const noexcept {
  double sum = 0.0;
  // H·P·Hᵀ: the sum over modes and bias.
  for (std::size_t i = 0; i <= kBias; ++i) {
    for (std::size_t j = 0; j <= kBias; ++j) {
      sum += state_.covariance[i][j];
    }
  }
  return std::max(sum, 0.0);
}

// The reading's own figure first, then the passport's noise, then the setting.
double StateFilter::reading_sd_mm(const Reading& reading) const noexcept {
  if (reading.sd_mm > 0.0) {
    return reading.sd_mm;
  }
  return config_.axis.noise_mm > 0.0 ? config_.axis.noise_mm : config_.reading_sd_mm;
}

// A bias or scale at its limit is no longer an estimate; fault() says so until a reading brings it
// back.
bool StateFilter::clamp() noexcept {
  const double bias = std::clamp(state_.bias_mm, -config_.max_bias_mm, config_.max_bias_mm);
  const double gain = std::clamp(state_.gain, config_.min_gain, config_.max_gain);
  const bool held = bias != state_.bias_mm || gain != state_.gain;
  state_.bias_mm = bias;
  state_.gain = gain;
  return held;
}

StateFilter::Verdict StateFilter::measure(const Reading& reading) noexcept {
  if (!std::isfinite(reading.displacement_mm) || !not_negative(reading.sd_mm)) {
    return {.reason = Reason::input_not_finite};
  }
  Covariance& p = state_.covariance;
  std::array<double, kStates> with_reading{};  // P·Hᵀ
  for (std::size_t i = 0; i < kStates; ++i) {
    for (std::size_t j = 0; j <= kBias; ++j) {
      with_reading[i] += p[i][j];
    }
  }
  const double sd = reading_sd_mm(reading);
  const double s = variance_mm2() + sd * sd;
  const double innovation = reading.displacement_mm - displacement_mm();
  Verdict verdict{.innovation_mm = innovation, .innovation_sd_mm = std::sqrt(s)};
  const double e = innovation / verdict.innovation_sd_mm;
  // Outliers count too, clipped: one proves nothing, several in a row show that the model is wrong.
  state_.innovation[state_.readings % kWindow] = std::clamp(e, -config_.gate_sd, config_.gate_sd);
  ++state_.readings;
  // Three standard deviations: one in 370 good readings is refused.
  if (std::abs(e) > config_.gate_sd) {
    verdict.reason = Reason::thermal_reading_outlier;
    return verdict;
  }
  std::array<double, kMaxThermalModes> mode_mm = model_.state().mode_mm;
  for (std::size_t i = 0; i < modes_; ++i) {
    mode_mm[i] += with_reading[i] / s * innovation;
  }
  model_.set_modes(mode_mm);
  state_.bias_mm += with_reading[kBias] / s * innovation;
  state_.gain += with_reading[kGain] / s * innovation;
  for (std::size_t i = 0; i < kStates; ++i) {
    for (std::size_t j = 0; j < kStates; ++j) {
      p[i][j] -= with_reading[i] * with_reading[j] / s;
    }
    // Rounding of the subtraction must not make a variance negative.
    p[i][i] = std::max(p[i][i], 0.0);
  }
  verdict.reason = Reason::thermal_reading_taken;
  verdict.clamped = clamp();
  state_.clamped = verdict.clamped;
  return verdict;
}

void StateFilter::rezero(const Reading& reading) noexcept {
  if (!std::isfinite(reading.displacement_mm) || !not_negative(reading.sd_mm)) {
    return;
  }
  const double without_bias = displacement_mm() - state_.bias_mm;
  state_.bias_mm = reading.displacement_mm - without_bias;
  // d = z − Σx: its covariances are those of −Σx, its variance is theirs plus the reading's.
  Covariance& p = state_.covariance;
  const double sd = reading_sd_mm(reading);
  double variance = sd * sd;
  for (const std::size_t i : std::views::iota(std::size_t{0}, kStates)) {
    if (i == kBias) {
      continue;
    }
    double sum = 0.0;
    for (std::size_t j = 0; j < modes_; ++j) {
      sum += p[i][j];
    }
    p[i][kBias] = -sum;
    p[kBias][i] = -sum;
    variance += i < modes_ ? sum : 0.0;
  }
  p[kBias][kBias] = variance;
  // The innovations so far were against a model that has just been corrected.
  state_.readings = 0;
  state_.clamped = clamp();
}

double StateFilter::displacement_mm() const noexcept {
  return model_.displacement_mm() + state_.bias_mm;
}

double StateFilter::sd_mm() const noexcept {
  return std::sqrt(variance_mm2());
}

Reason StateFilter::fault() const noexcept {
  const std::size_t n = std::min(state_.readings, kWindow);
  if (state_.clamped) {
    return Reason::thermal_model_unfit;
  }
  if (n < kLeast) {
    return Reason::none;
  }
  // Two tests, since each sees what the other misses: χ² a spread that is too wide, the sum an
  // error that stays on one side.
  double energy = 0.0;
  double sum = 0.0;
  for (std::size_t k = 0; k < n; ++k) {
    energy += state_.innovation[k] * state_.innovation[k];
    sum += state_.innovation[k];
  }
  const auto count = static_cast<double>(n);
  const bool fits =
      energy <= chi_square_999(count) && std::abs(sum) <= kNormal999 * std::sqrt(count);
  return fits ? Reason::none : Reason::thermal_model_unfit;
}

StateFilter::State StateFilter::state() const noexcept {
  State state = state_;
  state.model = model_.state();
  return state;
}

void StateFilter::restore(const State& state) noexcept {
  const bool fit =
      all_finite(state.model.mode_mm) && std::isfinite(state.bias_mm) &&
      std::isfinite(state.gain) && all_finite(state.innovation) &&
      std::ranges::all_of(state.covariance, [](const auto& row) { return all_finite(row); });
  if (!fit) {
    reset();
    return;
  }
  state_ = state;
  model_.restore(state.model);
}

}  // namespace steadyrest::thermal::online
