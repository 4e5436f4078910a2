// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/QR>
#include <fmt/core.h>

#include <steadyrest/chatter/offline/response/fit_check.hpp>
#include <steadyrest/chatter/offline/response/mode_fit.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/kernel/units/constants.hpp>

// Orders rise one by one: with_one_more() adds a mode where the residual stands out, refine() moves
// all modes by Levenberg–Marquardt with the linear parameters solved inside, estimate_noise()
// updates the weights, and the criterion decides whether the mode was worth its three parameters.
namespace steadyrest::chatter::offline {
namespace {

using kernel::units::kTurn;

using Complex = std::complex<double>;
using Eigen::ArrayXd;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using kernel::outcome::refuse;
using kernel::outcome::Result;

constexpr double kLeastFittedDamping = 1e-5;
constexpr double kMostFittedDamping = 0.5;
constexpr Index kBackground = 2;  ///< c and d
// Logarithms keep ω and ζ above 0 and give steps of equal relative size for every mode.
constexpr Index kPerMode = 3;  ///< ln ω, ln ζ, gain
constexpr int kRounds = 4;     ///< of noise and modes in turn

/// The parameters: ln ω, ln ζ of each mode; then the linear ones: gains, c, d.
struct Model {
  std::vector<double> w;
  std::vector<double> damping;
  VectorXd linear;

  [[nodiscard]] Index modes() const { return static_cast<Index>(w.size()); }
};

/// The measurement and the weight of each point.
struct Data {
  ArrayXd w;
  Eigen::ArrayXcd h;
  ArrayXd weight;  ///< 1/σ
  double middle_w = 1.0;
  double noise_ratio = 0.1;
  double noise_mm_n = 0.0;
};

Complex base(double w, double mode_w, double damping) {
  return 1.0 / Complex(mode_w * mode_w - w * w, 2.0 * damping * mode_w * w);
}

/// Columns of the linear parameters; gains are of the order of the compliance at resonance.
Eigen::MatrixXcd columns(const Data& data, const Model& model) {
  Eigen::MatrixXcd out(data.w.size(), model.modes() + kBackground);
  for (Index i = 0; i < data.w.size(); ++i) {
    for (Index k = 0; k < model.modes(); ++k) {
      const auto at = static_cast<std::size_t>(k);
      out(i, k) = base(data.w[i], model.w[at], model.damping[at]);
    }
    out(i, model.modes()) = 1.0;
    // Scaled by the middle of the band, so that d is of the order of c.
    out(i, model.modes() + 1) = -data.middle_w * data.middle_w / (data.w[i] * data.w[i]);
  }
  return out;
}

/// Real parts above imaginary parts.
MatrixXd stacked(const Eigen::MatrixXcd& m) {
  MatrixXd out(2 * m.rows(), m.cols());
  out << m.real(), m.imag();
  return out;
}

MatrixXd weighted(const Data& data, const Eigen::MatrixXcd& m) {
  return stacked(data.weight.matrix().asDiagonal() * m);
}

/// Least squares for the linear parameters.
void solve_linear(const Data& data, Model& model) {
  const MatrixXd a = weighted(data, columns(data, model));
  // Columns of modes and background differ by orders of magnitude; without scaling, QR's rank
  // decision would drop the small ones.
  const VectorXd scale = a.colwise().norm().cwiseMax(1e-300).cwiseInverse();
  const VectorXd y =
      (a * scale.asDiagonal()).colPivHouseholderQr().solve(weighted(data, data.h.matrix()).col(0));
  model.linear = scale.asDiagonal() * y;
}

Eigen::ArrayXcd response(const Data& data, const Model& model) {
  return (columns(data, model) * model.linear.cast<Complex>()).array();
}

double misfit(const Data& data, const Model& model) {
  return ((data.h - response(data, model)).abs() * data.weight).square().sum();
}

/// Columns of ln ω and ln ζ for each mode, then the linear ones.
MatrixXd jacobian(const Data& data, const Model& model) {
  const Index n = model.modes();
  Eigen::MatrixXcd j(data.w.size(), kPerMode * n + kBackground);
  j.rightCols(n + kBackground) = columns(data, model);
  for (Index k = 0; k < n; ++k) {
    const double w0 = model.w[static_cast<std::size_t>(k)];
    const double zeta = model.damping[static_cast<std::size_t>(k)];
    for (Index i = 0; i < data.w.size(); ++i) {
      const Complex b = j(i, 2 * n + k);
      // ∂(gain·b)/∂ ln ω and ∂/∂ ln ζ with b = 1/(ω² − w² + 2iζωw).
      const Complex d = -model.linear[k] * b * b;
      const Complex damping(0.0, 2.0 * zeta * w0 * data.w[i]);
      j(i, k) = d * (2.0 * w0 * w0 + damping);
      j(i, n + k) = d * damping;
    }
  }
  return weighted(data, j);
}

/// Levenberg–Marquardt; the damping of the steps follows their success.
void refine(const Data& data, Model& model, int most_steps) {
  double best = misfit(data, model);
  double lambda = 1e-3;
  const Index n = model.modes();
  for (int step = 0; step < most_steps && lambda < 1e8; ++step) {
    const MatrixXd j = jacobian(data, model);
    const VectorXd r = weighted(data, (data.h - response(data, model)).matrix()).col(0);
    const MatrixXd normal = j.transpose() * j;
    const VectorXd gradient = j.transpose() * r;
    bool better = false;
    while (!better && lambda < 1e8) {
      MatrixXd damped = normal;
      // Marquardt's scaling: the damping is proportional to each parameter's own curvature.
      damped.diagonal() *= 1.0 + lambda;
      const VectorXd move = damped.ldlt().solve(gradient);
      Model next = model;
      for (Index k = 0; k < n; ++k) {
        const auto at = static_cast<std::size_t>(k);
        // Bounded: far from the optimum a whole Gauss–Newton step may lead anywhere.
        next.w[at] *= std::exp(std::clamp(move[k], -0.1, 0.1));
        next.damping[at] =
            std::clamp(next.damping[at] * std::exp(std::clamp(move[n + k], -1.0, 1.0)),
                       kLeastFittedDamping, kMostFittedDamping);
      }
      solve_linear(data, next);
      const double now = misfit(data, next);
      if (now < best) {
        better = true;
        const bool done = best - now < 1e-10 * best;
        model = std::move(next);
        best = now;
        lambda = std::max(1e-9, 0.2 * lambda);
        if (done) {
          return;
        }
      } else {
        lambda *= 10.0;
      }
    }
  }
}

/// Estimates s and r of σ² = s² + r²·|H|² from the residual by maximum likelihood; returns −2 ln L.
double estimate_noise(Data& data, const Model& model) {
  const Eigen::ArrayXcd fitted = response(data, model);
  const ArrayXd left = (data.h - fitted).abs2();
  const ArrayXd size = fitted.abs2();
  const double mean = std::max(left.mean(), 1e-300);
  const auto cost = [&](double s2, double r2) {
    const ArrayXd variance = s2 + r2 * size;
    // Real and imaginary parts count as two independent measurements of equal variance.
    return 2.0 * (variance.log() + left / variance).sum();
  };
  double s2 = mean;
  double r2 = 0.0;
  double best = cost(s2, r2);
  // A grid over the share of s, each with the scale that is best for it, in closed form.
  // From 1e-12 to 1e6 of the mean |H|² in steps of 0.15 decades.
  constexpr int kShares = 121;
  for (int i = 0; i < kShares; ++i) {
    const double ratio = std::pow(10.0, -12.0 + 0.15 * i) * size.mean();
    const ArrayXd shape = ratio + size;
    const double scale = std::max((left / shape).mean(), 1e-300);
    const double now = cost(scale * ratio, scale);
    if (now < best) {
      best = now;
      s2 = scale * ratio;
      r2 = scale;
    }
  }
  data.noise_mm_n = std::sqrt(s2);
  data.noise_ratio = std::sqrt(r2);
  data.weight = (s2 + r2 * size).rsqrt();
  return best;
}

/// Adds a mode where the residual stands out most against the noise.
Model with_one_more(const Data& data, const Model& model) {
  const ArrayXd left = model.linear.size() == 0
                           ? ArrayXd(data.h.abs() * data.weight)
                           : ArrayXd((data.h - response(data, model)).abs() * data.weight);
  std::vector<Index> peaks;
  for (Index i = 0; i < left.size(); ++i) {
    const Index from = std::max<Index>(0, i - 3);
    const Index count = std::min<Index>(7, left.size() - from);
    if (left[i] >= left.segment(from, count).maxCoeff()) {
      peaks.push_back(i);
    }
  }
  std::ranges::sort(peaks, [&](Index a, Index b) { return left[a] > left[b]; });
  peaks.resize(std::min<std::size_t>(peaks.size(), 6));
  // A mode next to a known one distorts that one: those places are tried too.
  std::vector<double> places;
  places.reserve(peaks.size() + 2 * model.w.size());
  for (const Index i : peaks) {
    places.push_back(data.w[i]);
  }
  // One half-width, ζ·ω, to either side.
  for (std::size_t k = 0; k < model.w.size(); ++k) {
    places.push_back(model.w[k] * (1.0 + model.damping[k]));
    places.push_back(model.w[k] * (1.0 - model.damping[k]));
  }
  std::optional<Model> best;
  double least = 0.0;
  for (const double place : places) {
    for (const double damping : {0.003, 0.01, 0.03, 0.1}) {
      Model next = model;
      next.w.push_back(place);
      next.damping.push_back(damping);
      solve_linear(data, next);
      const double now = misfit(data, next);
      // At a drive point every modal mass is positive; a negative one is noise or a wrong sign.
      if (next.linear[next.modes() - 1] > 0.0 && (!best || now < least)) {
        least = now;
        best = std::move(next);
      }
    }
  }
  return best ? *best : model;
}

bool sound(const Data& data, const Model& model) {
  for (Index k = 0; k < model.modes(); ++k) {
    const auto at = static_cast<std::size_t>(k);
    // A mode at a bound or outside the band represents background or noise.
    if (!(model.linear[k] > 0.0) || model.damping[at] >= kMostFittedDamping ||
        model.damping[at] <= kLeastFittedDamping || model.w[at] < 0.9 * data.w.minCoeff() ||
        model.w[at] > 1.1 * data.w.maxCoeff()) {
      return false;
    }
  }
  return true;
}

ModeFit result_of(const Data& data, const Model& model) {
  ModeFit out;
  for (Index k = 0; k < model.modes(); ++k) {
    const auto at = static_cast<std::size_t>(k);
    const double mass = 1000.0 / model.linear[k];
    out.modes.push_back(
        {model.w[at] / kTurn, model.damping[at], mass, mass * model.w[at] * model.w[at] * 1e-3});
  }
  std::ranges::sort(out.modes, {}, &FittedMode::frequency_hz);
  const Eigen::ArrayXcd left = data.h - response(data, model);
  out.residual = std::sqrt(left.abs2().sum() / data.h.abs2().sum());
  out.noise_ratio = data.noise_ratio;
  out.noise_mm_n = data.noise_mm_n;
  out.upper_mm_n = model.linear[model.modes()];
  out.lower_mm_n_s2 = model.linear[model.modes() + 1] * data.middle_w * data.middle_w;
  out.points = static_cast<std::size_t>(data.w.size());
  return out;
}

Data gather(std::span<const Frf> responses, const ModeFitConfig& config) {
  std::vector<double> w;
  std::vector<Complex> h;
  for (const Frf& frf : responses) {
    for (std::size_t i = 0; i < frf.frequency_hz.size(); ++i) {
      const double f = frf.frequency_hz[i];
      if (f > 0.0 && f >= config.least_frequency_hz && f <= config.most_frequency_hz) {
        w.push_back(kTurn * f);
        h.push_back(frf.compliance_mm_n[i]);
      }
    }
  }
  Data out;
  out.w = Eigen::Map<ArrayXd>(w.data(), static_cast<Index>(w.size()));
  out.h = Eigen::Map<Eigen::ArrayXcd>(h.data(), static_cast<Index>(h.size()));
  if (!w.empty()) {
    // Geometric: the background terms go with powers of ω.
    out.middle_w = std::exp(out.w.log().mean());
    // Initial guess: a tenth of the response and of its mean.
    out.weight = (out.h.abs2() + out.h.abs2().mean()).rsqrt() * 10.0;
  }
  return out;
}

}  // namespace

Complex response_mm_n(const ModeFit& fit, double frequency_hz) noexcept {
  const double w = kTurn * frequency_hz;
  Complex out = fit.upper_mm_n - fit.lower_mm_n_s2 / (w * w);
  for (const FittedMode& mode : fit.modes) {
    out += 1000.0 / mode.mass_kg * base(w, kTurn * mode.frequency_hz, mode.damping_ratio);
  }
  return out;
}

Result<ModeFit> fit_modes(std::span<const Frf> responses, const ModeFitConfig& config) {
  for (const auto check : {other_point, given_twice}) {
    if (auto refusal = check(responses)) {
      return std::unexpected(std::move(*refusal));
    }
  }
  Data data = gather(responses, config);
  const std::size_t most = config.order > 0 ? config.order : config.most_modes;
  constexpr int kSteps = 60;
  if (data.w.size() < static_cast<Index>(kLeastPoints) || most < 1 || most > 16) {
    return refuse(
        fmt::format(
            "{} points in the band for up to {} modes; {} points are needed, and 1 … 16 modes",
            data.w.size(), most, kLeastPoints),
        "give more of the response or fewer modes");
  }
  Model model;
  std::optional<ModeFit> best;
  std::vector<double> criterion;
  double least = 0.0;
  for (std::size_t n = 1; n <= most; ++n) {
    const Index unknowns = kPerMode * static_cast<Index>(n) + kBackground;
    Model next = unknowns < 2 * data.w.size() ? with_one_more(data, model) : model;
    if (next.w.size() != n) {
      break;
    }
    double likelihood = 0.0;
    // Noise and modes depend on each other: the weights come from the noise, the noise from the
    // residual.
    for (int round = 0; round < kRounds; ++round) {
      refine(data, next, kSteps);
      likelihood = estimate_noise(data, next);
    }
    model = next;
    // BIC (Schwarz 1978): the two extra unknowns are s and r of the noise; each point counts twice,
    // real and imaginary.
    criterion.push_back(likelihood + static_cast<double>(unknowns + 2) *
                                         std::log(2.0 * static_cast<double>(data.w.size())));
    const bool wanted = config.order > 0 ? n == config.order : !best || criterion.back() < least;
    if (wanted && sound(data, next)) {
      best = result_of(data, next);
      least = criterion.back();
    }
    // Stops after two orders in a row worse than the best.
    if (config.order == 0 && n >= 2 && criterion.back() > least + 20.0 &&
        criterion[n - 2] > least) {
      break;
    }
  }
  if (!best) {
    return refuse("no mode with a positive mass explains the response",
                  "check the sign and the unit, and that this is a drive-point response");
  }
  if (auto refusal = no_more_than_noise(data.w, data.h, best->modes.size(), best->residual)) {
    return std::unexpected(std::move(*refusal));
  }
  best->criterion = criterion;
  return *best;
}

}  // namespace steadyrest::chatter::offline
