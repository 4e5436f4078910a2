// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <steadyrest/kernel/units/constants.hpp>
#include <steadyrest/sim/base/portable.hpp>
#include <steadyrest/sim/base/range.hpp>
#include <steadyrest/sim/cut/cutting_edges.hpp>

// All that depends only on angle and geometry, as tables over one turn. Each tooth and each slice
// of its helix is an edge with a shift in cells; edges whose shifts differ by whole cells share a
// table.
namespace steadyrest::sim {
namespace {

using kernel::units::kTurn;

// A helical edge is cut into slices that lag by at most this angle.
constexpr double kSliceLag_rad = 0.05;
constexpr std::size_t kMostSlices = 64;
constexpr double kSameCell = 1e-9;
constexpr double kMargin = 3.0;  ///< cells next to the cut that the cubic may read

/// ∫ of the hat function of half-width 1 up to u.
double hat(double u) {
  const double v = std::clamp(u, -1.0, 1.0);
  return v < 0.0 ? 0.5 * (1.0 + v) * (1.0 + v) : 1.0 - 0.5 * (1.0 - v) * (1.0 - v);
}

EdgeCell turning_cell(const Cutting& cut) {
  return {.normal = {1.0, 0.0},
          .cutting = {cut.radial_n_mm2, cut.tangential_n_mm2},
          .rubbing = {cut.edge_radial_n_mm, cut.edge_tangential_n_mm},
          .tangent = {0.0, 1.0},
          .weight = 1.0,
          .near = true,
          .wall = true};
}

// Angle from Y (the normal of the feed) towards X: normal (sin, cos) points outwards, tangent
// (cos, −sin) along the cutting speed.
EdgeCell milling_cell(const Cutting& cut, double angle, double step) {
  const double s = portable::sin_turn(angle / kTurn);
  const double c = portable::sin_turn(angle / kTurn + 0.25);
  EdgeCell cell;
  cell.normal = {s, c};
  cell.tangent = {c, -s};
  for (std::size_t i = 0; i < 2; ++i) {
    cell.cutting[i] = cut.tangential_n_mm2 * cell.tangent[i] + cut.radial_n_mm2 * cell.normal[i];
    cell.rubbing[i] =
        cut.edge_tangential_n_mm * cell.tangent[i] + cut.edge_radial_n_mm * cell.normal[i];
  }
  // An edge that enters or leaves between two points is shared between them by the hat function,
  // which preserves zeroth and first moments: second order in the step. The cut may begin at angle
  // 0, hence the second turn.
  for (const double turn : {0.0, -kTurn}) {
    const double from = (cut.entry_rad - angle - turn) / step;
    const double to = (cut.exit_rad - angle - turn) / step;
    cell.weight += hat(to) - hat(from);
    cell.near = cell.near || (from < kMargin && to > -kMargin);
    const double off = (angle + turn - cut.wall_rad) / step;
    cell.wall = cell.wall || (off > -0.5 && off <= 0.5);
  }
  if (cell.weight < 1e-12) {  // rounding at the hat's ends
    cell.weight = 0.0;
  }
  return cell;
}

/// Weights of the cubic through the points −1, 0, 1, 2 at t within [0, 1).
std::array<double, 4> cubic(double t) {
  return {-t * (t - 1.0) * (t - 2.0) / 6.0, (t + 1.0) * (t - 1.0) * (t - 2.0) / 2.0,
          -(t + 1.0) * t * (t - 2.0) / 2.0, (t + 1.0) * t * (t - 1.0) / 6.0};
}

double pitch(const Cutting& cut, std::size_t tooth) {
  return cut.pitch_rad.empty() ? kTurn / static_cast<double>(cut.teeth) : cut.pitch_rad[tooth];
}

/// Finds or makes the table of a fraction of a cell.
std::size_t table_of(CuttingEdges& out, std::vector<double>& fractions, const Cutting& cut,
                     double fraction) {
  const auto found =
      std::ranges::find_if(fractions, [&](double f) { return std::abs(f - fraction) < kSameCell; });
  const auto index = static_cast<std::size_t>(found - fractions.begin());
  if (found == fractions.end()) {
    fractions.push_back(fraction);
    auto& cells = out.tables.emplace_back();
    for (std::size_t k = 0; k < out.steps; ++k) {
      const double angle = (static_cast<double>(k) + fraction) * out.step_rad;
      cells.push_back(cut.turning ? turning_cell(cut) : milling_cell(cut, angle, out.step_rad));
    }
  }
  return index;
}

}  // namespace

CuttingEdges CuttingEdges::make(const Cutting& cut, std::size_t least_steps) {
  CuttingEdges out;
  // A whole number of steps per tooth: with even pitch the next tooth meets the surface at a grid
  // point.
  out.steps = (least_steps + cut.teeth - 1) / cut.teeth * cut.teeth;
  out.step_rad = kTurn / static_cast<double>(out.steps);
  const double helix = cut.turning ? 0.0 : cut.helix_rad;
  // The angle by which the helix lags over the depth: 2·b·tan β/D.
  const double lag = 2.0 * cut.depth_mm * std::tan(helix) / cut.diameter_mm;
  out.slices = std::clamp(static_cast<std::size_t>(std::ceil(lag / kSliceLag_rad)), std::size_t{1},
                          kMostSlices);
  out.slice_mm = cut.depth_mm / static_cast<double>(out.slices);
  std::vector<double> fractions;
  std::vector<double> own;
  for (std::size_t slice = 0; slice < out.slices; ++slice) {
    double offset = lag * (static_cast<double>(slice) + 0.5) / static_cast<double>(out.slices);
    for (std::size_t tooth = 0; tooth < cut.teeth; ++tooth) {
      offset += tooth == 0 ? 0.0 : pitch(cut, tooth);
      const double cells = offset / out.step_rad;
      // Rounded up: the table's fraction then lies in [0, 1), and the cell read is never ahead of
      // the edge.
      const double shift = std::ceil(cells - kSameCell);
      Edge edge;
      edge.shift = static_cast<std::size_t>(shift);
      own.push_back(std::max(0.0, shift - cells));
      edge.table = table_of(out, fractions, cut, own.back());
      edge.runout_mm = cut.runout_mm.empty() ? 0.0 : cut.runout_mm[tooth];
      edge.tip = slice == 0;
      edge.trace = out.edges.size() * out.steps;
      out.edges.push_back(edge);
    }
  }
  for (std::size_t e = 0; e < out.edges.size(); ++e) {
    const std::size_t tooth = e % cut.teeth;
    // The tooth in front on the same slice left the surface that this one cuts.
    const std::size_t front = e - tooth + (tooth + cut.teeth - 1) % cut.teeth;
    Edge& edge = out.edges[e];
    edge.front_trace = out.edges[front].trace;
    const double between = own[e] - own[front];
    const double whole = std::floor(between + kSameCell);
    const double t = std::max(0.0, between - whole);
    // With uneven pitch it meets it between points, where the cubic reads it.
    edge.front_exact = t < 2.0 * kSameCell;
    edge.front_weight = cubic(edge.front_exact ? 0.0 : t);
    edge.front_cell = whole < 0.0 ? out.steps - 1 : 0;
  }
  return out;
}

kernel::outcome::Result<void> check(const Cutting& cut) {
  const auto teeth = static_cast<double>(cut.teeth);
  if (cut.modes.empty()) {
    return std::unexpected(refusal("the cut has no vibration mode"));
  }
  for (const CuttingMode& mode : cut.modes) {
    if (auto ok = in_range("mode", {{"frequency_hz", mode.frequency_hz, 1e-3, 1e6},
                                    {"damping_ratio", mode.damping_ratio, 0.0, 0.999},
                                    {"mass_kg", mode.mass_kg, 1e-9, 1e9},
                                    {"shape x", mode.shape[0], -1e3, 1e3},
                                    {"shape y", mode.shape[1], -1e3, 1e3}});
        !ok) {
      return ok;
    }
  }
  for (const double p : cut.pitch_rad) {
    if (auto ok = in_range("tool", {{"pitch_rad", p, 0.01, kTurn}}); !ok) {
      return ok;
    }
  }
  if ((!cut.pitch_rad.empty() && cut.pitch_rad.size() != cut.teeth) ||
      (!cut.runout_mm.empty() && cut.runout_mm.size() != cut.teeth)) {
    return std::unexpected(refusal("pitch and runout need one value per tooth"));
  }
  constexpr double kMost = 1e9;
  return in_range("cut", {{"teeth", teeth, 1.0, cut.turning ? 1.0 : 100.0},
                          {"diameter_mm", cut.diameter_mm, 1e-3, 1e5},
                          {"helix_rad", cut.helix_rad, 0.0, 1.4},
                          {"entry_rad", cut.entry_rad, 0.0, kTurn},
                          {"exit_rad", cut.exit_rad, cut.entry_rad, kTurn},
                          {"depth_mm", cut.depth_mm, 0.0, 1e4},
                          {"tangential_n_mm2", cut.tangential_n_mm2, 0.0, kMost},
                          {"radial_n_mm2", cut.radial_n_mm2, -kMost, kMost},
                          {"edge_tangential_n_mm", cut.edge_tangential_n_mm, 0.0, kMost},
                          {"edge_radial_n_mm", cut.edge_radial_n_mm, -kMost, kMost},
                          {"process_damping_n_mm", cut.process_damping_n_mm, 0.0, kMost}});
}

}  // namespace steadyrest::sim
