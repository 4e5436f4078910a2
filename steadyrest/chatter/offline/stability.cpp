// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/QR>

#include <steadyrest/chatter/offline/stability.hpp>

namespace steadyrest::chatter::offline {
namespace {

using Complex = std::complex<double>;
using Eigen::Index;

constexpr double kReal = 1e-6;  ///< |Im μ| of a real multiplier, relative
constexpr std::size_t kMostStarts = 16;
constexpr std::size_t kLeastWindow = 20;  ///< passes
constexpr double kForget = 1e-8;          ///< what a map loses in rank is less than this share
constexpr double kDied = 1e-4;            ///< of its peak, then it is followed no longer

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

/// ‖X·Y‖_∞ without more memory than one row.
double row_sum_norm(const Eigen::MatrixXd& x, const Eigen::MatrixXd& y) {
  double out = 0.0;
  for (Index i = 0; i < x.rows(); ++i) {
    out = std::max(out, (x.row(i) * y).cwiseAbs().sum());
  }
  return out;
}

/// The map from the pass `begin` on as X·Y with few columns in X: all but a handful of directions
/// die within a pass or two.
double log_growth_from(DelayCycle& cycle, std::size_t begin, std::size_t window) {
  const Index size = cycle.state_size();
  Eigen::MatrixXd x = Eigen::MatrixXd::Identity(size, size);
  Eigen::MatrixXd y = x;
  double log_scale = 0.0;
  double peak = 0.0;
  for (std::size_t k = 0; k < window; ++k) {
    const std::size_t pass = (begin + k) % cycle.passes();
    for (Index i = 0; i < x.cols(); ++i) {
      cycle.advance(pass, x.col(i));
    }
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(x);
    const double largest = std::abs(qr.matrixQR()(0, 0));
    if (!(largest > 0.0)) {
      break;
    }
    Index rank = 0;
    while (rank < x.cols() && std::abs(qr.matrixQR()(rank, rank)) > kForget * largest) {
      ++rank;
    }
    Eigen::MatrixXd r = qr.matrixQR().topRows(rank).triangularView<Eigen::Upper>();
    r = r * qr.colsPermutation().transpose();
    y = (r * y).eval() / largest;
    x = qr.householderQ() * Eigen::MatrixXd::Identity(size, rank);
    log_scale += std::log(largest);
    const double now = log_scale + std::log(row_sum_norm(x, y));
    if (now < peak + std::log(kDied) && now < 0.0) {
      break;
    }
    peak = std::max(peak, now);
  }
  return peak;
}

}  // namespace

double log_peak_growth(DelayCycle& cycle) {
  const std::size_t passes = cycle.passes();
  const std::size_t starts = std::min(passes, kMostStarts);
  double peak = 0.0;
  for (std::size_t k = 0; k < starts; ++k) {
    peak = std::max(
        peak, log_growth_from(cycle, k * passes / starts, std::max(2 * passes, kLeastWindow)));
  }
  return peak;
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
    out.peak_growth = std::exp(std::min(700.0, log_peak_growth(cycle)));
  }
  return out;
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
