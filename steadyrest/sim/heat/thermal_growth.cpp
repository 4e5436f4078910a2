// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <steadyrest/sim/base/portable.hpp>
#include <steadyrest/sim/base/range.hpp>
#include <steadyrest/sim/heat/thermal_growth.hpp>

// Each term of the passport is a body with one time constant; the true one differs from the
// passport's by the simulation's errors, numbered through all terms in the order of the file. The
// constructor computes everything that needs exp.
namespace steadyrest::sim {
namespace {

using kernel::machine::Simulation;
using kernel::machine::ThermalAmbient;
using kernel::machine::ThermalAxis;
using kernel::machine::ThermalMode;
using kernel::outcome::Result;

constexpr double kDay_s = 24.0 * 3600.0;
// The room is warmest at 15:00; its noise has a correlation time of 10 min (README).
constexpr double kWarmest_s = 15.0 * 3600.0;
constexpr double kDraught_s = 600.0;
constexpr double kReference_rev_s = 1000.0 / 60.0;  ///< unit of a polynomial's speed
/// Keeps the random words of readings apart from those of the truth: an extra reading changes no
/// truth.
constexpr std::uint64_t kReadings = 0x9E3779B97F4A7C15;
constexpr std::uint64_t kWeather = 0xD1B54A32D192ED03;

/// The relative error of the term with this number.
double error_of(const std::vector<double>& errors, std::size_t term) noexcept {
  return errors.empty() ? 0.0 : errors[std::min(term, errors.size() - 1)];
}

Result<void> check(const ThermalMode& m) {
  const bool table = !m.level_mm.empty();
  if (m.speed_rev_s.size() != m.level_mm.size() || table == !m.polynomial_mm.empty() ||
      std::ranges::adjacent_find(m.speed_rev_s, std::ranges::greater_equal{}) !=
          m.speed_rev_s.end()) {
    return std::unexpected(
        refusal("a thermal mode needs a rising table of levels, or a polynomial"));
  }
  return in_range("thermal mode",
                  {{"tau_s", m.tau_s, 1e-3, 1e9}, {"rest_tau_s", m.rest_tau_s, 0.0, 1e9}});
}

// An error of −1 or below would make a time constant zero or negative, so it ends at −0.99.
Result<void> check(const ThermalGrowth::Config& config) {
  for (const ThermalAxis& axis : config.passport.axis) {
    for (const ThermalMode& mode : axis.mode) {
      if (auto ok = check(mode); !ok) {
        return ok;
      }
    }
    for (const ThermalAmbient& ambient : axis.ambient) {
      if (auto ok = in_range("thermal ambient", {{"tau_s", ambient.tau_s, 0.0, 1e9}}); !ok) {
        return ok;
      }
    }
    if (auto ok = in_range("thermal axis", {{"drift_tau_s", axis.drift_tau_s, 1e-3, 1e9}}); !ok) {
      return ok;
    }
  }
  const Simulation& s = config.simulation;
  for (const double error : s.thermal_tau_error_ratio) {
    if (auto ok = in_range("simulation", {{"thermal_tau_error_ratio", error, -0.99, 1e3}}); !ok) {
      return ok;
    }
  }
  for (const double error : s.thermal_gain_error_ratio) {
    if (auto ok = in_range("simulation", {{"thermal_gain_error_ratio", error, -1e3, 1e3}}); !ok) {
      return ok;
    }
  }
  return in_range("simulation", {{"period_s", config.period_s, 1e-4, 60.0},
                                 {"drift_mm", config.drift_mm, 0.0, 10.0},
                                 {"room_c", s.room_c, -100.0, 200.0},
                                 {"room_swing_k", s.room_swing_k, 0.0, 100.0},
                                 {"room_noise_k", s.room_noise_k, 0.0, 100.0},
                                 {"room_start_s", s.room_start_s, 0.0, kDay_s},
                                 {"sensor_noise_k", s.sensor_noise_k, 0.0, 100.0},
                                 {"probe_noise_mm", s.probe_noise_mm, 0.0, 10.0}});
}

// Time constant 0: no lag, the body follows at once.
double decay(double period_s, double tau_s) noexcept {
  return tau_s > 0.0 ? portable::exp(-period_s / tau_s) : 0.0;
}

/// The mode's final level: linear between the points of the table, constant beyond its ends.
double level_mm(const ThermalMode& m, double speed_rev_s) noexcept {
  if (m.level_mm.empty()) {
    const double n = speed_rev_s / kReference_rev_s;
    // No constant term: a spindle at rest generates no heat.
    double power = n;
    double level = 0.0;
    for (const double coefficient : m.polynomial_mm) {
      level += coefficient * power;
      power *= n;
    }
    return level;
  }
  if (speed_rev_s <= m.speed_rev_s.front()) {
    return m.level_mm.front();
  }
  for (std::size_t i = 1; i < m.speed_rev_s.size(); ++i) {
    if (speed_rev_s < m.speed_rev_s[i]) {
      const double u =
          (speed_rev_s - m.speed_rev_s[i - 1]) / (m.speed_rev_s[i] - m.speed_rev_s[i - 1]);
      return (1.0 - u) * m.level_mm[i - 1] + u * m.level_mm[i];
    }
  }
  return m.level_mm.back();
}

}  // namespace

Result<ThermalGrowth> ThermalGrowth::make(const Config& config) {
  if (auto ok = check(config); !ok) {
    return std::unexpected(ok.error());
  }
  return ThermalGrowth(config);
}

ThermalGrowth::ThermalGrowth(const Config& config)
    : period_s_(config.period_s),
      simulation_(config.simulation),
      weather_(config.simulation.seed ^ kWeather),
      readings_(config.simulation.seed ^ kReadings),
      draught_(config.simulation.room_noise_k, config.period_s, kDraught_s) {
  room();
  std::size_t term = 0;
  for (const ThermalAxis& from : config.passport.axis) {
    Axis axis;
    for (const ThermalMode& mode : from.mode) {
      const double longer = 1.0 + error_of(simulation_.thermal_tau_error_ratio, term);
      const double larger = 1.0 + error_of(simulation_.thermal_gain_error_ratio, term);
      ++term;
      Body body{.mode = mode};
      for (double& level : body.mode.level_mm) {
        level *= larger;
      }
      for (double& coefficient : body.mode.polynomial_mm) {
        coefficient *= larger;
      }
      body.mode.feed_s *= larger;
      body.turning_decay = decay(period_s_, mode.tau_s * longer);
      // A spindle at rest may cool at a different rate from one that turns.
      body.resting_decay =
          mode.rest_tau_s > 0.0 ? decay(period_s_, mode.rest_tau_s * longer) : body.turning_decay;
      axis.body.push_back(std::move(body));
    }
    for (const ThermalAmbient& ambient : from.ambient) {
      const double longer = 1.0 + error_of(simulation_.thermal_tau_error_ratio, term);
      const double larger = 1.0 + error_of(simulation_.thermal_gain_error_ratio, term);
      ++term;
      axis.surrounding.push_back({.gain_mm_c = ambient.gain_mm_k * larger,
                                  .decay = decay(period_s_, ambient.tau_s * longer),
                                  .start_c = room_c_,
                                  .lagged_c = room_c_});
    }
    axis.drift_decay = decay(period_s_, from.drift_tau_s);
    // The process keeps its RMS once settled: x ← d·x + f·n keeps the variance σ² where f² = σ²·(1
    // − d²).
    axis.drift_fresh_mm = config.drift_mm * std::sqrt(1.0 - axis.drift_decay * axis.drift_decay);
    axis_.push_back(std::move(axis));
  }
}

void ThermalGrowth::room() noexcept {
  // sin(x + ¼ turn) = cos x: warmest at 15:00.
  const double turns = (simulation_.room_start_s + time_s_ - kWarmest_s) / kDay_s;
  room_c_ = simulation_.room_c + simulation_.room_swing_k * portable::sin_turn(turns + 0.25);
  if (simulation_.room_noise_k > 0.0) {
    room_c_ += draught_.update(weather_.next());
  }
}

void ThermalGrowth::update(const Input& input) noexcept {
  const double speed = std::abs(input.speed_rev_s);
  for (Axis& axis : axis_) {
    axis.displacement_mm = 0.0;
    for (Body& body : axis.body) {
      const ThermalMode& m = body.mode;
      // Shares of the period: cutting raises the level by its ratio while it lasts.
      const double cut = 1.0 + input.cutting * (m.cutting_ratio - 1.0);
      const double settles = level_mm(m, speed) * cut * (input.coolant ? m.coolant_ratio : 1.0) +
                             m.feed_s * input.feed_mm_s;
      // q' = G/τ − q/τ, exact over a period of constant inputs.
      const double left = speed > 0.0 ? body.turning_decay : body.resting_decay;
      body.warmth_mm = body.warmth_mm * left + settles * (1.0 - left);
      axis.displacement_mm += body.warmth_mm;
    }
    for (Surrounding& s : axis.surrounding) {
      s.lagged_c = s.lagged_c * s.decay + room_c_ * (1.0 - s.decay);
      axis.displacement_mm += s.gain_mm_c * (s.lagged_c - s.start_c);
    }
    if (axis.drift_fresh_mm > 0.0) {
      axis.drift_mm = axis.drift_mm * axis.drift_decay + axis.drift_fresh_mm * weather_.next();
      axis.displacement_mm += axis.drift_mm;
    }
  }
  ++periods_;
  // Counted, not summed: a day of tenths of a second would drift.
  time_s_ = static_cast<double>(periods_) * period_s_;
  room();
}

double ThermalGrowth::read_room_c() noexcept {
  return simulation_.sensor_noise_k > 0.0 ? room_c_ + simulation_.sensor_noise_k * readings_.next()
                                          : room_c_;
}

double ThermalGrowth::read_probe_mm(double true_mm) noexcept {
  return simulation_.probe_noise_mm > 0.0 ? true_mm + simulation_.probe_noise_mm * readings_.next()
                                          : true_mm;
}

}  // namespace steadyrest::sim
