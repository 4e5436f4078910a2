// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/LU>

#include <steadyrest/chatter/offline/cycle/modal_answers.hpp>
#include <steadyrest/chatter/offline/cycle/pass_matrix.hpp>
#include <steadyrest/chatter/offline/cycle/piece_terms.hpp>
#include <steadyrest/kernel/units/constants.hpp>

// The constructor divides the pass into pieces and stores each as a power series in z; values()
// sums the series and multiplies the pieces at four z at a time; g_of() computes det(I − ξ·M) from
// the product. One speed costs thousands of g, so the lanes and the number of terms decide how long
// a lobe map takes.
namespace steadyrest::chatter::offline {
namespace {

using kernel::units::kTurn;

using Complex = std::complex<double>;
using Eigen::Index;
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// Short pieces need few terms, long pieces few products; the terms fall as phase^(2k)/(2k)!.
constexpr double kPiecePhase = 5.0;  ///< of the fastest oscillation

/// N×N matrices by rows, one in each lane.
using Wide = double __attribute__((vector_size(PassMatrix::kLanes * sizeof(double))));
template <std::size_t N>
struct Matrices {
  Wide z_re{};
  Wide z_im{};
  std::array<Wide, N * N> re{};
  std::array<Wide, N * N> im{};
};

/// Multiplies from the left by Σ term[k]·z^k. Real polynomials at complex points need half of
/// Horner's work: b_k = c_k + 2·Re z·b_{k+1} − |z|²·b_{k+2} (Knuth, TAOCP 2, 4.6.4).
template <std::size_t N>
[[gnu::always_inline]] inline void step_lanes(const double* number, std::size_t terms,
                                              Matrices<N>& m) {
  const Wide r = m.z_re + m.z_re;
  const Wide s = m.z_re * m.z_re + m.z_im * m.z_im;
  std::array<Wide, N * N> b1{};
  std::array<Wide, N * N> b2{};
  for (std::size_t k = terms - 1; k > 0; --k) {
    for (std::size_t i = 0; i < N * N; ++i) {
      const Wide b = number[N * N * k + i] + r * b1[i] - s * b2[i];
      b2[i] = b1[i];
      b1[i] = b;
    }
  }
  for (std::size_t i = 0; i < N * N; ++i) {
    b2[i] = number[i] + m.z_re * b1[i] - s * b2[i];  // now the real part
    b1[i] = m.z_im * b1[i];                          // and the imaginary one
  }
  const auto re = m.re;
  const auto im = m.im;
  for (std::size_t row = 0; row < N; ++row) {
    for (std::size_t col = 0; col < N; ++col) {
      Wide sum_re{};
      Wide sum_im{};
      for (std::size_t k = 0; k < N; ++k) {
        sum_re += b2[N * row + k] * re[N * k + col] - b1[N * row + k] * im[N * k + col];
        sum_im += b2[N * row + k] * im[N * k + col] + b1[N * row + k] * re[N * k + col];
      }
      m.re[N * row + col] = sum_re;
      m.im[N * row + col] = sum_im;
    }
  }
}

#if defined(__x86_64__)
/// The same numbers, the lanes in one register: no product is fused with a sum.
template <std::size_t N>
__attribute__((target("avx2"))) void step_avx2(const double* number, std::size_t terms,
                                               Matrices<N>& m) {
  step_lanes<N>(number, terms, m);
}
#endif

template <std::size_t N>
void step(const double* number, std::size_t terms, Matrices<N>& m) {
#if defined(__x86_64__)
  static const bool kWide = __builtin_cpu_supports("avx2") != 0;
  if (kWide) {
    step_avx2<N>(number, terms, m);
    return;
  }
#endif
  step_lanes<N>(number, terms, m);
}

double largest(const PassMatrix::Lanes& z) {
  double square = 0.0;
  for (const Complex& each : z) {
    square = std::max(square, std::norm(each));
  }
  return std::sqrt(square);
}

std::size_t terms_for(const std::vector<double>& reach_mm, double size_mm) {
  std::size_t terms = reach_mm.size() - 1;
  // Near z = 0 a few terms suffice.
  while (terms > 1 && size_mm <= reach_mm[terms - 1]) {
    --terms;
  }
  return terms;
}

/// The product of all pieces at four z.
template <std::size_t N, typename AllSeries>
Matrices<N> product(const AllSeries& all, const std::vector<double>& number,
                    const PassMatrix::Lanes& z) {
  Matrices<N> m;
  for (std::size_t i = 0; i < z.size(); ++i) {
    m.z_re[i] = z[i].real();
    m.z_im[i] = z[i].imag();
    for (std::size_t row = 0; row < N; ++row) {
      m.re[(N + 1) * row][i] = 1.0;
    }
  }
  // The lane with the largest |z| needs the most terms; the others use as many.
  const double size = largest(z);
  for (const auto& series : all) {
    step<N>(&number[series.begin], terms_for(series.reach_mm, size), m);
  }
  return m;
}

template <std::size_t N>
void entries(const Matrices<N>& m, PassMatrix::Lanes* out) {
  for (std::size_t col = 0; col < N; ++col) {
    for (std::size_t row = 0; row < N; ++row) {
      for (std::size_t i = 0; i < PassMatrix::kLanes; ++i) {
        out[N * col + row][i] = Complex(m.re[N * row + col][i], m.im[N * row + col][i]);
      }
    }
  }
}

}  // namespace

bool PassMatrix::simple(const Process& process) noexcept {
  return process.even_pitch() && process.cut.process_damping_n_mm == 0.0;
}

PassMatrix::PassMatrix(const Process& process, double speed_rev_s, double most_z_mm,
                       double depth_mm)
    : order_(2 * static_cast<Index>(process.modes.size())),
      functions_(order_ == 2 ? 1 : static_cast<std::size_t>(order_ * order_)),
      most_z_mm_(most_z_mm) {
  const CuttingCoefficients coefficients(process, depth_mm);
  const double pass_rad = kTurn / static_cast<double>(process.tool.teeth);
  const double pass_s = pass_rad / (kTurn * speed_rev_s);
  // |z| replaces the depth in the cutting stiffness, so the greatest |z| sets the fastest
  // oscillation.
  const double fastest = fastest_rad_s(process, most_z_mm, speed_rev_s);
  const std::vector<double> corner = corners_of_pass(process, coefficients, pass_rad);
  for (std::size_t i = 0; i + 1 < corner.size(); ++i) {
    const double length = corner[i + 1] - corner[i];
    const double length_s = length / pass_rad * pass_s;
    if (!cuts_at(coefficients, pass_rad, corner[i] + 0.5 * length)) {
      add_free(free_answer(process, length_s));
      continue;
    }
    const double pieces = std::max(1.0, std::ceil(length_s * fastest / kPiecePhase));
    add_cutting(
        {process, coefficients, speed_rev_s, corner[i], length, static_cast<std::size_t>(pieces)});
  }
  for (const Series& series : series_) {
    // Liouville: det M is that of the free vibration for every z, since forces depend only on
    // displacement; term 0 of each piece is its map at z = 0.
    determinant_ *=
        Eigen::Map<const RowMajor>(&number_[series.begin], order_, order_).determinant();
  }
}

void PassMatrix::add_free(const Eigen::MatrixXd& e) {
  // One term, good for every z: nothing is cut here.
  series_.push_back({number_.size(), {0.0, most_z_mm_ * 1.0000001}});
  number_.resize(number_.size() + static_cast<std::size_t>(order_ * order_));
  Eigen::Map<RowMajor>(&number_[series_.back().begin], order_, order_) = e;
}

/// The pieces of one stretch side by side: the modes respond alike in all of them.
void PassMatrix::add_cutting(const Stretch& stretch) {
  const PieceTerms terms(stretch, static_cast<std::size_t>(order_), most_z_mm_);
  for (std::size_t p = 0; p < stretch.pieces; ++p) {
    Series series{number_.size(), std::vector<double>(terms.count() + 1)};
    std::vector<double> size(terms.count());
    for (std::size_t t = 0; t < terms.count(); ++t) {
      for (std::size_t i = 0; i < static_cast<std::size_t>(order_ * order_); ++i) {
        const double number = terms.at(t, p, i);
        number_.push_back(number);
        size[t] = std::max(size[t], std::abs(number));
      }
    }
    // From the last term down: with t terms the largest omitted term is at most kLeastTerm as long
    // as |z|^t·size stays below it.
    double reach = most_z_mm_ * 1.0000001;
    for (std::size_t t = terms.count(); t-- > 1;) {
      series.reach_mm[t + 1] = reach;
      if (size[t] > 0.0) {
        reach = std::min(reach, std::pow(kLeastTerm / size[t], 1.0 / static_cast<double>(t)));
      }
    }
    series.reach_mm[1] = reach;
    series_.push_back(std::move(series));
  }
}

void PassMatrix::values(const Lanes& z, Lanes* out) const {
  switch (order_) {
    case 2: {
      const Matrices<2> m = product<2>(series_, number_, z);
      for (std::size_t i = 0; i < kLanes; ++i) {
        (*out)[i] = Complex(m.re[0][i] + m.re[3][i], m.im[0][i] + m.im[3][i]);
      }
      return;
    }
    // Two and three modes are unrolled too; four and more are rare and go through Eigen.
    case 4:
      entries(product<4>(series_, number_, z), out);
      return;
    case 6:
      entries(product<6>(series_, number_, z), out);
      return;
    default:
      for (std::size_t i = 0; i < kLanes; ++i) {
        const Eigen::MatrixXcd m = matrix(z[i]);
        for (std::size_t f = 0; f < functions_; ++f) {
          out[f][i] = m(static_cast<Index>(f));
        }
      }
  }
}

Eigen::MatrixXcd PassMatrix::matrix(Complex z) const {
  Eigen::MatrixXcd m = Eigen::MatrixXcd::Identity(order_, order_);
  for (const Series& series : series_) {
    const auto term = [&](std::size_t k) {
      return Eigen::Map<const RowMajor>(
          &number_[series.begin + k * static_cast<std::size_t>(order_ * order_)], order_, order_);
    };
    std::size_t k = terms_for(series.reach_mm, std::abs(z)) - 1;
    Eigen::MatrixXcd p = term(k).cast<Complex>();
    while (k-- > 0) {
      p = p * z + term(k);
    }
    m = (p * m).eval();
  }
  return m;
}

PassMatrix::Lanes PassMatrix::g_of(const Lanes& xi, const Lanes* value) const {
  Lanes out;
  if (order_ == 2) {
    for (std::size_t i = 0; i < kLanes; ++i) {
      // det(I − ξ·M) = 1 − ξ·tr M + ξ²·det M for 2×2.
      out[i] = 1.0 - xi[i] * ((*value)[i] - xi[i] * determinant_);
    }
    return out;
  }
  // Up to four modes without a heap allocation.
  constexpr int kMost = 8;
  using Small = Eigen::Matrix<Complex, Eigen::Dynamic, Eigen::Dynamic, 0, kMost, kMost>;
  const auto determinant = [&]<typename Matrix>(Matrix m, std::size_t i) {
    for (std::size_t f = 0; f < functions_; ++f) {
      m(static_cast<Index>(f)) = -xi[i] * value[f][i];
    }
    m.diagonal().array() += 1.0;
    return m.partialPivLu().determinant();
  };
  for (std::size_t i = 0; i < kLanes; ++i) {
    out[i] = order_ <= kMost ? determinant(Small(order_, order_), i)
                             : determinant(Eigen::MatrixXcd(order_, order_), i);
  }
  return out;
}

Complex PassMatrix::g(Complex xi, double depth_mm) const {
  return g_lanes(Lanes{xi, xi, xi, xi}, depth_mm)[0];
}

PassMatrix::Lanes PassMatrix::g_lanes(const Lanes& xi, double depth_mm) const {
  Lanes z;
  for (std::size_t i = 0; i < kLanes; ++i) {
    z[i] = depth_mm * (1.0 - xi[i]);
  }
  if (functions_ == 1) {
    Lanes trace;
    values(z, &trace);
    return g_of(xi, &trace);
  }
  std::vector<Lanes> value(functions_);
  values(z, value.data());
  return g_of(xi, value.data());
}

}  // namespace steadyrest::chatter::offline
