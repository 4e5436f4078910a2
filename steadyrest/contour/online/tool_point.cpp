// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include <steadyrest/contour/online/tool_point.hpp>
#include <steadyrest/math/geometry/vector.hpp>

// Two halves: where the point is on the path (move), and what the axes are commanded for it
// (advance). The forecast takes the same steps as the cycle, so that both see one law.
namespace steadyrest::contour::online {
namespace {

namespace geometry = math::geometry;
using kernel::signal::Point;

/// Slower than this an axis counts as at rest and keeps the flank that it was on.
constexpr double kRest_mm_s = 0.02;
/// Cells of a CAM path that one step may pass: 0.4 mm at 0.1 mm a chord, 100 mm/s and 4 ms, five
/// times over.
constexpr std::size_t kMostJoints = 20;

}  // namespace

Point on_cell(const Cell& cell, double delta_mm) noexcept {
  return geometry::add_scaled(geometry::add_scaled(cell.point_mm, cell.tangent, delta_mm),
                              cell.curvature_1_mm, 0.5 * delta_mm * delta_mm);
}

void ToolPoint::set_model(std::span<const AxisModel, 3> model) noexcept {
  std::ranges::copy(model, model_.begin());
  lag_s_ = 0.0;
  for (const AxisModel& axis : model_) {
    lag_s_ = std::max(lag_s_, (1.0 - axis.feed_forward) / axis.gain_1_s);
  }
}

ToolPoint::State ToolPoint::at(const LookAhead& path, double position_mm,
                               double speed_mm_s) const noexcept {
  State state;
  state.position_mm = position_mm;
  state.speed_mm_s = speed_mm_s;
  state.cell = path.find(position_mm, path.begin());
  state.wanted_mm = wanted(path, state, 0.0);
  state.command_mm = state.wanted_mm;
  return state;
}

/// The speed that the corners ahead permit at the end of a step of `h_s`.
// Every joint up to there counts by itself, the next one by what can be braked before it.
double ToolPoint::corner_limit_mm_s(const LookAhead& path, const State& state,
                                    double h_s) const noexcept {
  const double end = state.position_mm + state.speed_mm_s * h_s;
  double square = std::numeric_limits<double>::infinity();
  std::size_t next = state.cell + 1;
  for (std::size_t n = 0; n < kMostJoints && next < path.end(); ++n, ++next) {
    const Cell& cell = path.cell(next);
    const double left = std::max(0.0, cell.position_mm - end);
    const double brake = path.cell(next - 1).acceleration_mm_s2;
    square = std::min(square, cell.tool_square_mm2_s2 + 2.0 * brake * left);
    if (cell.position_mm > end) {
      break;
    }
  }
  return std::sqrt(square);
}

/// ṡ = (s_c − s)/L over one step, exact for a command of constant speed, unless a corner holds it.
// What the point is held back by is (v − (s_c − s)/L)·L of offset along the path.
void ToolPoint::move(const LookAhead& path, double from_mm, double to_mm, double h_s,
                     State& state) const noexcept {
  if (lag_s_ <= 0.0) {
    state.speed_mm_s = (to_mm - from_mm) / h_s;
    state.position_mm = to_mm;
    state.cell = path.find(to_mm, state.cell);
    return;
  }
  const double decay = std::exp(-h_s / lag_s_);
  const double behind =
      (from_mm - state.position_mm) * decay + (to_mm - from_mm) / h_s * lag_s_ * (1.0 - decay);
  const double before = state.speed_mm_s;
  const double gain = path.cell(state.cell).acceleration_mm_s2 * h_s;
  double speed = behind / lag_s_;
  double position = to_mm - behind;
  const double held = std::min(corner_limit_mm_s(path, state, h_s), before + gain);
  if (held < speed) {
    const double least =
        (to_mm - state.position_mm - 0.5 * h_s * (before + held) - config_.most_behind_mm) / lag_s_;
    speed = std::clamp(held, std::min(least, speed), speed);
    position = std::min(position, state.position_mm + 0.5 * h_s * (before + speed));
  }
  state.position_mm = std::clamp(position, state.position_mm, std::max(state.position_mm, to_mm));
  state.speed_mm_s = speed;
  state.cell = path.find(state.position_mm, state.cell);
}

/// y + (ẏ + τ·ÿ)/k and half of the backlash.
std::array<double, 3> ToolPoint::wanted(const LookAhead& path, State& state,
                                        double acceleration_mm_s2) const noexcept {
  const Cell& cell = path.cell(state.cell);
  const double delta = std::clamp(state.position_mm - cell.position_mm, 0.0, cell.length_mm);
  const Point y = on_cell(cell, delta);
  const Point tangent =
      geometry::unit(geometry::add_scaled(cell.tangent, cell.curvature_1_mm, delta));
  // The parabola's curvature keeps its direction; the path's stays square to the tangent.
  const Point bend = geometry::add_scaled(cell.curvature_1_mm, tangent,
                                          -geometry::dot(cell.curvature_1_mm, tangent));
  const double v = state.speed_mm_s;
  std::array<double, 3> wanted{};
  for (std::size_t i = 0; i < 3; ++i) {
    const double velocity = tangent[i] * v;
    const double acceleration = bend[i] * v * v + tangent[i] * acceleration_mm_s2;
    if (std::abs(velocity) > kRest_mm_s) {
      state.side[i] = velocity > 0.0 ? 1.0 : -1.0;
    }
    const AxisModel& axis = model_[i];
    wanted[i] = y[i] + (velocity + axis.velocity_lag_s * acceleration) / axis.gain_1_s +
                state.side[i] * config_.half_backlash_mm[i];
  }
  return wanted;
}

void ToolPoint::advance(const LookAhead& path, double from_mm, double to_mm, double h_s,
                        State& state) const noexcept {
  const double before_mm_s = state.speed_mm_s;
  move(path, from_mm, to_mm, h_s, state);
  const auto next = wanted(path, state, (state.speed_mm_s - before_mm_s) / h_s);
  for (std::size_t i = 0; i < 3; ++i) {
    const double a = model_[i].feed_forward;
    double& command = state.command_mm[i];
    if (a > 0.0) {
      // a·ċ′ = k·(wanted − c′), exact for `wanted` on a straight line over the step.
      const double x = model_[i].gain_1_s * h_s / a;
      const double decay = std::exp(-x);
      const double mean = -std::expm1(-x) / x;
      command = decay * command + (mean - decay) * state.wanted_mm[i] + (1.0 - mean) * next[i];
    } else {
      command = next[i];
    }
  }
  state.wanted_mm = next;
}

}  // namespace steadyrest::contour::online
