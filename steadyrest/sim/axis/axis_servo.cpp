// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <steadyrest/sim/axis/axis_servo.hpp>
#include <steadyrest/sim/axis/friction.hpp>
#include <steadyrest/sim/axis/matrix_exponential.hpp>
#include <steadyrest/sim/base/portable.hpp>
#include <steadyrest/sim/base/range.hpp>

// A servo period is one exact step where the axis is linear, else as many drive steps as it takes:
// the exact linear step first, then what drive limit and friction take away from it, then the table
// within its backlash. The encoder is read once, at the end, as a control does.
namespace steadyrest::sim {
namespace {

using kernel::outcome::Result;

/// Standstill window of an axis whose encoder is ideal or finer than this.
constexpr double kFinestWindow_mm = 5e-4;
constexpr double kFinestWindow_rad = 5e-6;  ///< 1″; 0.5 µm on a radius of 100 mm

Result<void> check(const AxisServo::Config& c) {
  constexpr double kMax = 1e12;
  const kernel::machine::Axis& a = c.axis;
  const kernel::machine::Friction& f = a.friction;
  return in_range("axis " + a.name, {
                                        {"servo_gain_1_s", a.servo_gain_1_s, 1e-3, 1e4},
                                        {"feed_forward", a.feed_forward, 0.0, 1.5},
                                        {"velocity_lag_s", a.velocity_lag_s, 0.0, 1.0},
                                        {"drive_acceleration_mm_s2", a.drive_acceleration_au_s2,
                                         1e-6, kernel::machine::kUnlimited},
                                        {"backlash_mm", a.backlash_au, 0.0, 100.0},
                                        {"friction coulomb_mm_s2", f.coulomb_au_s2, 0.0, kMax},
                                        {"friction breakaway_mm_s2", f.breakaway_au_s2, 0.0, kMax},
                                        {"friction stribeck_mm_s", f.stribeck_au_s, 1e-9, kMax},
                                        {"friction viscous_1_s", f.viscous_1_s, 0.0, 1e6},
                                        {"servo period_s", c.period_s, 1e-6, 0.1},
                                        {"drive_period_s", c.drive_period_s, 1e-7, 0.1},
                                        {"integral_s", c.integral_s, 1e-6, 1e6},
                                    });
}

}  // namespace

Result<AxisServo> AxisServo::make(const Config& config) {
  if (auto ok = check(config); !ok) {
    return std::unexpected(ok.error());
  }
  auto encoder = Encoder::make(config.axis.encoder);
  if (!encoder) {
    return std::unexpected(encoder.error());
  }
  return AxisServo(config, *encoder);
}

AxisServo::AxisServo(const Config& config, const Encoder& encoder) noexcept
    : gain_1_s_(config.axis.servo_gain_1_s),
      inverse_gain_s_(1.0 / config.axis.servo_gain_1_s),
      lag_gain_(1.0 - config.axis.feed_forward),
      lag_s_(config.axis.velocity_lag_s),
      drive_mm_s2_(config.axis.drive_acceleration_au_s2),
      half_backlash_mm_(config.axis.backlash_au / 2.0),
      window_mm_(std::max(config.axis.encoder.count_au,
                          config.axis.rotary ? kFinestWindow_rad : kFinestWindow_mm)),
      period_s_(config.period_s),
      friction_(config.axis.friction, config.period_s),
      encoder_(encoder) {
  // No limit and no friction: one step covers the whole period.
  linear_ = !friction_.present() && std::isinf(drive_mm_s2_);
  steps_ = linear_ ? 1U
                   : static_cast<std::uint32_t>(
                         std::max(1.0, std::ceil(period_s_ / config.drive_period_s - 1e-9)));
  const double h = period_s_ / steps_;
  // Friction must be built for the step it is used with.
  friction_ = Friction(config.axis.friction, h);
  // Exact step of Ti·d̂˙ = f − d̂. portable::exp, as everywhere here: the same bytes with every
  // compiler.
  integral_share_ = friction_.present() ? 1.0 - portable::exp(-h / config.integral_s) : 0.0;
  if (lag_s_ > 0.0) {
    // ẋ = v, τ·v̇ = −k·x − v over one step h.
    const Matrix2 m =
        exponential({.xx = 0.0, .xv = h, .vx = -gain_1_s_ * h / lag_s_, .vv = -h / lag_s_});
    step_ = {.h_s = h, .rate_1_s = 1.0 / h, .xx = m.xx, .xv = m.xv, .vx = m.vx, .vv = m.vv};
  } else {
    const double decay = portable::exp(-gain_1_s_ * h);
    step_ = {
        .h_s = h, .rate_1_s = 1.0 / h, .xx = decay, .xv = 0.0, .vx = -gain_1_s_ * decay, .vv = 0.0};
  }
  // Only an encoder with counts has edges to look for.
  stretches_.resize(encoder_.count_mm() > 0.0 ? steps_ : 0U);
  reset(0.0);
}

void AxisServo::reset(double position_mm) noexcept {
  state_ = State{.motor_mm = position_mm,
                 .table_mm = position_mm,
                 .encoder_mm = encoder_.read(position_mm),
                 .count = encoder_.count(position_mm),
                 .command_mm = position_mm};
}

/// Exact solution of the linear law over one step.
///
/// With c = c₀ + p·t + ½·q·t² the particular solution is x = c − δ − α − β·t,
/// β = (1 − a)·q/k, α = ((1 − a)·p + τ·q − β)/k; the rest obeys the homogeneous law.
double AxisServo::nominal(const Piece& piece, double held_mm, double& x, double& v) const noexcept {
  const double p = piece.slope_mm_s;
  const double q = piece.curvature_mm_s2;
  const double beta = lag_gain_ * q * inverse_gain_s_;
  // held_mm is δ, the encoder's error, held through the servo period.
  const double alpha = (lag_gain_ * p + lag_s_ * q - beta) * inverse_gain_s_ + held_mm;
  const double y = x - (piece.start_mm - alpha);
  const double start_mm_s = lag_s_ > 0.0 ? v : p - beta - gain_1_s_ * y;
  const double w = start_mm_s - (p - beta);
  x = piece.end_mm - alpha - beta * step_.h_s + step_.xx * y + step_.xv * w;
  v = p + q * step_.h_s - beta + step_.vx * y + step_.vv * w;
  return start_mm_s;
}

/// v̇ of the linear law at the end of a completed step. For the log and the layer's tests: taken
/// from the law, since a difference over the period would give its mean.
double AxisServo::nominal_acceleration(const Piece& piece, double held_mm) const noexcept {
  const double forward = 1.0 - lag_gain_;
  const double command_mm_s = piece.slope_mm_s + piece.curvature_mm_s2 * step_.h_s;
  if (lag_s_ <= 0.0) {
    return gain_1_s_ * (command_mm_s - state_.velocity_mm_s) + forward * piece.curvature_mm_s2;
  }
  const double wanted_mm_s =
      gain_1_s_ * (piece.end_mm - state_.motor_mm - held_mm) + forward * command_mm_s;
  return (wanted_mm_s - state_.velocity_mm_s) / lag_s_;
}

/// One drive step: the linear law's step, less what the drive limit and friction take away.
void AxisServo::limited(const Piece& piece, double held_mm, State& s) const noexcept {
  const double h = step_.h_s;
  const double x0 = s.motor_mm;
  const double v0 = s.velocity_mm_s;
  double x = x0;
  double v = v0;
  const double start = nominal(piece, held_mm, x, v);
  // What the drive must deliver: the nominal acceleration plus the effort against friction.
  const double wanted = (v - v0) * step_.rate_1_s + s.disturbance_mm_s2;
  const double drive = std::clamp(wanted, -drive_mm_s2_, drive_mm_s2_);
  s.saturated = s.saturated || drive != wanted;
  const double v1 = friction_.step(v0, drive);
  const bool stuck = v0 == 0.0 && v1 == 0.0;
  // The exact linear step plus the trapezoid of the missing velocity; at the limit the acceleration
  // is constant and the trapezoid alone is exact.
  const double moved =
      drive == wanted ? x - x0 + 0.5 * h * ((v0 - start) + (v1 - v)) : 0.5 * h * (v0 + v1);
  s.motor_mm = stuck ? x0 : x0 + moved;
  s.velocity_mm_s = v1;
  s.acceleration_mm_s2 = (v1 - v0) * step_.rate_1_s;
  s.drive_mm_s2 = drive;
  // What the drive delivered and the axis did not show: the integral part follows it.
  const double friction = drive - s.acceleration_mm_s2;
  s.disturbance_mm_s2 += integral_share_ * (friction - s.disturbance_mm_s2);
}

// Backlash as play: the table moves only when the motor pushes it, from either side.
void AxisServo::move_table(State& s) const noexcept {
  const double before = s.table_mm;
  s.table_mm = std::clamp(before, s.motor_mm - half_backlash_mm_, s.motor_mm + half_backlash_mm_);
  s.table_velocity_mm_s =
      half_backlash_mm_ > 0.0 ? (s.table_mm - before) * step_.rate_1_s : s.velocity_mm_s;
}

/// Inside the standstill window of a command at rest, on dry friction.
bool AxisServo::holds(double command_mm, double command_mm_s) const noexcept {
  return friction_.dry() && command_mm_s == 0.0 && state_.command_mm_s == 0.0 &&
         command_mm == state_.command_mm && std::abs(command_mm - state_.encoder_mm) <= window_mm_;
}

const AxisServo::State& AxisServo::update(double command_mm, double command_mm_s) noexcept {
  const double held = state_.encoder_mm - state_.motor_mm;
  double base = state_.command_mm;
  double curvature = (command_mm_s - state_.command_mm_s) / period_s_;
  // The parabola through both commanded positions whose slope changes as the velocity does.
  double slope = (command_mm - base) / period_s_ - 0.5 * curvature * period_s_;
  state_.saturated = false;
  if (linear_) {
    const Piece piece{base, slope, curvature, command_mm};
    const double x0 = state_.motor_mm;
    const double v0 = state_.velocity_mm_s;
    const double start = nominal(piece, held, state_.motor_mm, state_.velocity_mm_s);
    state_.drive_mm_s2 = (state_.velocity_mm_s - v0) * step_.rate_1_s;
    state_.acceleration_mm_s2 = nominal_acceleration(piece, held);
    keep(0, x0, start, state_);
    move_table(state_);
  } else {
    if (holds(command_mm, command_mm_s)) {
      // Arrived: the loop holds its position, so that stiction, count size and integral part
      // together do not hunt.
      base = state_.encoder_mm;
      slope = curvature = 0.0;
    }
    State s = state_;  // local, so that the loop runs in registers
    double start = base;
    for (std::uint32_t i = 1; i <= steps_; ++i) {
      const double t = step_.h_s * i;
      const double end = base + t * (slope + 0.5 * curvature * t);
      const double x0 = s.motor_mm;
      const double v0 = s.velocity_mm_s;
      limited({start, slope + curvature * (t - step_.h_s), curvature, end}, held, s);
      keep(i - 1, x0, v0, s);
      move_table(s);
      start = end;
    }
    state_ = s;
  }
  state_.command_mm = command_mm;
  state_.command_mm_s = command_mm_s;
  count_edges();
  return state_;
}

void AxisServo::keep(std::size_t step, double start_mm, double start_mm_s,
                     const State& end) noexcept {
  if (!stretches_.empty()) {
    stretches_[step] = {step_.h_s, start_mm, start_mm_s, end.motor_mm, end.velocity_mm_s};
  }
}

// A line passed there and back leaves the count unchanged; only a change of sign shows it.
bool AxisServo::turned() const noexcept {
  double slowest = 0.0;
  double fastest = 0.0;
  for (const Stretch& stretch : stretches_) {
    slowest = std::min({slowest, stretch.start_mm_s, stretch.end_mm_s});
    fastest = std::max({fastest, stretch.start_mm_s, stretch.end_mm_s});
  }
  return slowest < 0.0 && fastest > 0.0;
}

/// The reading at the end of the period. Searches only the last edge, from the end backwards.
void AxisServo::count_edges() noexcept {
  state_.edge.reset();
  if (stretches_.empty()) {
    state_.encoder_mm = encoder_.read(state_.motor_mm);
    return;
  }
  const std::int64_t before = state_.count;
  state_.count = encoder_.count(state_.motor_mm);
  state_.encoder_mm = static_cast<double>(state_.count) * encoder_.count_mm();
  if (state_.count == before && !turned()) {
    return;
  }
  // No edge after a stretch means that the count at its end is the last one.
  for (std::size_t i = stretches_.size(); i-- > 0;) {
    if (auto edge = last_passage(encoder_, stretches_[i], state_.count)) {
      edge->before_end_s += static_cast<double>(stretches_.size() - 1 - i) * step_.h_s;
      state_.edge = edge;
      return;
    }
  }
}

}  // namespace steadyrest::sim
