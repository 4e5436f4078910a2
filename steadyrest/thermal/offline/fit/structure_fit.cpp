// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>
#include <Eigen/QR>

#include <steadyrest/thermal/offline/fit/structure_fit.hpp>
#include <steadyrest/thermal/offline/log/lagged.hpp>

// Variable projection (Golub and Pereyra 1973): for given time constants everything else is linear
// and solved by QR, so only ln τ is searched, by damped Gauss–Newton on the projected residuals.
// Two or three unknowns remain of a dozen, and levels and gains need no start values.
namespace steadyrest::thermal::offline {
namespace {

constexpr double kNoises = 3.0;

/// The fitted rows, their times and where a stretch begins.
struct Subset {
  Eigen::MatrixXd matrix;  ///< columns, then the readings
  std::vector<double> time_s;
  std::vector<std::size_t> fresh;
};

Subset subset(const Eigen::MatrixXd& columns, const FitData& data,
              std::optional<RowRange> left_out) {
  const RowRange hole = left_out.value_or(RowRange{0, 0});
  Subset out;
  out.matrix.resize(static_cast<Eigen::Index>(data.rows() - (hole.end - hole.begin)),
                    columns.cols() + 1);
  out.time_s.reserve(data.rows() - (hole.end - hole.begin));
  auto fresh = data.fresh.begin();
  bool begins = false;
  // A hole in the rows counts as time passed, not as a gap: the drift beyond it still remembers.
  // Only a recorded gap makes the next row fresh.
  for (std::size_t i = 0; i < data.rows(); ++i) {
    if (fresh != data.fresh.end() && *fresh == i) {
      begins = true;
      ++fresh;
    }
    if (i >= hole.begin && i < hole.end) {
      continue;
    }
    const auto to = static_cast<Eigen::Index>(out.time_s.size());
    const auto from = static_cast<Eigen::Index>(i);
    if (begins) {
      out.fresh.push_back(out.time_s.size());
      begins = false;
    }
    out.matrix.row(to).head(columns.cols()) = columns.row(from);
    out.matrix(to, columns.cols()) = data.reading_um(from);
    out.time_s.push_back(data.time_s[i]);
  }
  return out;
}

/// The free time constants, as one list of their logarithms.
std::vector<double*> free_taus(Structure& s) {
  std::vector<double*> out;
  out.reserve(2 * s.mode.size());
  for (Structure::Mode& m : s.mode) {
    out.push_back(&m.tau_s);
  }
  for (Structure::Mode& m : s.mode) {
    if (m.rest_tau_s > 0.0) {
      out.push_back(&m.rest_tau_s);
    }
  }
  for (Structure::Ambient& a : s.ambient) {
    if (a.tau_s > 0.0 && !s.dense) {
      out.push_back(&a.tau_s);
    }
  }
  return out;
}

bool allowed(const Structure& s) {
  for (const Structure::Mode& a : s.mode) {
    for (const Structure::Mode& b : s.mode) {
      // Two modes with nearly the same time constant are one mode plus a pair of large opposite
      // amplitudes.
      if (&a != &b && std::max(a.tau_s, b.tau_s) < kSeparation * std::min(a.tau_s, b.tau_s)) {
        return false;
      }
    }
  }
  return true;
}

/// Variable projection: residuals as a function of only the logarithms of the time constants.
class Projection {
 public:
  Projection(Structure structure, const FitData& data, const ErrorModel& error,
             const LinearPrior& prior)
      : structure_(std::move(structure)), data_(data), error_(error), prior_(prior) {
    for (const double* tau : free_taus(structure_)) {
      at_.push_back(std::log(*tau));
    }
  }

  [[nodiscard]] Structure with(const std::vector<double>& ln_tau) const {
    Structure out = structure_;
    const auto taus = free_taus(out);
    for (std::size_t i = 0; i < taus.size(); ++i) {
      *taus[i] = std::exp(std::clamp(ln_tau[i], std::log(kLeastTau_s), std::log(kMostTau_s)));
    }
    return out;
  }
  [[nodiscard]] Eigen::VectorXd residual(const std::vector<double>& ln_tau) const {
    const Structure s = with(ln_tau);
    return fit_linear(columns_of(s, *data_.log, data_.row), data_, error_, prior_).white;
  }
  [[nodiscard]] const std::vector<double>& start() const { return at_; }

  [[nodiscard]] Eigen::MatrixXd jacobian(const std::vector<double>& at,
                                         const Eigen::VectorXd& here) const {
    // Forward difference, 2 % of τ.
    constexpr double kStep = 0.02;
    Eigen::MatrixXd out(here.size(), static_cast<Eigen::Index>(at.size()));
    for (std::size_t i = 0; i < at.size(); ++i) {
      std::vector<double> moved = at;
      // Towards the middle of the range: beyond its ends nothing changes.
      const double step = at[i] > std::log(1200.0) ? -kStep : kStep;
      moved[i] += step;
      out.col(static_cast<Eigen::Index>(i)) = (residual(moved) - here) / step;
    }
    return out;
  }

 private:
  Structure structure_;
  const FitData& data_;
  const ErrorModel& error_;
  const LinearPrior& prior_;
  std::vector<double> at_;
};

}  // namespace

LinearPrior wide_prior(const Structure& structure, const FitData& data) {
  const double most = std::max(data.fastest_rev_s * kPer_rev_s, 0.1);
  std::vector<double> usual;
  for (std::size_t m = 0; m < structure.mode.size(); ++m) {
    for (std::size_t p = 0; p < structure.level_terms(); ++p) {
      usual.push_back(structure.usual.level_um /
                      (structure.table_rev_s.empty() ? std::pow(most, structure.power[p]) : 1.0));
    }
  }
  usual.insert(usual.end(), structure.ambient.size(), structure.usual.gain_um_k);
  // Without inputs the gauge's zero is at the first reading, except for that reading's noise.
  usual.push_back(structure.ambient.empty() ? kNoises * data.noise_um : kFree);
  usual.insert(usual.end(), structure.mode.size() * (data.log->gap.size() + 1),
               structure.usual.state_um);
  const auto n = static_cast<Eigen::Index>(usual.size());
  LinearPrior out{Eigen::VectorXd::Zero(n), Eigen::MatrixXd::Zero(n, n)};
  for (Eigen::Index i = 0; i < n; ++i) {
    // root is R of the precision RᵀR: standard deviations as reciprocals on its diagonal.
    out.root(i, i) = 1.0 / usual[static_cast<std::size_t>(i)];
  }
  const std::vector<double>& table = structure.table_rev_s;
  for (std::size_t m = 0; m < structure.mode.size(); ++m) {
    for (std::size_t k = 0; k < table.size(); ++k) {
      const auto i = static_cast<Eigen::Index>(m * table.size() + k);
      const double step = table[k] - (k == 0 ? 0.0 : table[k - 1]);
      // A random walk from speed to speed whose variance at the fastest speed is usual²: each step
      // has its share.
      out.root(i, i) *= std::sqrt(table.back() / step);
      if (k > 0) {
        // Row k is the increment G_k − G_{k−1}.
        out.root(i, i - 1) = -out.root(i, i);
      }
    }
  }
  return out;
}

LinearFit fit_linear(const Eigen::MatrixXd& columns, const FitData& data, const ErrorModel& error,
                     const LinearPrior& prior, std::optional<RowRange> left_out) {
  Subset rows = subset(columns, data, left_out);
  LinearFit out;
  out.log_sum = whiten(error, rows.time_s, rows.fresh, rows.matrix);
  const Eigen::Index n = rows.matrix.rows();
  const Eigen::Index p = columns.cols();
  Eigen::MatrixXd a(n + p, p);
  Eigen::VectorXd b(n + p);
  a.topRows(n) = rows.matrix.leftCols(p);
  b.head(n) = rows.matrix.col(p);
  // The prior as additional rows of unit variance.
  a.bottomRows(p) = prior.root;
  b.tail(p) = prior.root * prior.mean;
  // Columns of unit length: levels in µm at (1000 rpm)² and gains in µm/K differ by orders of
  // magnitude.
  const Eigen::VectorXd scale = a.colwise().norm();
  const Eigen::MatrixXd even = a * scale.cwiseInverse().asDiagonal();
  // QR on the rows themselves: normal equations would square the condition, and modes with τ a
  // factor of two apart are already nearly parallel.
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(even);
  const Eigen::MatrixXd r = qr.matrixQR().topRows(p).triangularView<Eigen::Upper>();
  const Eigen::VectorXd rotated = qr.householderQ().transpose() * b;
  const Eigen::VectorXd solved = r.triangularView<Eigen::Upper>().solve(rotated.head(p));
  out.amplitude = solved.cwiseQuotient(scale);
  out.white = b - a * out.amplitude;
  const Eigen::MatrixXd inverse =
      r.triangularView<Eigen::Upper>().solve(Eigen::MatrixXd::Identity(p, p));
  const Eigen::MatrixXd un = scale.cwiseInverse().asDiagonal() * inverse;
  // (AᵀA)⁻¹ = R⁻¹R⁻ᵀ, scaled back. The error model is assumed true, so no residual variance enters.
  out.covariance = un * un.transpose();
  out.log_det = -2.0 * (r.diagonal().array().abs().log().sum() + scale.array().log().sum());
  out.condition = r.norm() * inverse.norm() / static_cast<double>(p);
  return out;
}

double log_evidence(const LinearFit& fit, const LinearPrior& prior) {
  // The prior's root may be any square matrix: QR gives its determinant.
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(prior.root);
  const double log_root = qr.matrixQR().diagonal().array().abs().log().sum();
  return 0.5 * (fit.log_det - fit.white.squaredNorm() - fit.log_sum) + log_root;
}

Refined refine(Structure structure, const FitData& data, const ErrorModel& error,
               const LinearPrior& prior) {
  const Projection projection(std::move(structure), data, error, prior);
  std::vector<double> at = projection.start();
  Eigen::VectorXd here = projection.residual(at);
  double damping = 1e-3;
  Eigen::MatrixXd jacobian = projection.jacobian(at, here);
  for (int iteration = 0; iteration < 12 && !at.empty(); ++iteration) {
    const Eigen::MatrixXd normal = jacobian.transpose() * jacobian;
    Eigen::MatrixXd damped = normal;
    damped.diagonal() *= 1.0 + damping;
    // A time constant at its bound has a column of zeros.
    damped.diagonal().array() += 1e-9;
    const Eigen::VectorXd step = -damped.ldlt().solve(jacobian.transpose() * here);
    std::vector<double> next = at;
    for (std::size_t i = 0; i < at.size(); ++i) {
      // At most a factor of 2 in τ per step.
      next[i] = std::clamp(at[i] + std::clamp(step(static_cast<Eigen::Index>(i)), -0.7, 0.7),
                           std::log(kLeastTau_s), std::log(kMostTau_s));
    }
    const Eigen::VectorXd there = projection.residual(next);
    const double gain = 1.0 - there.squaredNorm() / here.squaredNorm();
    if (!(gain > 0.0) || !allowed(projection.with(next))) {
      damping *= 10.0;
      if (damping > 1e4) {
        break;
      }
      continue;
    }
    at = next;
    here = there;
    damping = std::max(damping * 0.2, 1e-9);
    jacobian = projection.jacobian(at, here);
    if (gain < 1e-6) {
      break;
    }
  }
  Refined out{projection.with(at), std::vector<double>(at.size(), 0.0),
              std::vector<double>(at.size(), 0.0)};
  if (!at.empty()) {
    const double s2 = here.squaredNorm() / std::max(1.0, static_cast<double>(data.rows()) -
                                                             static_cast<double>(at.size()));
    const Eigen::MatrixXd normal =
        jacobian.transpose() * jacobian +
        0.25 * Eigen::MatrixXd::Identity(jacobian.cols(), jacobian.cols());  // a sd of 2 at most
    const Eigen::MatrixXd inverse =
        normal.ldlt().solve(Eigen::MatrixXd::Identity(normal.rows(), normal.cols()));
    const Eigen::VectorXd variance = inverse.diagonal() * s2;
    for (std::size_t i = 0; i < at.size(); ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      out.ln_tau_sd[i] = std::sqrt(variance(k));
      // With all others fixed: for a passport that treats them as independent.
      out.ln_tau_alone_sd[i] = std::sqrt(s2 / normal(k, k));
    }
  }
  return out;
}

// Drift over noise and drift time by maximum likelihood; their common scale follows in closed form.
ErrorModel likely_error(const Eigen::MatrixXd& columns, const FitData& data,
                        const LinearPrior& prior) {
  ErrorModel best;
  double least = std::numeric_limits<double>::infinity();
  const auto n = static_cast<double>(data.rows());
  // A coarse grid is enough: the likelihood is flat in both.
  for (const double tau_min : {30.0, 60.0, 120.0, 240.0, 480.0}) {
    for (const double ratio : {0.03, 0.3, 1.0, 3.0, 10.0, 30.0, 100.0}) {
      ErrorModel error{ratio * data.noise_um, 60.0 * tau_min, data.noise_um};
      const LinearFit fit = fit_linear(columns, data, error, prior);
      const double s2 = fit.white.squaredNorm() / n;
      // −2 ln L with the common scale s² eliminated: only ratio and τ are searched.
      const double cost = n * std::log(s2) + fit.log_sum;
      if (cost < least) {
        least = cost;
        best = {error.drift_um * std::sqrt(s2), error.tau_s, error.noise_um * std::sqrt(s2)};
      }
    }
  }
  return best;
}

double bayes_criterion(const LinearFit& fit, const Structure& structure, std::size_t rows) {
  const auto n = static_cast<double>(rows);
  // −2·ln L + k·ln n (Schwarz 1978); the prior rows are part of the squares.
  return fit.white.squaredNorm() + fit.log_sum +
         static_cast<double>(structure.parameters()) * std::log(n);
}

}  // namespace steadyrest::thermal::offline
