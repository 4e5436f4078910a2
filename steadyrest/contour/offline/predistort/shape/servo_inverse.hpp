// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include <steadyrest/contour/offline/predict/model_run.hpp>
#include <steadyrest/kernel/signal/path.hpp>
#include <steadyrest/math/geometry/segment.hpp>

namespace steadyrest::contour::offline {

/// What the axes must be commanded so that the tool moves on a path: the inverse of the servo.
///
/// Law. Of τ·ẍ + ẋ = k·(c − x) + a·ċ the inverse c/x = (1 + s/k + τs²/k)/(1 + a·s/k) is taken to
/// the second order in s,
///   c = y + g₁·ẏ + g₂·ÿ,   g₁ = (1 − a)/k,   g₂ = τ/k − a·(1 − a)/k²,
/// for the tool at y with ẏ = v·t, ÿ = v̇·t + v²·κ (t tangent, κ curvature vector). Without
/// feed-forward it is exact. Half of the backlash b is added in the direction of travel, by
/// b/2·tanh(ẏ/v₀): v₀ = 5 % of the speed, so that the step at a reversal stays a curve.
class ServoInverse {
 public:
  explicit ServoInverse(const ServoModels& models,
                        const std::array<double, 3>& backlash_mm = {}) noexcept;

  /// How far the tool is behind its command, s: the largest g₁. A tool that moves along at v is at
  /// the command's path length less v times it.
  [[nodiscard]] double lag_s() const noexcept { return lag_s_; }
  /// The command for the tool at this point with this speed and acceleration along the path.
  [[nodiscard]] kernel::signal::Point command_mm(const math::geometry::Station& at, double v_mm_s,
                                                 double a_mm_s2) const noexcept;
  /// The command's direction of travel then, a unit vector.
  [[nodiscard]] kernel::signal::Point direction(const math::geometry::Station& at, double v_mm_s,
                                                double a_mm_s2) const noexcept;
  /// The tool's v̇ while the command moves at `command_mm_s`: |ċ(v, v̇)| = command speed.
  [[nodiscard]] double acceleration_mm_s2(const math::geometry::Station& at, double v_mm_s,
                                          double command_mm_s) const noexcept;

 private:
  /// ċ = A + v̇·B.
  struct Velocity {
    kernel::signal::Point a{};
    kernel::signal::Point b{};
  };
  [[nodiscard]] Velocity velocity(const math::geometry::Station& at, double v_mm_s) const noexcept;

  std::array<double, 3> first_s_{};    ///< g₁
  std::array<double, 3> second_s2_{};  ///< g₂
  std::array<double, 3> half_backlash_mm_{};
  double lag_s_ = 0.0;
};

}  // namespace steadyrest::contour::offline
