// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include <steadyrest/chatter/offline/growth_course.hpp>
#include <steadyrest/chatter/offline/stability.hpp>

namespace steadyrest::chatter::offline {
namespace {

using Complex = std::complex<double>;

constexpr double kReal = 1e-6;  ///< |Im μ| of a real multiplier, relative

/// μ = e^{λT}: the vibration is e^{λt} times something periodic; of its lines (arg μ + 2πk)/T the
/// strongest.
std::optional<double> strongest_line_hz(DelayCycle& cycle, const Multipliers& found) {
  if (cycle.passes() != 1) {
    return std::nullopt;
  }
  const Complex mu = found.value[0];
  const double period = cycle.period_s();
  // Two passes of the real part give the complex solution: Im from x(t + T) = Re(μ·z).
  Eigen::VectorXd state = found.vector;
  cycle.advance(0, state);
  const auto first = cycle.last_pass(0);
  cycle.advance(0, state);
  const auto second = cycle.last_pass(0);
  const bool real = std::abs(mu.imag()) < kReal * std::abs(mu);
  const double growth = std::log(std::abs(mu)) / period;
  const double turn = std::arg(mu) / period;
  double best = 0.0;
  double line = 0.0;
  double fastest = 0.0;
  for (std::size_t i = 1; i < first.size(); ++i) {
    fastest = std::max(fastest, 1.0 / (first[i].t_s - first[i - 1].t_s));
  }
  const int most = static_cast<int>(std::min(400.0, 0.25 * fastest * period + 2.0));
  for (int k = -most; k <= most; ++k) {
    const double w = turn + 2.0 * std::numbers::pi * k / period;
    Complex sum;
    for (std::size_t i = 0; i < first.size(); ++i) {
      const double x = first[i].x_mm;
      const double y = real ? 0.0 : (x * mu.real() - second[i].x_mm) / mu.imag();
      sum += first[i].weight_s * Complex(x, y) * std::exp(-growth * first[i].t_s) *
             std::polar(1.0, -w * first[i].t_s);
    }
    if (std::abs(sum) > best) {
      best = std::abs(sum);
      line = w;
    }
  }
  return std::abs(line) / (2.0 * std::numbers::pi);
}

ChatterType type_of(const Complex& mu) {
  if (std::abs(mu.imag()) > kReal * std::abs(mu)) {
    return ChatterType::hopf;
  }
  return mu.real() < 0.0 ? ChatterType::flip : ChatterType::fold;
}

}  // namespace

double log_peak_growth(DelayCycle& cycle) {
  return worst(growth_courses(cycle)).log_peak();
}

Stability stability(DelayCycle& cycle, const StabilityOptions& options) {
  const Multipliers found = multipliers(cycle, 2, options.tolerance);
  Stability out;
  out.passes = cycle.passes();
  out.law_periods = cycle.law_periods();
  out.log_radius = found.log_modulus[0] / static_cast<double>(cycle.law_periods());
  out.log_radius_per_pass = found.log_modulus[0] / static_cast<double>(cycle.passes());
  out.stable = out.log_radius < 0.0;
  out.multiplier = found.value[0];
  out.type = out.stable ? ChatterType::none : type_of(found.value[0]);
  if (options.frequency) {
    out.frequency_hz = strongest_line_hz(cycle, found);
  }
  if (options.peak_growth) {
    out.peak_growth = worst(growth_courses(cycle)).peak();
  }
  return out;
}

kernel::outcome::Result<Stability> stability_at(const Process& process,
                                                const DelayCycle::Config& config,
                                                const StabilityOptions& options) {
  auto cycle = DelayCycle::make(process, config);
  if (!cycle) {
    return std::unexpected(cycle.error());
  }
  cycle->set_depth(config.most_depth_mm);
  return stability(*cycle, options);
}

const char* name(ChatterType type) noexcept {
  switch (type) {
    case ChatterType::none:
      return "none";
    case ChatterType::hopf:
      return "hopf";
    case ChatterType::flip:
      return "flip";
    case ChatterType::fold:
      return "fold";
  }
  return "none";
}

}  // namespace steadyrest::chatter::offline
