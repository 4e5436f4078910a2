// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/sim/base/portable.hpp>

namespace steadyrest::sim {

/// Below this an axis with dry friction is at standstill: a drive that pushes with exactly the
/// friction force must not creep by rounding.
inline constexpr double kStandstillMmS = 1e-9;

/// Stribeck friction of one axis over steps of a fixed length.
///
/// Dry part at speed |v|, mm/s²: F(v) = coulomb + (breakaway − coulomb)·exp(−(v/v_s)²); F(0) is the
/// breakaway value. A breakaway below the Coulomb value counts as equal to it. (Armstrong-Hélouvry,
/// Dupont, Canudas de Wit, Automatica 30(7), 1994, survey, Gaussian form.)
///
/// Step of length h under the drive's acceleration u: solves
///   v' = v + h·(u − F(|v|)·Sgn(v') − viscous·v')   with the set-valued Sgn(0) = [−1, 1]:
///   w = v + h·u;  |w| ≤ h·F → v' = 0 (stick);  else v' = sgn(w)·(|w| − h·F)/(1 + h·viscous).
/// Implicit in the sign, so a stuck axis stays at exactly 0 and cannot chatter between the two
/// signs, whatever h; first order in h.
class Friction {
 public:
  Friction(const kernel::machine::Friction& law, double h_s) noexcept
      : h_s_(h_s),
        coulomb_mm_s2_(law.coulomb_au_s2),
        rise_mm_s2_(std::max(0.0, law.breakaway_au_s2 - law.coulomb_au_s2)),
        stribeck_s_mm_(1.0 / law.stribeck_au_s),
        viscous_share_(1.0 / (1.0 + h_s * law.viscous_1_s)),
        present_(dry() || law.viscous_1_s > 0.0) {}

  [[nodiscard]] bool dry() const noexcept { return coulomb_mm_s2_ > 0.0 || rise_mm_s2_ > 0.0; }
  [[nodiscard]] bool present() const noexcept { return present_; }

  /// F(|v|).
  [[nodiscard]] double dry_mm_s2(double velocity_mm_s) const noexcept {
    const double u = velocity_mm_s * stribeck_s_mm_;
    const double u2 = u * u;
    return rise_mm_s2_ > 0.0 && u2 < 36.0 ? coulomb_mm_s2_ + rise_mm_s2_ * portable::exp(-u2)
                                          : coulomb_mm_s2_;
  }

  /// Velocity after one step.
  [[nodiscard]] double step(double velocity_mm_s, double drive_mm_s2) const noexcept {
    const double free_mm_s = velocity_mm_s + h_s_ * drive_mm_s2;
    const double grip_mm_s = h_s_ * dry_mm_s2(velocity_mm_s);
    const double excess_mm_s = std::abs(free_mm_s) - grip_mm_s;
    if (grip_mm_s > 0.0 && excess_mm_s <= kStandstillMmS) {
      return 0.0;
    }
    return std::copysign(excess_mm_s * viscous_share_, free_mm_s);
  }

 private:
  double h_s_;
  double coulomb_mm_s2_;
  double rise_mm_s2_;
  double stribeck_s_mm_;
  double viscous_share_;
  bool present_;
};

}  // namespace steadyrest::sim
