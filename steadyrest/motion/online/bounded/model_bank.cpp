// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <steadyrest/motion/online/bounded/model_bank.hpp>

namespace steadyrest::motion::online {
namespace {

constexpr double kFarOff = 5.0;        ///< standard deviations at which a border no longer matters
constexpr double kNarrow = 0.1;        ///< width of a cell in standard deviations
constexpr double kLeastShare = 1e-10;  ///< below this the model has lost the cell altogether

/// The share of N(mean, s²) in [low, high] and the measurement that would give it the moments of
/// what is inside; r < 0 when nothing is to be learnt.
struct Cut {
  double share = 1.0;
  double z = 0.0;
  double r = -1.0;
};

/// The cell is narrow against s, `middle` and `width` in s: the density is as good as even within,
/// where differences of tails cancel.
/// ∫φ over a width w about m is φ(m)·w·(1 + (m² − 1)·w²/24) to third order. What is left inside is
/// even, its variance w²/12 in units of s².
Cut narrow_cut(double mean, double s, double middle, double width) noexcept {
  const double even = width * width / 12.0;
  const double most = 1.0 - even;
  return {upper_tail(middle).density * width * (1.0 + 0.5 * (middle * middle - 1.0) * even),
          mean + s * middle, s * s * even / most};
}

/// The cell's borders in each model's standard deviations from its mean.
struct Borders {
  Lanes alpha{};
  Lanes beta{};
  Lanes nearest{};  ///< how far inside the mean lies
  Lanes deviation{};
};

Borders borders_of(const ModelBank& bank, const Lanes& variance, double low, double high) noexcept {
  Borders out;
  for (std::size_t j = 0; j < kModels; ++j) {
    out.deviation[j] = std::sqrt(variance[j]);
    const double inverse = 1.0 / out.deviation[j];
    out.alpha[j] = (low - bank.x[j]) * inverse;
    out.beta[j] = (high - bank.x[j]) * inverse;
    out.nearest[j] = std::min(-out.alpha[j], out.beta[j]);
  }
  return out;
}

/// The cuts of all models by the difference of both tails.
struct Cuts {
  Lanes share{};
  Lanes z{};
  Lanes r{};
  Lanes lost{};  ///< share of the variance that is cut away
};

// Moments of a normal distribution cut to [α, β], Z its share inside: mean = (φ(α) − φ(β))/Z,
// variance = 1 − lost, lost = mean² − (α·φ(α) − β·φ(β))/Z. The measurement (z, r) that would bring
// a Kalman filter to the same moments has gain = lost: z = m + s·mean/lost, r = s²·(1 −
// lost)/lost. So the cell enters by the ordinary update, and the UD form stays positive.
Cuts cuts_at(const Borders& at, const Lanes& mean, const Lanes& variance) noexcept {
  constexpr double kFarthest = 30.0;  // beyond it density and tail are nothing
  Lanes share_a{};
  Lanes share_b{};
  Lanes density_a{};
  Lanes density_b{};
  for (std::size_t j = 0; j < kModels; ++j) {
    const Tail beyond_alpha = upper_tail(std::min(kFarthest, std::abs(at.alpha[j])));
    const Tail beyond_beta = upper_tail(std::min(kFarthest, std::abs(at.beta[j])));
    share_a[j] = beyond_alpha.share;
    density_a[j] = beyond_alpha.density;
    share_b[j] = beyond_beta.share;
    density_b[j] = beyond_beta.density;
  }
  Cuts out;
  for (std::size_t j = 0; j < kModels; ++j) {
    // Outside, both tails are counted from the nearer side: nothing cancels.
    const double within = 1.0 - share_a[j] - share_b[j];
    const double outside = std::abs(share_a[j] - share_b[j]);
    out.share[j] = std::min(-at.alpha[j], at.beta[j]) >= 0.0 ? within : outside;
    const double inverse = 1.0 / std::max(out.share[j], kLeastShare);
    const double shift = (density_a[j] - density_b[j]) * inverse;
    out.lost[j] =
        shift * shift - (at.alpha[j] * density_a[j] - at.beta[j] * density_b[j]) * inverse;
    // Bounded at both ends: lost → 0 is no information, lost → 1 would be an exact measurement.
    const double gain = 1.0 / std::min(1.0 - 1e-6, std::max(out.lost[j], 1e-9));
    out.z[j] = mean[j] + at.deviation[j] * shift * gain;
    out.r[j] = variance[j] * std::max(1e-6, 1.0 - out.lost[j]) * gain;
  }
  return out;
}

}  // namespace

// P₁₁ of U·D·Uᵀ.
Lanes ModelBank::position_variance() const noexcept {
  Lanes out{};
  for (std::size_t j = 0; j < kModels; ++j) {
    out[j] = d1[j] + u12[j] * u12[j] * d2[j] + u13[j] * u13[j] * d3[j];
  }
  return out;
}

// Thornton's time update, written out for three states. Φ·U·D·Uᵀ·Φᵀ + Q has six columns (three of
// the state, three of the noise, itself factored as U·D·Uᵀ); Gram–Schmidt with weights D makes
// three of them, from the last row up. Q's factors: d = S·{dt⁵/720, dt³/12, dt}, u₁₂ = u₂₃ = dt/2,
// u₁₃ = dt²/6.
void ModelBank::predict(double to_s, const Lanes& jerk_density, const Lanes& decay_1_s) noexcept {
  const Lanes density = jerk_density;  // copies cannot overlap with the bank
  const Lanes decay = decay_1_s;
  const double dt = to_s - t_s;
  if (!(dt > 0.0)) {
    return;
  }
  t_s = to_s;
  const double half = 0.5 * dt * dt;
  const double k12 = 0.5 * dt;  // U of the noise: Q = S·[dt⁵/20 dt⁴/8 dt³/6; · dt³/3 dt²/2; · · dt]
  const double k13 = dt * dt / 6.0;
  const double k23 = k12;
  const double g2 = dt * dt * dt / 12.0;
  const double g1 = g2 * dt * dt / 60.0;
  for (std::size_t j = 0; j < kModels; ++j) {
    x[j] += dt * (v[j] + 0.5 * dt * a[j]);
    v[j] += dt * a[j];
    const double q3 = density[j] * dt;
    const double q2 = density[j] * g2;
    const double q1 = density[j] * g1;
    // Rows of Φ·U beside those of the noise, made orthogonal from the last one up.
    const double a2 = u12[j] + dt;
    const double a3 = u13[j] + dt * u23[j] + half;
    const double b3 = u23[j] + dt;
    const double n3 = d3[j] + q3;
    const double inverse3 = 1.0 / n3;
    const double m23 = (b3 * d3[j] + k23 * q3) * inverse3;
    const double m13 = (a3 * d3[j] + k13 * q3) * inverse3;
    const double r2 = b3 - m23;
    const double r2q = k23 - m23;
    const double r1 = a3 - m13;
    const double r1q = k13 - m13;
    const double n2 = d2[j] + q2 + r2 * r2 * d3[j] + r2q * r2q * q3;
    const double m12 = (a2 * d2[j] + k12 * q2 + r1 * r2 * d3[j] + r1q * r2q * q3) / n2;
    const double s2 = a2 - m12;
    const double s2q = k12 - m12;
    const double s1 = r1 - m12 * r2;
    const double s1q = r1q - m12 * r2q;
    d1[j] += q1 + s2 * s2 * d2[j] + s2q * s2q * q2 + s1 * s1 * d3[j] + s1q * s1q * q3;
    // a decays by e^−δ·dt after the step. 1 + z + z²/2 for e^z: never negative, and no call of
    // exp. P₃₃ shrinks by keep², P₁₃ and P₂₃ by keep, which in U is a factor 1/keep.
    const double z = decay[j] * dt;
    const double back = 1.0 + z * (1.0 + 0.5 * z);
    const double keep = 1.0 / back;
    a[j] *= keep;
    d2[j] = n2;
    d3[j] = n3 * keep * keep;
    u12[j] = m12;
    u13[j] = m13 * back;
    u23[j] = m23 * back;
  }
}

// Bierman's update for the measurement h = (1, 0, 0): f = Uᵀh is the first row of U, v = D·f, and
// the innovation's variance e grows term by term. All divisors are sums of positive numbers:
// nothing can lose the sign of D.
void ModelBank::update(const Lanes& z, const Lanes& r) noexcept {
  const Lanes seen = z;  // copies cannot overlap with the bank
  const Lanes noise = r;
  for (std::size_t j = 0; j < kModels; ++j) {
    const double f2 = u12[j];
    const double f3 = u13[j];
    const double v1 = d1[j];
    const double v2 = d2[j] * f2;
    const double v3 = d3[j] * f3;
    const double e1 = noise[j] + v1;
    const double e2 = e1 + f2 * v2;
    const double e3 = e2 + f3 * v3;
    const double i1 = 1.0 / e1;
    const double i2 = 1.0 / e2;
    const double i3 = 1.0 / e3;
    d1[j] *= noise[j] * i1;
    d2[j] *= e1 * i2;
    d3[j] *= e2 * i3;
    const double l2 = -f2 * i1;
    const double l3 = -f3 * i2;
    const double k1 = v1 + v2 * f2;  // gains of the first two, before the third
    const double old23 = u23[j];
    u12[j] = f2 + v1 * l2;
    u13[j] = f3 + k1 * l3;
    u23[j] = old23 + v2 * l3;
    const double y = (seen[j] - x[j]) * i3;
    x[j] += (k1 + v3 * f3) * y;
    v[j] += (v2 + v3 * old23) * y;
    a[j] += v3 * y;
  }
}

// D alone: the correlations in U stay as they are.
void ModelBank::inflate(const Lanes& factor) noexcept {
  const Lanes by = factor;  // a copy cannot overlap with the bank
  for (std::size_t j = 0; j < kModels; ++j) {
    d1[j] *= by[j];
    d2[j] *= by[j];
    d3[j] *= by[j];
  }
}

Moments ModelBank::moments(std::size_t j) const noexcept {
  Moments out;
  out.mean = {x[j], v[j], a[j]};
  out.covariance = {d1[j] + u12[j] * u12[j] * d2[j] + u13[j] * u13[j] * d3[j],
                    u12[j] * d2[j] + u13[j] * u23[j] * d3[j],
                    u13[j] * d3[j],
                    d2[j] + u23[j] * u23[j] * d3[j],
                    u23[j] * d3[j],
                    d3[j]};
  return out;
}

// Back to factors from the last row up, each pivot floored: a mixture's covariance can come out
// singular by rounding, and a zero pivot would never recover.
void ModelBank::set(std::size_t j, const Moments& m) noexcept {
  const auto& p = m.covariance;
  x[j] = m.mean[0];
  v[j] = m.mean[1];
  a[j] = m.mean[2];
  d3[j] = std::max(p[5], 1e-9);
  u23[j] = p[4] / d3[j];
  u13[j] = p[2] / d3[j];
  d2[j] = std::max(p[3] - u23[j] * u23[j] * d3[j], 1e-12);
  u12[j] = (p[1] - u13[j] * u23[j] * d3[j]) / d2[j];
  d1[j] = std::max(p[0] - u12[j] * u12[j] * d2[j] - u13[j] * u13[j] * d3[j], 1e-16);
}

CellSight see_cell(const ModelBank& bank, double low, double high) noexcept {
  CellSight out;
  out.variance = bank.position_variance();
  const Borders at = borders_of(bank, out.variance, low, high);
  const Lanes& near = at.nearest;
  // The common case when the axis moves: every model lies far inside its cell, and no tail is
  // worked out.
  if (std::min(std::min(near[0], near[1]), std::min(near[2], near[3])) > kFarOff) {
    return out;
  }
  const Cuts cuts = cuts_at(at, bank.x, out.variance);
  for (std::size_t j = 0; j < kModels; ++j) {
    Cut c{cuts.share[j], cuts.z[j], cuts.r[j]};
    const double width = at.beta[j] - at.alpha[j];
    const double middle = 0.5 * (at.alpha[j] + at.beta[j]);
    if (at.nearest[j] > kFarOff) {
      c = {};
    } else if (width < kNarrow && std::abs(middle) < kFarOff) {
      c = narrow_cut(bank.x[j], at.deviation[j], middle, width);
    } else if (cuts.share[j] < kLeastShare) {
      // The cell lies where this model has nothing. Its nearer border becomes the measurement,
      // tight against both model and cell, so that the model comes back instead of dividing 0 by
      // 0.
      const double cell = high - low;
      c = {kLeastShare, at.alpha[j] > 0.0 ? low : high,
           std::min(0.01 * out.variance[j], 0.01 * cell * cell)};
    } else if (cuts.lost[j] <= 1e-9) {
      c.r = -1.0;
    }
    const bool says = c.r >= 0.0;
    out.share[j] = c.share;
    out.any = out.any || says;
    out.z[j] = says ? c.z : bank.x[j];
    out.r[j] = says ? std::max(c.r, 1e-16) : 1e30;  // 1e30: no information
  }
  return out;
}

Lanes truncate(ModelBank& bank, double low, double high) noexcept {
  const CellSight seen = see_cell(bank, low, high);
  if (seen.any) {
    bank.update(seen.z, seen.r);
  }
  return seen.share;
}

}  // namespace steadyrest::motion::online
