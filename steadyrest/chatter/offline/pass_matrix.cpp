// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <Eigen/LU>

#include <steadyrest/chatter/offline/cutting_coefficients.hpp>
#include <steadyrest/chatter/offline/gauss_nodes.hpp>
#include <steadyrest/chatter/offline/pass_matrix.hpp>

namespace steadyrest::chatter::offline {
namespace {

using Complex = std::complex<double>;
using Eigen::Index;

constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr double kPiecePhase = 5.0;  ///< of the fastest oscillation
constexpr Index kNodes = 14;
constexpr std::size_t kMostTerms = 32;
constexpr double kLeastTerm = 1e-14;

/// The modes' answers over one piece of equal step at constant speed; the same for all pieces of
/// that length.
struct Answers {
  Eigen::MatrixXd phi;  ///< displacement at the nodes from the state, cn×2m; c directions
  Eigen::MatrixXd k;    ///< … from the forces, cn×cn
  Eigen::MatrixXd e;    ///< state at the end from the state
  Eigen::MatrixXd r;    ///< … from the forces
};

Answers answers(const Process& process, double step_s, Index components) {
  const GaussNodes& gauss = GaussNodes::of(kNodes);
  const auto modes = static_cast<Index>(process.modes.size());
  const Eigen::MatrixXd s = step_s * gauss.integral;
  const Eigen::RowVectorXd end = step_s * gauss.weight.transpose();
  const Index size = components * kNodes;
  Answers out{Eigen::MatrixXd::Zero(size, 2 * modes), Eigen::MatrixXd::Zero(size, size),
              Eigen::MatrixXd::Zero(2 * modes, 2 * modes), Eigen::MatrixXd::Zero(2 * modes, size)};
  for (Index m = 0; m < modes; ++m) {
    const Mode& mode = process.modes[static_cast<std::size_t>(m)];
    const double w = kTurn * mode.frequency_hz;
    const double d = 2.0 * mode.damping_ratio * w;
    Eigen::MatrixXd a = d * s + w * w * step_s * step_s * gauss.integral2;
    a.diagonal().array() += 1.0;
    Eigen::MatrixXd right(kNodes, kNodes + 2);
    right.col(0) = -w * w * s.rowwise().sum();
    right.col(1).setConstant(w);
    right.rightCols(kNodes) = 1000.0 / mode.mass_kg * s;
    const Eigen::MatrixXd v = a.partialPivLu().solve(right);
    Eigen::MatrixXd q = s * v;
    q.col(0).array() += 1.0;
    const Eigen::RowVectorXd q_end = end * v;
    Eigen::RowVectorXd v_end = -w * w * (end * q) - d * q_end;
    v_end.tail(kNodes) += 1000.0 / mode.mass_kg * end;
    out.e.block(2 * m, 2 * m, 1, 2) = q_end.head(2);
    out.e.block(2 * m + 1, 2 * m, 1, 2) = v_end.head(2) / w;
    out.e(2 * m, 2 * m) += 1.0;
    out.e(2 * m + 1, 2 * m + 1) += 1.0;
    for (Index c = 0; c < components; ++c) {
      const double shape = mode.shape[static_cast<std::size_t>(c)];
      out.phi.block(c * kNodes, 2 * m, kNodes, 2) = shape * q.leftCols(2);
      out.r.block(2 * m, c * kNodes, 1, kNodes) = shape * q_end.tail(kNodes);
      out.r.block(2 * m + 1, c * kNodes, 1, kNodes) = shape * v_end.tail(kNodes) / w;
      for (Index b = 0; b < components; ++b) {
        const double both = shape * mode.shape[static_cast<std::size_t>(b)];
        out.k.block(c * kNodes, b * kNodes, kNodes, kNodes) += both * q.rightCols(kNodes);
      }
    }
  }
  return out;
}

/// 2×2 matrices by rows, one in each lane.
using Wide = double __attribute__((vector_size(PassMatrix::kLanes * sizeof(double))));
struct Matrices {
  Wide z_re{};
  Wide z_im{};
  std::array<Wide, 4> re{Wide{1.0, 1.0, 1.0, 1.0}, Wide{}, Wide{}, Wide{1.0, 1.0, 1.0, 1.0}};
  std::array<Wide, 4> im{};
};

/// From the left by Σ term[k]·z^k. Real polynomials at complex points need half of Horner's work:
/// b_k = c_k + 2·Re z·b_{k+1} − |z|²·b_{k+2} (Knuth, TAOCP 2, 4.6.4).
[[gnu::always_inline]] inline void step_lanes(const double* number, std::size_t terms,
                                              Matrices& m) {
  const Wide r = m.z_re + m.z_re;
  const Wide s = m.z_re * m.z_re + m.z_im * m.z_im;
  std::array<Wide, 4> b1{};
  std::array<Wide, 4> b2{};
  for (std::size_t k = terms - 1; k > 0; --k) {
    for (std::size_t i = 0; i < 4; ++i) {
      const Wide b = number[4 * k + i] + r * b1[i] - s * b2[i];
      b2[i] = b1[i];
      b1[i] = b;
    }
  }
  for (std::size_t i = 0; i < 4; ++i) {
    b2[i] = number[i] + m.z_re * b1[i] - s * b2[i];  // now the real part
    b1[i] = m.z_im * b1[i];                          // and the imaginary one
  }
  const auto re = m.re;
  const auto im = m.im;
  for (std::size_t row = 0; row < 2; ++row) {
    for (std::size_t col = 0; col < 2; ++col) {
      const std::size_t p = 2 * row;
      m.re[p + col] =
          b2[p] * re[col] - b1[p] * im[col] + b2[p + 1] * re[2 + col] - b1[p + 1] * im[2 + col];
      m.im[p + col] =
          b2[p] * im[col] + b1[p] * re[col] + b2[p + 1] * im[2 + col] + b1[p + 1] * re[2 + col];
    }
  }
}

#if defined(__x86_64__)
/// The same numbers, the lanes in one register: no product is fused with a sum.
__attribute__((target("avx2"))) void step_avx2(const double* number, std::size_t terms,
                                               Matrices& m) {
  step_lanes(number, terms, m);
}
#endif

void step(const double* number, std::size_t terms, Matrices& m) {
#if defined(__x86_64__)
  static const bool kWide = __builtin_cpu_supports("avx2") != 0;
  if (kWide) {
    step_avx2(number, terms, m);
    return;
  }
#endif
  step_lanes(number, terms, m);
}

/// Borders of what is smooth within one pass.
std::vector<double> borders(const CuttingCoefficients& coefficients, double pass_rad) {
  std::vector<double> all{0.0, pass_rad};
  for (std::size_t j = 0; j < coefficients.teeth(); ++j) {
    for (const double c : coefficients.corners_rad(j)) {
      all.push_back(c - std::floor(c / pass_rad + 1e-12) * pass_rad);
    }
  }
  std::ranges::sort(all);
  std::vector<double> out;
  for (const double c : all) {
    if (out.empty() || c - out.back() > 1e-10) {
      out.push_back(c);
    }
  }
  out.back() = pass_rad;
  return out;
}

double fastest_rad_s(const Process& process, double most_z_mm) {
  const double stiffness =
      most_z_mm * std::hypot(process.cut.tangential_n_mm2, process.cut.radial_n_mm2);
  double square = 0.0;
  for (const Mode& mode : process.modes) {
    const double w = kTurn * mode.frequency_hz;
    square = std::max(square, w * w + 1000.0 / mode.mass_kg * stiffness);
  }
  return std::sqrt(square);
}

}  // namespace

bool PassMatrix::simple(const Process& process) noexcept {
  return process.even_pitch() && process.cut.process_damping_n_mm == 0.0 &&
         (process.tool.helix_rad == 0.0 || process.cut.operation == Operation::turning);
}

PassMatrix::PassMatrix(const Process& process, double speed_rev_s, double most_z_mm)
    : order_(2 * static_cast<Index>(process.modes.size())), most_z_mm_(most_z_mm) {
  const CuttingCoefficients coefficients(process, 0.0);
  const double pass_rad = kTurn / static_cast<double>(process.tool.teeth);
  const double pass_s = pass_rad / (kTurn * speed_rev_s);
  const double fastest = fastest_rad_s(process, most_z_mm);
  const GaussNodes& gauss = GaussNodes::of(kNodes);
  for (const Mode& mode : process.modes) {
    const double w = kTurn * mode.frequency_hz;
    const double z = mode.damping_ratio;
    free_.push_back(std::exp(Complex(-z * w, w * std::sqrt(1.0 - z * z)) * pass_s));
    free_determinant_ *= std::exp(-2.0 * z * w * pass_s);
  }
  const Index components =
      std::ranges::all_of(process.modes, [](const Mode& m) { return m.shape[1] == 0.0; }) ? 1 : 2;
  const std::vector<double> corner = borders(coefficients, pass_rad);
  for (std::size_t i = 0; i + 1 < corner.size(); ++i) {
    const double length = corner[i + 1] - corner[i];
    const double length_s = length / pass_rad * pass_s;
    const double parts = std::max(1.0, std::ceil(length_s * fastest / kPiecePhase));
    const Answers a = answers(process, length_s / parts, components);
    for (double part = 0.0; part < parts; part += 1.0) {
      Eigen::MatrixXd hphi = Eigen::MatrixXd::Zero(components * kNodes, order_);
      Eigen::MatrixXd hk = Eigen::MatrixXd::Zero(components * kNodes, components * kNodes);
      for (Index n = 0; n < kNodes; ++n) {
        const double angle = corner[i] + length * (part + gauss.node[n]) / parts;
        Eigen::Matrix2d h = Eigen::Matrix2d::Zero();
        for (std::size_t j = 0; j < coefficients.teeth(); ++j) {
          h += coefficients.stiffness(j, angle);
        }
        for (Index c = 0; c < components; ++c) {
          for (Index b = 0; b < components; ++b) {
            hphi.row(c * kNodes + n) += h(c, b) * a.phi.row(b * kNodes + n);
            hk.row(c * kNodes + n) += h(c, b) * a.k.row(b * kNodes + n);
          }
        }
      }
      // (I + z·HK)⁻¹ as a series: HK is a Volterra operator, its powers fall as 1/(2k)!.
      Series series;
      series.term.push_back(a.e);
      Eigen::MatrixXd force = -hphi;
      double power = 1.0;
      while (series.term.size() < kMostTerms) {
        series.term.emplace_back(a.r * force);
        power *= most_z_mm;
        if (series.term.back().cwiseAbs().maxCoeff() * power < kLeastTerm) {
          break;
        }
        force = (-(hk * force)).eval();
      }
      series_.push_back(std::move(series));
    }
  }
  if (order_ == 2) {
    flatten();
  }
}

void PassMatrix::flatten() {
  for (const Series& series : series_) {
    Flat flat{number_.size(), std::vector<double>(series.term.size() + 1)};
    for (const Eigen::MatrixXd& t : series.term) {
      number_.insert(number_.end(), {t(0, 0), t(0, 1), t(1, 0), t(1, 1)});
    }
    double reach = most_z_mm_ * 1.0000001;
    for (std::size_t k = series.term.size(); k-- > 1;) {
      flat.reach_mm[k + 1] = reach;
      const double size = series.term[k].cwiseAbs().maxCoeff();
      reach = std::min(
          reach, size > 0.0 ? std::pow(kLeastTerm / size, 1.0 / static_cast<double>(k)) : reach);
    }
    flat.reach_mm[1] = reach;
    flat_.push_back(std::move(flat));
  }
  series_.clear();
}

Complex PassMatrix::g(Complex xi, double depth_mm) const {
  if (order_ == 2) {
    return g_lanes(Lanes{xi, xi, xi, xi}, depth_mm)[0];
  }
  return g_any(xi, depth_mm * (1.0 - xi));
}

/// One mode: 1 − ξ·tr M + ξ²·det M, and the determinant does not depend on the cut (Liouville).
PassMatrix::Lanes PassMatrix::g_lanes(const Lanes& xi, double depth_mm) const {
  Lanes out;
  if (order_ != 2) {
    for (std::size_t i = 0; i < kLanes; ++i) {
      out[i] = g_any(xi[i], depth_mm * (1.0 - xi[i]));
    }
    return out;
  }
  Matrices m;
  double most = 0.0;
  for (std::size_t i = 0; i < kLanes; ++i) {
    const Complex z = depth_mm * (1.0 - xi[i]);
    m.z_re[i] = z.real();
    m.z_im[i] = z.imag();
    most = std::max(most, std::abs(z));
  }
  for (const Flat& flat : flat_) {
    std::size_t terms = flat.reach_mm.size() - 1;
    while (terms > 1 && most <= flat.reach_mm[terms - 1]) {
      --terms;
    }
    step(&number_[flat.begin], terms, m);
  }
  for (std::size_t i = 0; i < kLanes; ++i) {
    const Complex trace(m.re[0][i] + m.re[3][i], m.im[0][i] + m.im[3][i]);
    out[i] = 1.0 - xi[i] * trace + xi[i] * xi[i] * free_determinant_;
  }
  return out;
}

Complex PassMatrix::g_any(Complex xi, Complex z) const {
  Eigen::MatrixXcd m = Eigen::MatrixXcd::Identity(order_, order_);
  for (const Series& series : series_) {
    Eigen::MatrixXcd p = series.term.back().cast<Complex>();
    for (std::size_t k = series.term.size() - 1; k-- > 0;) {
      p = p * z + series.term[k];
    }
    m = (p * m).eval();
  }
  m *= -xi;
  m.diagonal().array() += 1.0;
  return m.partialPivLu().determinant();
}

}  // namespace steadyrest::chatter::offline
