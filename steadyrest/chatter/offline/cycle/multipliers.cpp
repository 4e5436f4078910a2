// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <random>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>

#include <steadyrest/chatter/offline/cycle/multipliers.hpp>

// Arnoldi's method needs only products with the map, which cost a pass each, and finds the
// outermost multipliers in a few tens of them. Where the vibration grows by many orders within a
// slow period and dies again, the product of passes is rounding noise; there the discrete QR method
// of Lyapunov exponents (Benettin et al., Meccanica 15 (1980) 9) orthonormalises at each pass and
// adds logarithms.
namespace steadyrest::chatter::offline {
namespace {

using Complex = std::complex<double>;
using Eigen::Index;

constexpr Index kMostKrylov = 90;
constexpr Index kPerKrylov = 8;  ///< of the state: at low speed many multipliers are nearly alike
constexpr Index kMostAtLowSpeed = 300;
constexpr double kAlike = 0.99;  ///< of the largest modulus: these must settle with it
constexpr Index kFirstKrylov = 6;
constexpr Index kKrylovStep = 4;
constexpr Index kLeastBasis = 2;  ///< vectors of the QR method: the leading ones may be a pair
/// ln of the growth within a period over |μ| up to which Arnoldi's values are right to 1e-9:
/// rounding of 2e-16, grown by e^14 ≈ 1.2e6, leaves 3e-10.
constexpr double kSafeLogGrowth = 14.0;
constexpr int kMostPeriods = 16;

// A fixed seed: the same cut gives the same digits in every run. Gaussian entries omit no
// direction.
Eigen::VectorXd start_vector(Index size) {
  std::mt19937_64 random(20260401);
  std::normal_distribution<double> normal;
  Eigen::VectorXd v(size);
  for (Index i = 0; i < size; ++i) {
    v[i] = normal(random);
  }
  return v.normalized();
}

struct Ritz {
  std::vector<Complex> value;
  double residual = 1.0;
  Eigen::VectorXd vector;  ///< real part of the dominant one
};

Ritz ritz(const Eigen::MatrixXd& h, const Eigen::MatrixXd& v, Index m, std::size_t wanted) {
  const Eigen::EigenSolver<Eigen::MatrixXd> eigen(h.topLeftCorner(m, m));
  std::vector<Index> order(static_cast<std::size_t>(m));
  std::iota(order.begin(), order.end(), Index{0});
  const auto& values = eigen.eigenvalues();
  std::ranges::sort(order,
                    [&](Index a, Index b) { return std::abs(values[a]) > std::abs(values[b]); });
  Ritz out;
  for (std::size_t i = 0; i < std::min(wanted, order.size()); ++i) {
    out.value.push_back(values[order[i]]);
  }
  const Eigen::MatrixXcd vectors = eigen.eigenvectors();
  const Eigen::VectorXcd y = vectors.col(order[0]).normalized();
  out.residual = 0.0;
  // A settled one may hide another of nearly the same modulus that has not settled.
  const double alike = kAlike * std::abs(values[order[0]]);
  for (const Index i : order) {
    if (std::abs(values[i]) < alike) {
      break;
    }
    const double last = std::abs(vectors(m - 1, i)) / vectors.col(i).norm();
    // |h(m+1,m)|·|last entry of y| is the residual of a Ritz pair (Saad), here relative to its
    // value.
    out.residual = std::max(out.residual,
                            std::abs(h(m, m - 1)) * last / std::max(std::abs(values[i]), 1e-300));
  }
  out.vector = (v.leftCols(m) * y).real();
  return out;
}

/// A vibration grew beyond a double's range.
Ritz beyond(const Eigen::VectorXd& start) {
  return {.value = {std::exp(kBeyondLog)}, .residual = 0.0, .vector = start};
}

using Map = std::function<void(Eigen::Ref<Eigen::VectorXd>)>;

Ritz arnoldi(const Map& apply, Index size, std::size_t wanted, double tolerance,
             std::size_t& applied) {
  const Index most = std::min(size, std::clamp(size / kPerKrylov, kMostKrylov, kMostAtLowSpeed));
  Eigen::MatrixXd v = Eigen::MatrixXd::Zero(size, most + 1);
  Eigen::MatrixXd h = Eigen::MatrixXd::Zero(most + 1, most);
  v.col(0) = start_vector(size);
  Index look = std::min(kFirstKrylov, most);
  for (Index k = 0; k < most; ++k) {
    Eigen::VectorXd w = v.col(k);
    apply(w);
    ++applied;
    const double grown = w.norm();
    // Very slow laws overflow within one period; "far beyond stable" is then answer enough.
    if (!std::isfinite(grown)) {
      return beyond(v.col(0));
    }
    // Classical Gram–Schmidt twice: a single pass loses orthogonality when the map grows a vector
    // by many orders.
    for (int twice = 0; twice < 2; ++twice) {
      const Eigen::VectorXd c = v.leftCols(k + 1).transpose() * w;
      w -= v.leftCols(k + 1) * c;
      h.col(k).head(k + 1) += c;
    }
    const double left = w.norm();
    // Below rounding the Krylov space is invariant, and its Ritz values are exact.
    const bool whole = left <= 1e-14 * grown || k + 1 == most;
    h(k + 1, k) = whole && left <= 1e-14 * grown ? 0.0 : left;
    if (k + 1 == look || whole) {
      Ritz out = ritz(h, v, k + 1, wanted);
      if (out.residual < tolerance || whole) {
        return out;
      }
      // Solving the whole eigenvalue problem after each step would cost more than the steps.
      look = std::min(look + std::max(kKrylovStep, look / 8), most);
    }
    v.col(k + 1) = w / left;
  }
  return ritz(h, v, most, wanted);
}

/// A basis driven through the period and kept orthonormal, and the triangular map of the steps so
/// far: start vectors become basis·triangle·e^log_scale.
struct Frame {
  Eigen::MatrixXd basis;
  Eigen::MatrixXd triangle;
  double log_scale = 0.0;

  void renew() {
    const Eigen::HouseholderQR<Eigen::MatrixXd> qr(basis);
    const Index k = basis.cols();
    const Eigen::MatrixXd r = qr.matrixQR().topRows(k).triangularView<Eigen::Upper>();
    basis = qr.householderQ() * Eigen::MatrixXd::Identity(basis.rows(), k);
    triangle = (r * triangle).eval();
    // The triangle grows by many orders over a slow period; its scale is kept as a logarithm.
    const double scale = std::max(triangle.cwiseAbs().maxCoeff(), 1e-300);
    triangle /= scale;
    log_scale += std::log(scale);
  }

  /// Drives through one period; false: it overflowed.
  bool drive(DelayCycle& cycle) {
    triangle = Eigen::MatrixXd::Identity(basis.cols(), basis.cols());
    log_scale = 0.0;
    for (std::size_t p = 0; p < cycle.passes(); ++p) {
      for (Index i = 0; i < basis.cols(); ++i) {
        cycle.advance(p, basis.col(i));
      }
      if (!basis.allFinite()) {
        return false;
      }
      renew();
    }
    return true;
  }
};

/// The eigenvalues of a small map, the largest first.
std::vector<Complex> eigenvalues(const Eigen::MatrixXd& map) {
  const Eigen::EigenSolver<Eigen::MatrixXd> eigen(map, false);
  std::vector<Complex> out(eigen.eigenvalues().begin(), eigen.eigenvalues().end());
  std::ranges::stable_sort(out, std::ranges::greater{}, [](Complex v) { return std::abs(v); });
  return out;
}

/// The period's map within the subspace that the vectors settle on has the dominant multipliers as
/// its eigenvalues; all directions are re-orthonormalised at each pass, so none is lost in
/// another's rounding. Each column depends only on those before it: vectors beyond the wanted ones
/// would change nothing.
std::vector<Complex> discrete_qr(DelayCycle& cycle, std::size_t wanted, double tolerance,
                                 Multipliers& out) {
  const Index size = cycle.state_size();
  const Index k = std::min(std::max(kLeastBasis, static_cast<Index>(wanted)), size);
  Frame frame;
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  frame.basis = Eigen::MatrixXd::NullaryExpr(size, k, [&] { return normal(random); });
  frame.triangle = Eigen::MatrixXd::Identity(k, k);
  frame.renew();
  double before = 1e300;
  std::vector<Complex> value;
  for (int period = 0; period < kMostPeriods; ++period) {
    // The basis at the period's end starts the next period, so it settles on the dominant
    // directions from period to period.
    const Eigen::MatrixXd start = frame.basis;
    if (!frame.drive(cycle)) {
      out.log_modulus = {kBeyondLog};
      out.vector = start.col(0);
      return {1.0};
    }
    out.passes_done += cycle.passes() * static_cast<std::size_t>(k);
    // The triangle gives the period's map in the new basis; the product converts it to the old one.
    value = eigenvalues(start.transpose() * frame.basis * frame.triangle);
    const double log_modulus = std::log(std::max(std::abs(value[0]), 1e-300)) + frame.log_scale;
    out.residual = std::abs(log_modulus - before);
    out.log_modulus = {log_modulus};
    // Not after the first period: a chance agreement before the basis has settled proves nothing.
    if (period > 1 && out.residual < tolerance * (1.0 + std::abs(log_modulus))) {
      break;
    }
    before = log_modulus;
  }
  value.resize(std::min(value.size(), wanted));
  // The scaled map gives only the ratios; the scale is in the first one's logarithm.
  for (std::size_t i = 1; i < value.size(); ++i) {
    out.log_modulus.push_back(out.log_modulus[0] +
                              std::log(std::max(std::abs(value[i]), 1e-300) / std::abs(value[0])));
  }
  const double scale = std::abs(value[0]);
  for (Complex& v : value) {
    v /= scale;
  }
  out.vector = frame.basis.col(0);
  return value;
}

/// ln of the largest growth from one pass to a later one, for the solution with this start.
double log_growth_within(DelayCycle& cycle, Eigen::VectorXd state) {
  double log_size = 0.0;
  double least = 0.0;
  double peak = 0.0;
  state.normalize();
  for (std::size_t p = 0; p < cycle.passes(); ++p) {
    cycle.advance(p, state);
    const double norm = std::max(state.norm(), 1e-300);
    log_size += std::log(norm);
    state /= norm;
    // Largest rise from any earlier minimum: both its ends are pass boundaries within this period.
    peak = std::max(peak, log_size - least);
    least = std::min(least, log_size);
  }
  return peak;
}

}  // namespace

Multipliers multipliers_of(const Map& apply, Index size, std::size_t wanted, double tolerance) {
  Multipliers out;
  const Ritz found = arnoldi(apply, size, wanted, tolerance, out.passes_done);
  out.value = found.value;
  out.residual = found.residual;
  for (const Complex& value : found.value) {
    out.log_modulus.push_back(std::log(std::max(std::abs(value), 1e-300)));
  }
  out.vector = found.vector;
  return out;
}

Multipliers multipliers(DelayCycle& cycle, std::size_t wanted, double tolerance) {
  Multipliers out = multipliers_of([&](const auto& state) { cycle.apply(state); },
                                   cycle.state_size(), wanted, tolerance);
  out.passes_done *= cycle.passes();
  // A growth out of range over the period may still be in range from pass to pass.
  if (cycle.passes() > 1 &&
      (out.log_modulus[0] >= kBeyondLog ||
       log_growth_within(cycle, out.vector) - out.log_modulus[0] > kSafeLogGrowth)) {
    out.value = discrete_qr(cycle, wanted, std::max(tolerance, 1e-9), out);
  }
  return out;
}

}  // namespace steadyrest::chatter::offline
