// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

/// One vibration mode of tool or workpiece, stepped exactly.
///
/// q̈ + 2ζω·q̇ + ω²·q = g(t), g = 1000/m·(shape·F), linear from g₀ to g₁ over the step. The
/// solution is closed, so no step is too long for the mode, only for the linear force.
namespace steadyrest::sim {

struct CuttingMode {
  std::array<double, 2> shape{1.0, 0.0};  ///< share of x and y
  double frequency_hz = 0.0;              ///< undamped, > 0
  double damping_ratio = 0.0;             ///< ζ, 0 … below 1
  double mass_kg = 1.0;                   ///< modal mass, > 0
};

struct ModalStep {
  /// What q (mm), v (mm/s), g₀ and g₁ (mm/s²) contribute to position or velocity at the end.
  struct Row {
    double q = 0.0;
    double v = 0.0;
    double g0 = 0.0;
    double g1 = 0.0;
  };
  Row position;
  Row velocity;
};

[[nodiscard]] ModalStep modal_step(const CuttingMode& mode, double period_s) noexcept;

}  // namespace steadyrest::sim
