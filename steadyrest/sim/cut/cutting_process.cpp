// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include <steadyrest/kernel/units/constants.hpp>
#include <steadyrest/sim/base/range.hpp>
#include <steadyrest/sim/cut/cutting_process.hpp>

// One step: free motion of the modes, the edges near the material, the force consistent with the
// displacement at the step's end (implicit, so the step is second order and stable for stiff cuts),
// then the surface that the edges leave. Which edges cut depends on the displacement, so force and
// contact are found together in a few rounds.
namespace steadyrest::sim {
namespace {

using kernel::units::kTurn;

constexpr double kLeastPerPass = 40.0;  ///< steps from tooth to tooth
constexpr double kLeastPerArc = 12.0;   ///< steps from entry to exit
constexpr double kMostSteps = 1 << 20;
constexpr int kMostSolutions = 3;

double dot(const std::array<double, 2>& a, const std::array<double, 2>& b) noexcept {
  return a[0] * b[0] + a[1] * b[1];
}

/// The highest oscillation frequency at this depth. The cut acts as a spring between tool and part:
/// it stiffens each mode by b·√(Kt² + Kr²), in the worst direction. 1000 turns N/kg into mm/s².
double fastest_hz(const Cutting& cut) {
  const double stiffness = cut.depth_mm * std::hypot(cut.tangential_n_mm2, cut.radial_n_mm2);
  double square = 0.0;
  for (const CuttingMode& mode : cut.modes) {
    const double w = kTurn * mode.frequency_hz;
    square =
        std::max(square, w * w + 1000.0 / mode.mass_kg * dot(mode.shape, mode.shape) * stiffness);
  }
  return std::sqrt(square) / kTurn;
}

// Three demands, the strictest counts: steps per vibration, per tooth pass, per arc of cut.
double steps_for(const CuttingProcess::Config& config) {
  const Cutting& cut = config.cut;
  // Steps are even in angle, so they last longest at the slowest speed and must be fine enough
  // there.
  const double by_modes = config.steps_per_period * fastest_hz(cut) / config.slowest_rev_s;
  const double arc = cut.turning ? kTurn : std::max(cut.exit_rad - cut.entry_rad, 1e-6);
  return std::max(
      {by_modes, kLeastPerPass * static_cast<double>(cut.teeth), kLeastPerArc * kTurn / arc});
}

}  // namespace

kernel::outcome::Result<CuttingProcess> CuttingProcess::make(const Config& config) {
  if (auto ok = check(config.cut); !ok) {
    return std::unexpected(ok.error());
  }
  if (auto ok = in_range("cut", {{"slowest_rev_s", config.slowest_rev_s, 1e-3, 1e5},
                                 {"steps_per_period", config.steps_per_period, 8.0, 1000.0},
                                 {"steps", steps_for(config), 1.0, kMostSteps}});
      !ok) {
    return std::unexpected(ok.error());
  }
  return CuttingProcess(
      config,
      CuttingEdges::make(config.cut, static_cast<std::size_t>(std::ceil(steps_for(config)))));
}

CuttingProcess::CuttingProcess(const Config& config, CuttingEdges edges)
    : cut_(config.cut),
      keeps_contact_(config.keeps_contact),
      edges_(std::move(edges)),
      // A circle of diameter D falls away by s²/D at the distance s along its tangent; in turning
      // the surface is flat along the feed.
      drop_1_mm_(config.cut.turning || config.keeps_contact ? 0.0 : 1.0 / config.cut.diameter_mm),
      modes_(config.cut.modes.size()),
      steps_(config.cut.modes.size()),
      shape_(config.cut.modes.size()),
      surface_(edges_.edges.size() * edges_.steps),
      active_(edges_.edges.size()) {
  std::ranges::transform(cut_.modes, shape_.begin(), &CuttingMode::shape);
}

// Modes belong to the machine, the cut to the feed: the shapes are turned into the feed's frame.
void CuttingProcess::turn_to(const std::array<double, 2>& direction) noexcept {
  if (direction == direction_) {
    return;
  }
  direction_ = direction;
  const auto [c, s] = direction;
  for (std::size_t m = 0; m < shape_.size(); ++m) {
    const std::array<double, 2>& shape = cut_.modes[m].shape;
    shape_[m] = {c * shape[0] + s * shape[1], c * shape[1] - s * shape[0]};
  }
  period_s_ = 0.0;  // forces everything that depends on the shapes to be rebuilt
}

double CuttingProcess::angle_rad() const noexcept {
  return kTurn * static_cast<double>(turns_) + static_cast<double>(cell_) * edges_.step_rad;
}

// Runs only when the speed changes; at constant speed a step is a handful of products.
void CuttingProcess::set_period(double period_s) noexcept {
  if (period_s == period_s_) {
    return;
  }
  period_s_ = period_s;
  answer_ = {};
  answer_rate_ = {};
  for (std::size_t m = 0; m < steps_.size(); ++m) {
    const CuttingMode& mode = cut_.modes[m];
    steps_[m] = modal_step(mode, period_s);
    for (std::size_t i = 0; i < 2; ++i) {
      for (std::size_t k = 0; k < 2; ++k) {
        const double both = 1000.0 / mode.mass_kg * shape_[m][i] * shape_[m][k];
        // X from a force at the step's end: the force is linear within the step, and only its end
        // is unknown.
        answer_[i][k] += both * steps_[m].position.g1;
        answer_rate_[i][k] += both * steps_[m].velocity.g1;
      }
    }
  }
}

/// As if the tool had come here at this feed without vibration.
void CuttingProcess::lay_surface(double feed_per_tooth_mm) noexcept {
  const double feed_1_rad = feed_per_tooth_mm * static_cast<double>(cut_.teeth) / kTurn;
  for (const Edge& edge : edges_.edges) {
    const std::vector<EdgeCell>& cells = edges_.tables[edge.table];
    for (std::size_t back = 0; back < edges_.steps; ++back) {
      const std::size_t step = (cell_ + 2 * edges_.steps - back) % edges_.steps;
      const std::size_t cell =
          (step + 1000 * edges_.steps - edge.shift % edges_.steps) % edges_.steps;
      // Backwards in angle, the feed that the tool had when it was there.
      const double feed = feed_mm_ - feed_1_rad * edges_.step_rad * static_cast<double>(back);
      surface_[edge.trace + cell] = {feed * cells[cell].normal[0] + edge.runout_mm, feed};
    }
  }
}

CuttingProcess::Surface CuttingProcess::surface(const Edge& edge, std::size_t cell) const noexcept {
  std::size_t at = cell + edge.front_cell;
  at -= at >= edges_.steps ? edges_.steps : 0;
  const Surface* const trace = surface_.data() + edge.front_trace;
  if (edge.front_exact) {
    return trace[at];
  }
  Surface out;
  at = at == 0 ? edges_.steps - 1 : at - 1;
  // The tooth in front passed between two cells: interpolate over the neighbours.
  for (const double weight : edge.front_weight) {
    out.reach_mm += weight * trace[at].reach_mm;
    out.feed_mm += weight * trace[at].feed_mm;
    at = at + 1 == edges_.steps ? 0 : at + 1;
  }
  return out;
}

void CuttingProcess::gather() noexcept {
  active_count_ = 0;
  for (const Edge& edge : edges_.edges) {
    const std::size_t shift = edge.shift % edges_.steps;
    const std::size_t cell = cell_ >= shift ? cell_ - shift : cell_ + edges_.steps - shift;
    const EdgeCell& at = edges_.tables[edge.table][cell];
    if (!at.near) {
      continue;
    }
    const Surface left = surface(edge, cell);
    const double across = (feed_mm_ - left.feed_mm) * at.normal[1];
    Active& active = active_[active_count_++];
    active.cell = &at;
    active.write = edge.trace + cell;
    active.still_mm = feed_mm_ * at.normal[0] + edge.runout_mm;
    active.left = left;
    active.gap_mm = active.still_mm - left.reach_mm + drop_1_mm_ * across * across;
    active.runout_mm = edge.runout_mm;
    active.tip = edge.tip;
    active.cuts = true;
  }
}

CuttingProcess::Motion CuttingProcess::free_motion() const noexcept {
  Motion out;
  for (std::size_t m = 0; m < modes_.size(); ++m) {
    const ModeState& state = modes_[m];
    const ModalStep& step = steps_[m];
    const double q =
        step.position.q * state.q + step.position.v * state.v + step.position.g0 * state.g;
    const double v =
        step.velocity.q * state.q + step.velocity.v * state.v + step.velocity.g0 * state.g;
    for (std::size_t i = 0; i < 2; ++i) {
      out.x[i] += shape_[m][i] * q;
      out.v[i] += shape_[m][i] * v;
    }
  }
  return out;
}

// The displacement at the step's end is free motion plus answer·force: linear in the force.
CuttingProcess::Motion CuttingProcess::moved(const Motion& free,
                                             const std::array<double, 2>& force) const noexcept {
  Motion out = free;
  for (std::size_t i = 0; i < 2; ++i) {
    out.x[i] += dot(answer_[i], force);
    out.v[i] += dot(answer_rate_[i], force);
  }
  return out;
}

/// Determines which edges cut at this displacement; true if that changed. With `keeps_contact` all
/// of them do: the linear process whose multipliers are published.
bool CuttingProcess::touch(const std::array<double, 2>& x) noexcept {
  if (keeps_contact_) {
    return false;
  }
  bool changed = false;
  for (std::size_t i = 0; i < active_count_; ++i) {
    Active& active = active_[i];
    const bool cuts = active.gap_mm + dot(active.cell->normal, x) > 0.0;
    changed = changed || cuts != active.cuts;
    active.cuts = cuts;
  }
  return changed;
}

/// F = F₀ − A·X − P·Ẋ with X = free + answer·F: (I + A·answer + P·answer_rate)·F = right side.
std::array<double, 2> CuttingProcess::solve(const Motion& free) const noexcept {
  std::array<std::array<double, 2>, 2> a{};
  std::array<std::array<double, 2>, 2> p{};
  std::array<double, 2> right{};
  for (std::size_t e = 0; e < active_count_; ++e) {
    const Active& active = active_[e];
    if (!active.cuts || active.cell->weight == 0.0) {
      continue;
    }
    const EdgeCell& cell = *active.cell;
    const double b = cell.weight * edges_.slice_mm;
    for (std::size_t i = 0; i < 2; ++i) {
      right[i] -= b * (cell.cutting[i] * active.gap_mm + cell.rubbing[i]);
      for (std::size_t k = 0; k < 2; ++k) {
        a[i][k] += b * cell.cutting[i] * cell.normal[k];
        p[i][k] += b * damping_n_s_mm2_ * cell.normal[i] * cell.normal[k];
      }
    }
  }
  std::array<std::array<double, 2>, 2> m{{{1.0, 0.0}, {0.0, 1.0}}};
  for (std::size_t i = 0; i < 2; ++i) {
    right[i] -= dot(a[i], free.x) + dot(p[i], free.v);
    for (std::size_t k = 0; k < 2; ++k) {
      for (std::size_t l = 0; l < 2; ++l) {
        m[i][k] += a[i][l] * answer_[l][k] + p[i][l] * answer_rate_[l][k];
      }
    }
  }
  // 2 × 2 by Cramer's rule.
  const double det = m[0][0] * m[1][1] - m[0][1] * m[1][0];
  return {(right[0] * m[1][1] - right[1] * m[0][1]) / det,
          (m[0][0] * right[1] - m[1][0] * right[0]) / det};
}

/// Leaves the new surface and collects the step's output.
void CuttingProcess::finish(const Motion& now, Output& out) noexcept {
  for (std::size_t e = 0; e < active_count_; ++e) {
    const Active& active = active_[e];
    const EdgeCell& cell = *active.cell;
    const double across = dot(cell.normal, now.x);
    const double chip = active.gap_mm + across;
    // Where the feed leads out of the material there is no earlier surface to keep.
    const bool keeps = !keeps_contact_ && chip <= 0.0 && cell.normal[0] > -1e-9;
    // An edge in air leaves the surface of the tooth in front: regeneration reaches back over
    // several teeth.
    surface_[active.write] = keeps ? active.left : Surface{active.still_mm + across, feed_mm_};
    if (active.tip && cell.wall) {
      out.wall = true;
      out.wall_mm = across + active.runout_mm;
    }
    if (!active.cuts || cell.weight == 0.0) {
      continue;
    }
    out.chip_mm = std::max(out.chip_mm, chip);
    const double b = cell.weight * edges_.slice_mm;
    out.torque_n_m +=
        b * (dot(cell.cutting, cell.tangent) * chip + dot(cell.rubbing, cell.tangent));
  }
  // Force in N times the radius in mm.
  out.torque_n_m *= 0.5e-3 * cut_.diameter_mm;
}

// g₀ of the next step is this one's end: the force is continuous.
void CuttingProcess::move_modes() noexcept {
  for (std::size_t m = 0; m < modes_.size(); ++m) {
    ModeState& state = modes_[m];
    const ModalStep& step = steps_[m];
    const double g = 1000.0 / cut_.modes[m].mass_kg * dot(shape_[m], force_);
    const double q = step.position.q * state.q + step.position.v * state.v +
                     step.position.g0 * state.g + step.position.g1 * g;
    state.v = step.velocity.q * state.q + step.velocity.v * state.v + step.velocity.g0 * state.g +
              step.velocity.g1 * g;
    state.q = q;
    state.g = g;
  }
}

CuttingProcess::Output CuttingProcess::step(const Input& input) noexcept {
  const double speed = std::max(std::abs(input.speed_rev_s), 1e-6);
  turn_to(input.feed_direction);
  set_period(1.0 / (speed * static_cast<double>(edges_.steps)));
  // Process damping: C/v per length of edge, v = π·D·n the cutting speed.
  damping_n_s_mm2_ = cut_.process_damping_n_mm / (std::numbers::pi * cut_.diameter_mm * speed);
  // Before the cell advances: the surface must be there when the first tooth reads it.
  if (input.in_cut && !in_cut_) {
    lay_surface(input.feed_per_tooth_mm);
  }
  in_cut_ = input.in_cut;
  cell_ = cell_ + 1 == edges_.steps ? 0 : cell_ + 1;
  turns_ += cell_ == 0 ? 1 : 0;
  const double passes = static_cast<double>(cut_.teeth) / static_cast<double>(edges_.steps);
  feed_mm_ += input.feed_per_tooth_mm * passes;

  active_count_ = 0;
  const Motion free = free_motion();
  if (in_cut_) {
    gather();
    // First guess with the last step's force: the cutting edges depend on the displacement, and
    // vice versa.
    touch(moved(free, force_).x);
    force_ = solve(free);
    // Until the set of cutting edges is consistent, or a few times: near contact it may flip
    // forever.
    for (int i = 1; i < kMostSolutions && touch(moved(free, force_).x); ++i) {
      force_ = solve(free);
    }
  } else {
    force_ = {};
  }
  const Motion now = moved(free, force_);
  move_modes();
  Output out;
  out.period_s = period_s_;
  out.displacement_mm = now.x;
  out.velocity_mm_s = now.v;
  out.force_n = force_;
  out.feed_mm = feed_mm_;
  finish(now, out);
  out.power_w = out.torque_n_m * kTurn * speed;
  return out;
}

void CuttingProcess::disturb(double displacement_mm) noexcept {
  for (ModeState& mode : modes_) {
    mode.q += displacement_mm;
  }
}

// For growth rates: the linear process is scaled back before it overflows.
void CuttingProcess::scale(double factor) noexcept {
  for (ModeState& mode : modes_) {
    mode = {mode.q * factor, mode.v * factor, mode.g * factor};
  }
  for (Surface& cell : surface_) {
    cell.reach_mm *= factor;
  }
  force_ = {force_[0] * factor, force_[1] * factor};
}

}  // namespace steadyrest::sim
