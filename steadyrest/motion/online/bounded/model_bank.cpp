// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <steadyrest/motion/online/bounded/model_bank.hpp>

namespace steadyrest::motion::online {

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
// the innovation's variance e grows term by term. All divisors are sums of positive numbers: D
// cannot change sign.
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

// Only D: the correlations in U stay unchanged.
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

// Factors again from the last row up, each pivot floored: rounding can make a mixture's covariance
// singular, and a zero pivot would never recover.
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

}  // namespace steadyrest::motion::online
