// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/sim/cut/modal_step.hpp>

/// The simulated machine's cut as plain data, and its edges on a grid of the spindle's angle.
namespace steadyrest::sim {

/// Inner units: mm, s, N, kg, rad. x is the direction of feed; a tooth's angle counts from y.
struct Cutting {
  std::vector<CuttingMode> modes;
  bool turning = false;  ///< chip thickness along x; else milling
  std::size_t teeth = 2;
  double diameter_mm = 10.0;
  double helix_rad = 0.0;
  // Designated initialisers may leave these out.
  // NOLINTNEXTLINE(readability-redundant-member-init)
  std::vector<double> pitch_rad = {};  ///< to the tooth in front, sum 2π; empty: even
  // NOLINTNEXTLINE(readability-redundant-member-init)
  std::vector<double> runout_mm = {};  ///< each tooth's radius over the mean; empty: none
  double entry_rad = 0.0;              ///< milling: within 0 … π
  double exit_rad = 3.141592653589793;
  double wall_rad = 0.0;  ///< angle of the finished wall: 0 (up-milling) or π (down-milling)
  double depth_mm = 1.0;
  double tangential_n_mm2 = 600.0;    ///< Kt
  double radial_n_mm2 = 200.0;        ///< Kr
  double edge_tangential_n_mm = 0.0;  ///< Kte
  double edge_radial_n_mm = 0.0;      ///< Kre
  double process_damping_n_mm = 0.0;  ///< C of C·(a/v)·ṙ, v the cutting speed
};

/// An edge: one tooth at one height. Its angle is φ = (i − shift + fraction)·Δ at step i.
struct Edge {
  std::size_t shift = 0;  ///< cells
  std::size_t table = 0;  ///< index of its table of cells: one per fraction
  double runout_mm = 0.0;
  bool tip = false;                      ///< the lowest slice
  std::size_t trace = 0;                 ///< where its cells of the surface begin
  std::size_t front_trace = 0;           ///< those of the tooth in front at the same height
  std::size_t front_cell = 0;            ///< added to its own cell: the second of four cells …
  std::array<double, 4> front_weight{};  ///< … that give the surface; {0, 1, 0, 0} on even pitch
  bool front_exact = true;
};

/// Effect of an edge in this cell; unit depth.
struct EdgeCell {
  std::array<double, 2> normal{};   ///< chip thickness = normal · displacement
  std::array<double, 2> cutting{};  ///< force = −cutting · chip thickness, N/mm²
  std::array<double, 2> rubbing{};  ///< force = −rubbing, N/mm, while it cuts
  std::array<double, 2> tangent{};  ///< of the cutting speed: torque = −force · tangent · radius
  double weight = 0.0;              ///< share of the step inside the cut, 0 … 1
  bool near = false;                ///< in the cut or within three cells of it
  bool wall = false;                ///< the finished wall is generated here
};

/// Grid: steps of 2π/steps. Forces are straight lines between its points, so an edge that enters
/// between two points is shared between both by the weights of that line: zeroth and first moment
/// are exact and the order stays 2. With uneven pitch an edge's cells lie between those of the
/// tooth in front; a cubic reads the surface there.
struct CuttingEdges {
  std::size_t steps = 0;  ///< per revolution
  double step_rad = 0.0;
  double slice_mm = 0.0;  ///< height of one edge
  std::size_t slices = 1;
  std::vector<Edge> edges;
  std::vector<std::vector<EdgeCell>> tables;  ///< [table][cell]

  /// `least_steps`: rounded up to a multiple of the teeth.
  static CuttingEdges make(const Cutting& cut, std::size_t least_steps);
};

/// Refuses what is not a cut.
[[nodiscard]] kernel::outcome::Result<void> check(const Cutting& cut);

}  // namespace steadyrest::sim
