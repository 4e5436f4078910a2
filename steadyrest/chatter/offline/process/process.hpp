// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

/// One cut: what vibrates, the tool, and the width of cut. Internal units: mm, s, N, kg, rad.
namespace steadyrest::chatter::offline {

enum class Operation : std::uint8_t { milling, turning };
enum class Direction : std::uint8_t { up, down };

/// One mode of the tool or of the workpiece: q̈ + 2ζω·q̇ + ω²·q = 1000/m · (shape·F), and the
/// displacement between tool and workpiece is Σ shape·q.
struct Mode {
  std::array<double, 2> shape{1.0, 0.0};  ///< x, y; a mode along one axis has a unit vector
  double frequency_hz = 0.0;              ///< natural frequency, undamped, > 0
  double damping_ratio = 0.0;             ///< ζ, 0 … 1, without 1
  double mass_kg = 1.0;                   ///< modal mass, > 0
};

struct Tool {
  std::size_t teeth = 1;          ///< ≥ 1; 1 for turning
  double diameter_mm = 10.0;      ///< needed for helix and process damping
  double helix_rad = 0.0;         ///< 0 … 1.4; its lag at height z is 2·z·tan(helix)/diameter
  std::vector<double> pitch_rad;  ///< empty: even; else the angle from each tooth to the one in
                                  ///< front of it, sum 2π
  std::vector<double> runout_mm;  ///< radius of each tooth over the mean; empty: none
};

/// Forces on a tooth at the angle φ from the y axis, chip thickness h = Δx·sin φ + Δy·cos φ:
/// Ft = Kt·a·h, Fr = Kr·a·h, Fx = −Ft·cos φ − Fr·sin φ, Fy = Ft·sin φ − Fr·cos φ (Altintas, Budak
/// 1995). Turning: the chip thickness is measured along x, Fx = −Kr·a·Δx, Fy = −Kt·a·Δx.
struct Cut {
  Operation operation = Operation::milling;
  Direction direction = Direction::up;
  double radial_immersion = 1.0;      ///< radial depth over diameter, 0 … 1; 1 = slot
  double tangential_n_mm2 = 600.0;    ///< Kt, > 0
  double radial_n_mm2 = 200.0;        ///< Kr
  double edge_tangential_n_mm = 0.0;  ///< Kte; they do not change the stability
  double edge_radial_n_mm = 0.0;      ///< Kre
  double process_damping_n_mm = 0.0;  ///< C of F = −C·(a/v)·ṙ along the chip thickness, v the
                                      ///< cutting speed (Schmitz, Smith, Machining Dynamics)
  double feed_per_tooth_mm = 0.1;     ///< for the simulation
};

struct Process {
  std::string name = "process";
  Tool tool;
  Cut cut;
  std::vector<Mode> modes;

  /// Angles at which a tooth enters and leaves the cut, rad from the y axis; 0 … 2π in turning.
  [[nodiscard]] double entry_rad() const noexcept;
  [[nodiscard]] double exit_rad() const noexcept;
  /// Even pitch (and turning): all teeth see the same delay.
  [[nodiscard]] bool even_pitch() const noexcept;
  /// Angle from tooth j to the one in front of it.
  [[nodiscard]] double pitch_rad(std::size_t tooth) const noexcept;
};

}  // namespace steadyrest::chatter::offline
