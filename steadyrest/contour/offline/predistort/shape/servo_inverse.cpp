// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <steadyrest/contour/offline/predistort/shape/servo_inverse.hpp>
#include <steadyrest/math/geometry/vector.hpp>

namespace steadyrest::contour::offline {
namespace {

namespace geometry = math::geometry;
using geometry::Station;
using kernel::signal::Point;

constexpr double kReversal = 0.05;   ///< v₀ of the path speed
constexpr double kRest_mm_s = 0.01;  ///< slower than this a direction is taken at this speed

}  // namespace

ServoInverse::ServoInverse(const ServoModels& models,
                           const std::array<double, 3>& backlash_mm) noexcept {
  for (std::size_t i = 0; i < 3; ++i) {
    const double k = models[i].gain_1_s;
    const double a = models[i].feed_forward;
    first_s_[i] = (1.0 - a) / k;
    second_s2_[i] = models[i].velocity_lag_s / k - a * (1.0 - a) / (k * k);
    half_backlash_mm_[i] = 0.5 * backlash_mm[i];
    lag_s_ = std::max(lag_s_, first_s_[i]);
  }
}

Point ServoInverse::command_mm(const Station& at, double v_mm_s, double a_mm_s2) const noexcept {
  Point out = at.point_mm;
  const double reversal_mm_s = kReversal * std::max(v_mm_s, kRest_mm_s);
  for (std::size_t i = 0; i < 3; ++i) {
    const double velocity = v_mm_s * at.tangent[i];
    const double acceleration = a_mm_s2 * at.tangent[i] + v_mm_s * v_mm_s * at.curvature_1_mm[i];
    out[i] += first_s_[i] * velocity + second_s2_[i] * acceleration +
              half_backlash_mm_[i] * std::tanh(velocity / reversal_mm_s);
  }
  return out;
}

// The change of v̇ is left out.
ServoInverse::Velocity ServoInverse::velocity(const Station& at, double v_mm_s) const noexcept {
  Velocity out;
  const double square = geometry::norm_squared(at.curvature_1_mm);
  const double v2 = v_mm_s * v_mm_s;
  for (std::size_t i = 0; i < 3; ++i) {
    const double t = at.tangent[i];
    const double n = at.curvature_1_mm[i];
    out.a[i] = v_mm_s * t + first_s_[i] * v2 * n - second_s2_[i] * v2 * v_mm_s * square * t;
    out.b[i] = first_s_[i] * t + 3.0 * second_s2_[i] * v_mm_s * n;
  }
  return out;
}

Point ServoInverse::direction(const Station& at, double v_mm_s, double a_mm_s2) const noexcept {
  const Velocity of = velocity(at, std::max(v_mm_s, kRest_mm_s));
  const Point ahead = geometry::add_scaled(of.a, of.b, a_mm_s2);
  return geometry::norm(ahead) > 0.0 ? geometry::unit(ahead) : at.tangent;
}

double ServoInverse::acceleration_mm_s2(const Station& at, double v_mm_s,
                                        double command_mm_s) const noexcept {
  const Velocity of = velocity(at, v_mm_s);
  const double bb = geometry::norm_squared(of.b);
  if (bb <= 0.0) {
    return 0.0;  // the axes do not lag
  }
  const double ab = geometry::dot(of.a, of.b);
  const double rest = geometry::norm_squared(of.a) - command_mm_s * command_mm_s;
  return (-ab + std::sqrt(std::max(0.0, ab * ab - bb * rest))) / bb;
}

}  // namespace steadyrest::contour::offline
