// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <steadyrest/chatter/offline/cycle/pass_disc.hpp>

// Taylor coefficients by Cauchy's integral: on the rim u = e^{iφ}, f_k is the mean of f·e^{−ikφ},
// and the trapezium rule on a circle converges exponentially. g is then one short polynomial
// instead of a product of matrices. A disc that does not pay is not built; the caller falls back on
// PassMatrix.
namespace steadyrest::chatter::offline {
namespace {

using Complex = PassMatrix::Complex;
using Lanes = PassMatrix::Lanes;

constexpr std::size_t kLanes = PassMatrix::kLanes;
constexpr std::size_t kStep = 2 * kLanes;  ///< of the term count: each rim point gives two
constexpr std::size_t kMostRimTerms = 64;
constexpr std::size_t kTail = 3;         ///< terms that must have died away
constexpr double kLeastRimTerm = 1e-13;  ///< over 1, or over the rim's largest by …
constexpr double kRimRounding = 3e-16;   ///< … this
constexpr double kMostOnRim = 3e4;       ///< beyond this, its rounding shows within

/// Four points in one register; four registers hide the latency of the arithmetic units.
using Wide = double __attribute__((vector_size(kLanes * sizeof(double))));
constexpr std::size_t kBlock = 4;
struct Points {
  std::array<Wide, kBlock> re{};
  std::array<Wide, kBlock> im{};
};

/// Σ f_k·u^k with real f_k, as in pass_matrix.cpp.
template <std::size_t Count>
[[gnu::always_inline]] inline void series_lanes(const double* f, std::size_t terms, const Points& u,
                                                Points& out) {
  std::array<Wide, Count> r{};
  std::array<Wide, Count> s{};
  std::array<Wide, Count> b1{};
  std::array<Wide, Count> b2{};
  for (std::size_t i = 0; i < Count; ++i) {
    r[i] = u.re[i] + u.re[i];
    s[i] = u.re[i] * u.re[i] + u.im[i] * u.im[i];
  }
  for (std::size_t k = terms - 1; k > 0; --k) {
    for (std::size_t i = 0; i < Count; ++i) {
      const Wide b = (f[k] - s[i] * b2[i]) + r[i] * b1[i];
      b2[i] = b1[i];
      b1[i] = b;
    }
  }
  for (std::size_t i = 0; i < Count; ++i) {
    out.re[i] = f[0] + u.re[i] * b1[i] - s[i] * b2[i];
    out.im[i] = u.im[i] * b1[i];
  }
}

#if defined(__x86_64__)
template <std::size_t Count>
__attribute__((target("avx2"))) void series_avx2(const double* f, std::size_t terms,
                                                 const Points& u, Points& out) {
  series_lanes<Count>(f, terms, u, out);
}
#endif

template <std::size_t Count>
void series(const double* f, std::size_t terms, const Points& u, Points& out) {
#if defined(__x86_64__)
  static const bool kWide = __builtin_cpu_supports("avx2") != 0;
  if (kWide) {
    series_avx2<Count>(f, terms, u, out);
    return;
  }
#endif
  series_lanes<Count>(f, terms, u, out);
}

}  // namespace

bool PassDisc::holds(double depth_mm, double reach_mm) const noexcept {
  return std::abs(depth_mm - center_mm_) + reach_mm <= radius_mm_;
}

std::optional<PassDisc> PassDisc::make(const PassMatrix& pass, double center_mm, double radius_mm,
                                       std::size_t terms) {
  PassDisc out(pass, center_mm, radius_mm);
  // Grows by half each time: a low guess costs little, and growing faster would overshoot where a
  // few more would do.
  for (std::size_t n = (terms / kStep + 1) * kStep; n <= kMostRimTerms;
       n += std::max(n / 2, kStep) / kStep * kStep) {
    if (out.sample(n)) {
      return out;
    }
    if (out.terms_ == 0) {
      return std::nullopt;
    }
  }
  return std::nullopt;
}

/// The values of all functions at `terms`/2 points of the upper half of the rim.
PassDisc::Rim PassDisc::rim(std::size_t terms) const {
  const std::size_t functions = pass_->functions();
  const std::size_t points = terms / 2;
  Rim out{.points = points,
          .value = std::vector<Complex>(functions * points),
          .back = std::vector<Complex>(points)};
  std::vector<Lanes> lanes(functions);
  for (std::size_t j = 0; j < points; j += kLanes) {
    Lanes z;
    for (std::size_t i = 0; i < kLanes; ++i) {
      // Angles at half steps come in conjugate pairs, and none lies on the real axis: f(z̄) = f̄(z)
      // gives the lower half for free.
      const double angle =
          2.0 * std::numbers::pi * (static_cast<double>(j + i) + 0.5) / static_cast<double>(terms);
      out.back[j + i] = std::polar(1.0, -angle);
      z[i] = center_mm_ + radius_mm_ * std::conj(out.back[j + i]);
    }
    pass_->values(z, lanes.data());
    for (std::size_t f = 0; f < functions; ++f) {
      for (std::size_t i = 0; i < kLanes; ++i) {
        out.value[f * points + j + i] = lanes[f][i];
        out.largest = std::max(out.largest, std::norm(lanes[f][i]));
      }
    }
  }
  out.largest = std::sqrt(out.largest);
  return out;
}

/// The coefficients by the mean over the rim, f_k = Σ value·e^(−ikφ); consumes the rim.
void PassDisc::transform(Rim& rim, std::size_t terms) {
  const std::size_t functions = pass_->functions();
  const std::size_t points = rim.points;
  terms_ = terms;
  number_.assign(functions * terms, 0.0);
  const Complex* const back = rim.back.data();
  for (std::size_t f = 0; f < functions; ++f) {
    Complex* const v = &rim.value[f * points];
    // The real part counts for both points of a pair. Each pass over the rim rotates the values by
    // e^{−iφ}, so no sine is computed here.
    for (std::size_t k = 0; k < terms; ++k) {
      double sum = 0.0;
      for (std::size_t j = 0; j < points; ++j) {
        sum += v[j].real();
        v[j] = {v[j].real() * back[j].real() - v[j].imag() * back[j].imag(),
                v[j].real() * back[j].imag() + v[j].imag() * back[j].real()};
      }
      number_[f * terms + k] = sum / static_cast<double>(points);
    }
  }
}

/// Drops negligible terms at the end; false: they have not died away.
bool PassDisc::cut_tail(double least) {
  const std::size_t functions = pass_->functions();
  const std::size_t terms = terms_;
  const auto size = [&](std::size_t k) {
    double most = 0.0;
    for (std::size_t f = 0; f < functions; ++f) {
      most = std::max(most, std::abs(number_[f * terms + k]));
    }
    return most;
  };
  std::size_t needed = terms;
  while (needed > 1 && size(needed - 1) < least) {
    --needed;
  }
  // Aliasing folds the coefficients beyond `terms` back onto the first ones. Several small ones in
  // a row show that nothing is left to fold.
  if (needed + kTail > terms) {
    return false;
  }
  for (std::size_t f = 1; f < functions; ++f) {
    std::copy_n(&number_[f * terms], needed, &number_[f * needed]);
  }
  terms_ = needed;
  number_.resize(functions * needed);
  return true;
}

/// Coefficients carry the rim's rounding, 3e-16 of its largest value, throughout the disc; beyond
/// kMostOnRim that exceeds 1e-11, and g is needed near its zeros. False: more terms are needed;
/// then `terms_` is 0 where no number of them will do.
bool PassDisc::sample(std::size_t terms) {
  Rim on_rim = rim(terms);
  if (!(on_rim.largest < kMostOnRim)) {
    terms_ = 0;
    return false;
  }
  transform(on_rim, terms);
  return cut_tail(std::max(kLeastRimTerm, kRimRounding * on_rim.largest));
}

void PassDisc::g(std::span<const Complex> xi, double depth_mm, std::span<Complex> out) const {
  const std::size_t functions = pass_->functions();
  std::array<Lanes, kBlock> trace;
  std::vector<Lanes> entries(functions > 1 ? functions * kBlock : 0);
  Lanes* const value = functions > 1 ? entries.data() : trace.data();
  for (std::size_t from = 0; from < xi.size(); from += kBlock * kLanes) {
    const std::size_t count = std::min(kBlock, (xi.size() - from) / kLanes);
    Points u;
    for (std::size_t b = 0; b < count; ++b) {
      for (std::size_t i = 0; i < kLanes; ++i) {
        const Complex& x = xi[from + b * kLanes + i];
        u.re[b][i] = (depth_mm * (1.0 - x.real()) - center_mm_) / radius_mm_;
        u.im[b][i] = -depth_mm * x.imag() / radius_mm_;
      }
    }
    for (std::size_t f = 0; f < functions; ++f) {
      Points sum;
      if (count == 1) {
        series<1>(&number_[f * terms_], terms_, u, sum);
      } else {
        series<kBlock>(&number_[f * terms_], terms_, u, sum);
      }
      for (std::size_t b = 0; b < count; ++b) {
        for (std::size_t i = 0; i < kLanes; ++i) {
          value[b * functions + f][i] = {sum.re[b][i], sum.im[b][i]};
        }
      }
    }
    for (std::size_t b = 0; b < count; ++b) {
      Lanes lanes;
      std::copy_n(&xi[from + b * kLanes], kLanes, lanes.begin());
      std::ranges::copy(pass_->g_of(lanes, &value[b * functions]), &out[from + b * kLanes]);
    }
  }
}

}  // namespace steadyrest::chatter::offline
