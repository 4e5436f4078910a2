// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <cmath>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/motion/online/bounded/motion_bound.hpp>

// The order within a tick: what the last tick's intervals now allow (advance), then what this
// tick's evidence proves by itself (fresh_: triples, pairs, standstill), then their intersection.
// Evidence and past stay separate until the end, so that on a contradiction the past can be dropped
// and the evidence kept.
namespace steadyrest::motion::online {
namespace {

using kernel::outcome::refuse;

/// 120 m/min: the speed limit until something tighter is known.
constexpr double kFastest = 2000.0;
/// No stamp is exact: a picosecond, plus the rounding of a double of this size.
constexpr double kLeastClock = 1e-12;
constexpr double kRounding = 1e-15;
/// Spans of the triples as multiples of the best span for the velocity, ∛(48·ε/J).
constexpr std::array kSpanFactors{0.7, 1.0, 1.3, 1.8};

Interval both(const Interval& a, const Interval& b) noexcept {
  return {std::max(a.low, b.low), std::min(a.high, b.high)};
}

/// ∛x for x > 0 within 1e-4, enough to choose a span: a third of the exponent, then a Halley step.
double rough_cbrt(double x) noexcept {
  constexpr std::uint64_t kBias = 0x2A9F7893782DA1CEULL;
  const auto y = std::bit_cast<double>(std::bit_cast<std::uint64_t>(x) / 3 + kBias);
  const double y3 = y * y * y;
  return y * (y3 + 2.0 * x) / (2.0 * y3 + x);
}

}  // namespace

kernel::outcome::Result<MotionBound> MotionBound::make(const Config& config) {
  if (!(config.cycle_s >= 1e-6 && config.cycle_s <= 1.0)) {
    return refuse("the cycle is outside 1e-6 … 1 s", "give the control's cycle time in s");
  }
  if (!(config.clock_s >= 0.0 && config.clock_s <= config.cycle_s)) {
    return refuse("the clock period is outside 0 … one cycle",
                  "give the period of the time stamps in s");
  }
  if (!(config.max_speed_mm_s > 0.0 && config.max_acceleration_mm_s2 > 0.0 &&
        config.max_jerk_mm_s3 > 0.0)) {
    return refuse("a limit of speed, acceleration or jerk is not positive",
                  "give positive limits, or none");
  }
  return MotionBound(config);
}

MotionBound::MotionBound(const Config& config) noexcept
    : config_(config),
      span_of_jerk_(std::cbrt(48.0 / config.max_jerk_mm_s3)),
      span_of_acceleration_(2.0 / std::sqrt(config.max_acceleration_mm_s2)) {
  forget();
}

void MotionBound::forget() noexcept {
  next_ = 0;
  count_ = 0;
  has_waiting_ = false;
  started_ = false;
  sampled_ = true;
  now_.velocity = {-config_.max_speed_mm_s, config_.max_speed_mm_s};
  now_.acceleration = {-config_.max_acceleration_mm_s2, config_.max_acceleration_mm_s2};
}

/// Age of the youngest node not younger than t, else the oldest. Times fall with age. Searches from
/// `guess` in doubling steps, then by bisection.
std::size_t MotionBound::age_at(double t_s, std::size_t guess) const noexcept {
  std::size_t low = 0;
  std::size_t high = count_ - 1;
  std::size_t probe = std::min(guess, high);
  if (back(probe).t_s <= t_s) {
    high = probe;
    for (std::size_t step = 1; high > low; step *= 2) {
      probe = high > step ? high - step : 0;
      if (back(probe).t_s > t_s) {
        low = probe + 1;
        break;
      }
      high = probe;
    }
  } else {
    low = std::min(probe + 1, high);
    for (std::size_t step = 1; low + step <= high; step *= 2) {
      probe = low + step - 1;
      if (back(probe).t_s <= t_s) {
        high = probe;
        break;
      }
      low = probe + 1;
    }
  }
  while (low < high) {
    const std::size_t middle = (low + high) / 2;
    if (back(middle).t_s <= t_s) {
      high = middle;
    } else {
      low = middle + 1;
    }
  }
  return low;
}

double MotionBound::speed_now(double t_s) const noexcept {
  if (!started_) {
    return std::min(kFastest, config_.max_speed_mm_s);
  }
  // The fastest speed that the last tick's intervals and the limits now allow.
  const double d = std::max(0.0, t_s - t_s_);
  const double a = std::min(now_.acceleration.magnitude() + d * config_.max_jerk_mm_s3,
                            config_.max_acceleration_mm_s2);
  const double v = now_.velocity.magnitude() + d * a;
  return std::min({v, config_.max_speed_mm_s, kFastest});
}

void MotionBound::keep(const Node& node) noexcept {
  nodes_[next_] = node;
  next_ = (next_ + 1) % kNodes;
  count_ = std::min(count_ + 1, kNodes);
}

void MotionBound::edge(double t_s, double position_mm, double line_error_mm) noexcept {
  const double error =
      speed_now(t_s) * (0.5 * config_.clock_s + kLeastClock + kRounding * std::abs(t_s)) +
      kRounding * std::abs(position_mm) + line_error_mm;
  if (sampled_) {  // the cells at earlier ticks are worth less than passages
    sampled_ = false;
    next_ = 0;
    count_ = 0;
  }
  // Closer nodes would only push older ones out of the ring.
  if (has_waiting_ &&
      (count_ == 0 || waiting_.t_s - back(0).t_s >= config_.cycle_s / kNodesPerCycle)) {
    keep(waiting_);
  }
  waiting_ = {t_s, position_mm, error};
  has_waiting_ = true;
  passed_ = true;
}

/// Computes what the last tick's intervals now allow.
/// Without a jerk limit half is infinite and the acceleration limit alone decides.
void MotionBound::advance(double t_s) noexcept {
  const double d = t_s - t_s_;
  const double jerk = config_.max_jerk_mm_s3;
  const double a_max = config_.max_acceleration_mm_s2;
  const Interval a = now_.acceleration;
  Interval& v = now_.velocity;
  const double half = std::isfinite(jerk) ? 0.5 * jerk * d * d : kNoBound;
  // v may change by a·d ± J·d²/2, and by no more than A·d.
  v = both({v.low + d * std::max(a.low - half / d, -a_max),
            v.high + d * std::min(a.high + half / d, a_max)},
           {-config_.max_speed_mm_s, config_.max_speed_mm_s});
  now_.acceleration = both({a.low - jerk * d, a.high + jerk * d}, {-a_max, a_max});
}

// Lagrange's parabola through the three nodes, differentiated at T: with hᵢ = T − tᵢ, cᵢ = 1/Π(hᵢ
// − hⱼ) up to sign, ℓ̇ᵢ = cᵢ·(sum of the other two h), ℓ̈ᵢ = 2cᵢ, and for ω = Π(t − tᵢ): ω̇(T) =
// h₁h₂ + h₁h₃ + h₂h₃, ω̈(T) = 2(h₁ + h₂ + h₃). The first node is the origin, so ℓ₁ enters only the
// errors.
void MotionBound::triple(double t_s, const Node& first, const Node& second,
                         const Node& third) noexcept {
  const double h1 = t_s - first.t_s;
  const double h2 = t_s - second.t_s;
  const double h3 = t_s - third.t_s;
  const double d12 = h2 - h1;
  const double d13 = h3 - h1;
  const double d23 = h3 - h2;
  if (!(d12 > 0.0 && d23 > 0.0)) {
    return;
  }
  const double inverse = 1.0 / (d12 * d13 * d23);
  const double c1 = d23 * inverse;
  const double c2 = -d13 * inverse;
  const double c3 = d12 * inverse;
  const double l1 = c1 * (h2 + h3);
  const double l2 = c2 * (h1 + h3);
  const double l3 = c3 * (h1 + h2);
  // Positions relative to the first: large parts cancel before multiplication.
  const double x2 = second.position_mm - first.position_mm;
  const double x3 = third.position_mm - first.position_mm;
  const double jerk = config_.max_jerk_mm_s3;
  // c2 is negative here, hence the minus: each error enters with its modulus.
  fresh_.velocity.cut(l2 * x2 + l3 * x3, l1 * first.error_mm - l2 * second.error_mm +
                                             l3 * third.error_mm +
                                             jerk * (h1 * h2 + h1 * h3 + h2 * h3) * (1.0 / 6.0));
  fresh_.acceleration.cut(2.0 * (c2 * x2 + c3 * x3),
                          2.0 * (c1 * first.error_mm - c2 * second.error_mm + c3 * third.error_mm) +
                              jerk * (h1 + h2 + h3) * (1.0 / 3.0));
}

/// Triples with spans about the best one, side by side; the law is that of `triple`. Gathers first,
/// then computes: the second loop has no branch and no indirect load, so the compiler can run the
/// four spans as one vector.
void MotionBound::triples(double t_s, const Node& first, Hints& hints) noexcept {
  if (count_ < 2 || !std::isfinite(config_.max_jerk_mm_s3)) {
    return;
  }
  using Spans = std::array<double, kSpans>;
  // q = ∛(48·ε/J), the best span for the velocity; neighbours on either side cover the acceleration
  // and gaps between edges.
  const double best = span_of_jerk_ * rough_cbrt(std::max(first.error_mm, 1e-12));
  Spans h2{};
  Spans h3{};
  Spans x2{};
  Spans x3{};
  Spans e2{};
  Spans e3{};
  for (std::size_t k = 0; k < kSpans; ++k) {
    hints.third[k] = std::clamp(age_at(t_s - kSpanFactors[k] * best, hints.third[k]),
                                std::size_t{1}, count_ - 1);
    const Node& third = back(hints.third[k]);
    hints.second[k] =
        std::min(age_at(0.5 * (first.t_s + third.t_s), hints.second[k]), hints.third[k] - 1);
    const Node& second = back(hints.second[k]);
    h2[k] = t_s - second.t_s;
    h3[k] = t_s - third.t_s;
    x2[k] = second.position_mm - first.position_mm;
    x3[k] = third.position_mm - first.position_mm;
    e2[k] = second.error_mm;
    e3[k] = third.error_mm;
  }
  const double h1 = t_s - first.t_s;
  const double e1 = first.error_mm;
  const double jerk_6 = config_.max_jerk_mm_s3 * (1.0 / 6.0);
  Spans v{};
  Spans v_radius{};
  Spans a{};
  Spans a_radius{};
  for (std::size_t k = 0; k < kSpans; ++k) {
    const double d12 = h2[k] - h1;
    const double d13 = h3[k] - h1;
    const double d23 = h3[k] - h2[k];
    const double inverse = 1.0 / (d12 * d13 * d23);
    // Here c2 is the modulus; the sign is written out where the position enters.
    const double c1 = d23 * inverse;
    const double c2 = d13 * inverse;
    const double c3 = d12 * inverse;
    const double s23 = h2[k] + h3[k];
    const double s13 = h1 + h3[k];
    const double s12 = h1 + h2[k];
    v[k] = c3 * s12 * x3[k] - c2 * s13 * x2[k];
    v_radius[k] =
        c1 * s23 * e1 + c2 * s13 * e2[k] + c3 * s12 * e3[k] + jerk_6 * (h1 * s23 + h2[k] * h3[k]);
    a[k] = 2.0 * (c3 * x3[k] - c2 * x2[k]);
    a_radius[k] = 2.0 * (c1 * e1 + c2 * e2[k] + c3 * e3[k] + jerk_6 * (h1 + s23));
  }
  for (std::size_t k = 0; k < kSpans; ++k) {
    // Coinciding nodes give infinities above, excluded only here: the loop has no branch.
    if (h2[k] > h1 && h3[k] > h2[k]) {
      fresh_.velocity.cut(v[k], v_radius[k]);
      fresh_.acceleration.cut(a[k], a_radius[k]);
    }
  }
}

/// Two passages and the acceleration limit: v(T) differs from the mean speed between them by at
/// most A·(T − their middle).
void MotionBound::pairs(double t_s) noexcept {
  const double a_max = config_.max_acceleration_mm_s2;
  if (!std::isfinite(a_max) || count_ < 1) {
    return;
  }
  const Node& first = has_waiting_ ? waiting_ : back(0);
  // 2·√(ε/A) minimises 2ε/h + A·h/2.
  const double span = span_of_acceleration_ * std::sqrt(std::max(first.error_mm, 1e-12));
  pair_hint_ = age_at(first.t_s - span, pair_hint_);
  const Node& second = back(pair_hint_);
  const double h = first.t_s - second.t_s;
  if (h > 0.0) {
    const double inverse = 1.0 / h;
    fresh_.velocity.cut((first.position_mm - second.position_mm) * inverse,
                        (first.error_mm + second.error_mm) * inverse +
                            a_max * (t_s - 0.5 * (first.t_s + second.t_s)));
  }
}

/// The axis came into this cell, or may have left it since the last tick.
void MotionBound::rest_begins(double half_cell_mm) noexcept {
  rest_count_ = 0;
  rest_wait_ = 0;
  const double jerk = config_.max_jerk_mm_s3;
  if (rest_half_cell_mm_ == half_cell_mm || !std::isfinite(jerk)) {
    return;
  }
  rest_half_cell_mm_ = half_cell_mm;
  // At standstill the error of a position is the half cell; ∛(48·ε/J) and ∛(64·ε/J) are the best
  // spans of velocity and acceleration.
  const double span_v_s = std::cbrt(48.0 * half_cell_mm / jerk);
  const double span_a_s = std::cbrt(64.0 * half_cell_mm / jerk);
  rest_step_ = static_cast<std::size_t>(
      1.0 + span_a_s / (static_cast<double>(kRestTicks - 2) * config_.cycle_s));
  const double step_s = static_cast<double>(rest_step_) * config_.cycle_s;
  const auto steps = [&](double span_s) {
    return static_cast<std::size_t>(
        std::lround(std::min(span_s / step_s, static_cast<double>(kRestTicks))));
  };
  rest_steps_v_ = steps(span_v_s);
  rest_steps_a_ = steps(span_a_s);
}

/// The axis was in this one cell at T, about T − span/2 and about T − span: at ticks, since edges
/// may be lost silently and the axis may have been elsewhere between ticks.
void MotionBound::standstill(const Node& cell, std::size_t steps) noexcept {
  const std::size_t third = std::clamp(steps, std::size_t{1}, rest_count_ - 1);
  const std::size_t second = (third - 1) / 2;
  const auto then = [&](std::size_t age) {
    const double t_s = rest_s_[(rest_next_ + kRestTicks - 1 - age) % kRestTicks];
    return Node{t_s, cell.position_mm, cell.error_mm};
  };
  triple(cell.t_s, cell, then(second), then(third));
}

void MotionBound::standstill(const Node& cell) noexcept {
  if (!std::isfinite(config_.max_jerk_mm_s3)) {
    return;
  }
  if (rest_count_ >= 2) {
    standstill(cell, rest_steps_v_);
    standstill(cell, rest_steps_a_);
  }
  if (rest_wait_ == 0) {
    rest_s_[rest_next_] = cell.t_s;
    rest_next_ = (rest_next_ + 1) % kRestTicks;
    rest_count_ = std::min(rest_count_ + 1, kRestTicks);
    rest_wait_ = rest_step_;
  }
  --rest_wait_;
}

MotionIntervals MotionBound::tick(double t_s, double low_mm, double high_mm) noexcept {
  const double half_cell = 0.5 * (high_mm - low_mm);
  // The edges' stamps are half a clock period off the tick's own time.
  const Node cell{t_s, 0.5 * (low_mm + high_mm),
                  half_cell + (sampled_ ? 0.0 : speed_now(t_s) * 0.5 * config_.clock_s)};
  if (started_ && t_s > t_s_) {
    advance(t_s);
  }
  if (!started_ || passed_ || cell.position_mm != cell_mm_) {
    rest_begins(half_cell);
  }
  passed_ = false;
  cell_mm_ = cell.position_mm;
  fresh_ = {};
  // Counts only: the cells at the ticks are the nodes. With edges, a cell is worth a node only when
  // the last edge is well in the past; right after an edge it repeats the edge's information ten to
  // a hundred times more coarsely.
  if (sampled_) {
    triples(t_s, cell, cell_hints_);
    keep(cell);
  } else {
    triples(t_s, waiting_, passage_hints_);
    if (t_s - waiting_.t_s > 0.5 * config_.cycle_s && count_ >= 1) {
      triple(t_s, cell, waiting_, back(0));
      triples(t_s, cell, cell_hints_);
    }
  }
  pairs(t_s);
  standstill({t_s, cell.position_mm, half_cell});
  // All stamps may be late by the same half clock period.
  const double late = 0.5 * config_.clock_s;
  if (late > 0.0 && !sampled_) {
    const double a = std::min(fresh_.acceleration.magnitude() + config_.max_jerk_mm_s3 * late,
                              config_.max_acceleration_mm_s2);
    fresh_.velocity.low -= a * late;
    fresh_.velocity.high += a * late;
    fresh_.acceleration.low -= config_.max_jerk_mm_s3 * late;
    fresh_.acceleration.high += config_.max_jerk_mm_s3 * late;
  }
  const MotionIntervals met{both(now_.velocity, fresh_.velocity),
                            both(now_.acceleration, fresh_.acceleration)};
  // No motion within the limits explains this: only this tick's evidence is kept, so that a wrong
  // past does not last.
  if (met.velocity.empty() || met.acceleration.empty()) {
    ++contradictions_;
    const Interval v{-config_.max_speed_mm_s, config_.max_speed_mm_s};
    const Interval a{-config_.max_acceleration_mm_s2, config_.max_acceleration_mm_s2};
    now_ = {fresh_.velocity.empty() ? v : fresh_.velocity,
            fresh_.acceleration.empty() ? a : fresh_.acceleration};
  } else {
    now_ = met;
  }
  started_ = true;
  t_s_ = t_s;
  return now_;
}

}  // namespace steadyrest::motion::online
