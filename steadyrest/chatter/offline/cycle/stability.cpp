// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include <steadyrest/chatter/offline/cycle/growth_course.hpp>
#include <steadyrest/chatter/offline/cycle/stability.hpp>

namespace steadyrest::chatter::offline {
namespace {

using Complex = std::complex<double>;

constexpr double kRealMultiplier = 1e-6;  ///< |Im μ| of a real multiplier, relative
constexpr std::size_t kMostLinePasses = 400;
constexpr double kMostLogModulus = 300.0;
constexpr double kMostLines = 4000.0;
// A line needs at least four nodes per wave to be told from its alias.
constexpr double kLinesPerSample = 0.25;

/// Displacements through one principal period.
std::vector<DelayCycle::Sample> samples_of(DelayCycle& cycle, Eigen::VectorXd& state) {
  std::vector<DelayCycle::Sample> out;
  for (std::size_t p = 0; p < cycle.passes(); ++p) {
    cycle.advance(p, state);
    const auto pass = cycle.last_pass(p);
    out.insert(out.end(), pass.begin(), pass.end());
  }
  return out;
}

/// The strongest of the lines (arg μ + 2πk)/T of the vibration, which is e^{λt} times something
/// periodic, μ = e^{λT}.
std::optional<double> strongest_line_hz(DelayCycle& cycle, const Multipliers& found) {
  // Long periods have thousands of lines of nearly equal strength: "the strongest" means nothing
  // there.
  if (cycle.passes() > kMostLinePasses || std::abs(found.log_modulus[0]) > kMostLogModulus) {
    return std::nullopt;
  }
  // A value from discrete QR is only a direction.
  const Complex mu = found.value[0] / std::abs(found.value[0]);
  const double period = cycle.period_s();
  // Two periods of the real part give the complex solution: Im from x(t + T) = Re(μ·z).
  Eigen::VectorXd state = found.vector;
  const auto first = samples_of(cycle, state);
  state *= std::exp(-found.log_modulus[0]);
  const auto second = samples_of(cycle, state);
  const bool real = std::abs(mu.imag()) < kRealMultiplier;
  const double growth = found.log_modulus[0] / period;
  const double turn = std::arg(mu) / period;
  const double base = 2.0 * std::numbers::pi / period;
  const int most = static_cast<int>(
      std::min(kMostLines, kLinesPerSample * static_cast<double>(first.size()) + 2.0));
  std::vector<Complex> term(first.size());
  std::vector<Complex> rotor(first.size());
  for (std::size_t i = 0; i < first.size(); ++i) {
    const double t = first[i].t_s;
    const double x = first[i].x_mm;
    // x(t + T)/|μ| = Re(μ·z) = Re μ·x − Im μ·y with μ on the unit circle, solved for y.
    const double y = real ? 0.0 : (x * mu.real() - second[i].x_mm) / mu.imag();
    // Without the growth the rest is periodic: Fourier sums over the Gauss weights, one complex
    // product per line and node by rotating every term from k to k + 1.
    term[i] = first[i].weight_s * Complex(x, y) * std::exp(-growth * t) *
              std::polar(1.0, -(turn - base * most) * t);
    rotor[i] = std::polar(1.0, -base * t);
  }
  double best = 0.0;
  double line = 0.0;
  for (int k = -most; k <= most; ++k) {
    Complex sum;
    for (std::size_t i = 0; i < term.size(); ++i) {
      sum += term[i];
      const double re = term[i].real() * rotor[i].real() - term[i].imag() * rotor[i].imag();
      const double im = term[i].real() * rotor[i].imag() + term[i].imag() * rotor[i].real();
      term[i] = {re, im};
    }
    if (std::abs(sum) > best) {
      best = std::abs(sum);
      line = turn + base * k;
    }
  }
  // A line at −f is the same tone as one at f.
  return std::abs(line) / (2.0 * std::numbers::pi);
}

ChatterType type_of(const Complex& mu) {
  if (std::abs(mu.imag()) > kRealMultiplier * std::abs(mu)) {
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
  // The principal period may hold several periods of the law; the result is per law period.
  out.log_radius = found.log_modulus[0] / static_cast<double>(cycle.law_periods());
  out.log_radius_per_pass = found.log_modulus[0] / static_cast<double>(cycle.passes());
  out.stable = out.log_radius < 0.0;
  out.multiplier = found.value[0];
  out.type = out.stable ? ChatterType::none : type_of(found.value[0]);
  out.frequency_step_hz = 1.0 / cycle.period_s();
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
