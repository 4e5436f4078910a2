// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <steadyrest/motion/online/bounded/lag_smoother.hpp>

// A look is what the forward filters knew at a tick (LagSmoother::Look). smooth() starts filters at
// the newest look and runs them backwards in time over the edges seen since the requested look.
// There it joins the two estimates model by model, and the models by their weights.
namespace steadyrest::motion::online {
namespace {

/// Joins two independent estimates of the state (x, v, a): `forward`, with its covariance P, and
/// `mirrored` (only its mean is used), whose covariance is in UD form: U·D·Uᵀ, U unit upper
/// triangular with the elements u12, u13, u23, D = diag(variance). The elements of U⁻¹·(x, v, a)
/// are then independent of one another, so the second estimate is three scalar measurements: row k
/// of U⁻¹ gives what is measured, `variance`[k] how well.
std::array<double, 3> join(const Moments& forward, const Moments& mirrored, double u12, double u13,
                           double u23, const std::array<double, 3>& variance) noexcept {
  std::array<double, 3> x = forward.mean;
  const auto& c = forward.covariance;
  std::array<std::array<double, 3>, 3> p{
      {{c[0], c[1], c[2]}, {c[1], c[3], c[4]}, {c[2], c[4], c[5]}}};
  const std::array<std::array<double, 3>, 3> rows{
      {{1.0, -u12, u12 * u23 - u13}, {0.0, 1.0, -u23}, {0.0, 0.0, 1.0}}};
  for (std::size_t k = 0; k < 3; ++k) {
    const auto& h = rows[k];  // of U⁻¹
    std::array<double, 3> ph{};
    double innovation = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) {
        ph[i] += p[i][j] * h[j];
      }
      innovation += h[i] * (mirrored.mean[i] - x[i]);
    }
    const double total = h[0] * ph[0] + h[1] * ph[1] + h[2] * ph[2] + variance[k];
    for (std::size_t i = 0; i < 3; ++i) {
      const double gain = ph[i] / total;
      x[i] += gain * innovation;
      for (std::size_t j = 0; j < 3; ++j) {
        p[i][j] -= gain * ph[j];
      }
    }
  }
  return x;
}

}  // namespace

void LagSmoother::observed(double t_s, const Lanes& z, const Lanes& r) noexcept {
  if (active()) {
    seen_[next_seen_] = {t_s, z, r};
    next_seen_ = (next_seen_ + 1) % kSeen;
    seen_count_ = std::min(seen_count_ + 1, kSeen);
  }
}

void LagSmoother::looked(const Look& look) noexcept {
  looks_[next_look_] = look;
  next_look_ = (next_look_ + 1) % looks_.size();
  look_count_ = std::min(look_count_ + 1, looks_.size());
}

void LagSmoother::forget() noexcept {
  look_count_ = 0;
  seen_count_ = 0;
}

const LagSmoother::Look& LagSmoother::then() const noexcept {
  const std::size_t age = std::min(ticks_, look_count_ - 1);
  return looks_[(next_look_ + looks_.size() - 1 - age) % looks_.size()];
}

LagSmoother::State LagSmoother::smooth(const Lanes& jerk_density, double cycle_s) const noexcept {
  const Look& now = looks_[(next_look_ + looks_.size() - 1) % looks_.size()];
  const Look& past = then();
  ModelBank back;
  // It starts without knowledge: 1 count, 100 counts per cycle, 1 count per cycle².
  const double v = 100.0 / cycle_s;
  const double a = 1.0 / (cycle_s * cycle_s);
  for (std::size_t j = 0; j < kModels; ++j) {
    back.set(j, {{now.bank.x[j], 0.0, 0.0}, {1.0, 0.0, 0.0, v * v, 0.0, a * a}});
  }
  back.t_s = -now.t_s;
  for (std::size_t i = 0; i < seen_count_; ++i) {
    const Seen& seen = seen_[(next_seen_ + kSeen - 1 - i) % kSeen];
    if (seen.t_s <= past.t_s) {
      break;
    }
    back.predict(-seen.t_s, jerk_density, all(0.0));
    back.update(seen.z, seen.r);
  }
  back.predict(-past.t_s, jerk_density, all(0.0));
  State out;
  double sum = 0.0;
  for (std::size_t j = 0; j < kModels; ++j) {
    Moments mirrored = back.moments(j);
    mirrored.mean[1] = -mirrored.mean[1];
    // Mirroring v reverses the signs of u12 and u23; D stays.
    const auto x = join(past.bank.moments(j), mirrored, -back.u12[j], back.u13[j], -back.u23[j],
                        {back.d1[j], back.d2[j], back.d3[j]});
    const double weight = now.weight[j] + past.weight[j];
    sum += weight;
    out.x += weight * x[0];
    out.v += weight * x[1];
    out.a += weight * x[2];
  }
  const double rest = std::min(now.weight_rest, past.weight_rest);
  const double moves = (1.0 - rest) / std::max(sum, 1e-300);
  return {rest * past.rest_x + moves * out.x, moves * out.v, moves * out.a};
}

}  // namespace steadyrest::motion::online
