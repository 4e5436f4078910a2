// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <steadyrest/motion/online/bounded/jerk_ramp.hpp>

// The life of a ramp: edge() checks the prediction, decides whether this edge is a start, and then
// either follows the start (begin, go_on) or searches for a stop (fit: guess, improve, weigh). at()
// answers from whichever is believed, with its share. A share never depends on one test: it is the
// likelihood against the best smooth alternative times how often such predictions came true on this
// axis (Trust).
namespace steadyrest::motion::online {
namespace {

// Which test fails when one is moved: README, "What the constants do".
constexpr double kOdds = 0.01;       ///< prior of a stop at any constant jerk
constexpr double kOddsKnown = 0.5;   ///< … when it is the known one
constexpr double kSameJerk = 0.03;   ///< within this it is the known one
constexpr double kAtRest = 0.9;      ///< probability of standstill from which a line is a start
constexpr double kLeastWay = 2.0;    ///< counts for which a start keeps its jerk, at least
constexpr double kBeyond = 1.1;      ///< of the limit: apparent excess caused by line errors
constexpr double kMemory = 8.0;      ///< stops or starts
constexpr double kOtherwise = 0.05;  ///< largest residual of other motions, counts
constexpr double kOff = 0.05;        ///< counts by which a line may differ from its prediction
constexpr double kFar = 8.0;         ///< counts before standstill at which the search begins
constexpr double kSlower = 1.02;     ///< the last count's time over the previous one's, there
constexpr double kSure = 0.9;
constexpr double kLeastVariance = 1e-8;  ///< count²
constexpr std::size_t kLeast = 4;        ///< passages; all of them unless it is the known jerk
constexpr int kSteps = 4;                ///< of the fit; half of them from the last one

}  // namespace

void JerkRamp::Trust::learn(bool came) noexcept {
  yes += came ? 1.0 : 0.0;
  all += 1.0;
  // Scales both down together: the share stays and old stops lose weight.
  if (all > kMemory) {
    yes *= kMemory / all;
    all = kMemory;
  }
}

void JerkRamp::forget() noexcept {
  count_ = 0;
  kind_ = Kind::none;
}

void JerkRamp::edge(double t_s, double x, std::int8_t direction, double variance, double at_rest,
                    double quiet_s) noexcept {
  // First of all, this edge checks the predicted stop.
  judge_stop(t_s, x, direction);
  if (kind_ == Kind::stop && t_s > t0_s_) {
    at_rest = std::max(at_rest, share_);
  }
  // A start takes up to ∛(6/J) to the first line: a shorter quiet was not standstill.
  const bool starts = at_rest > kAtRest && !(quiet_s * quiet_s * quiet_s * jerk_ < 6.0);
  if (starts || direction != direction_) {
    if (kind_ == Kind::start) {
      starts_.learn(false);
      kind_ = Kind::none;
    }
    count_ = 0;
    direction_ = direction;
  }
  passages_[next_] = {t_s, x, variance};
  next_ = (next_ + 1) % kPassages;
  count_ = std::min(count_ + 1, kPassages);
  if (starts) {
    begin(t_s, x, at_rest);
    from_s_ = std::max(from_s_, t_s - quiet_s);
    return;
  }
  if (kind_ == Kind::start) {
    go_on();
    if (kind_ == Kind::start) {
      return;
    }
  }
  fit();
}

/// The edge shows whether the axis stopped where and when predicted.
void JerkRamp::judge_stop(double t_s, double x, std::int8_t direction) noexcept {
  if (kind_ != Kind::stop || share_ < 0.1) {
    return;
  }
  const double tau = std::max(0.0, t0_s_ - t_s);
  const double expected = x0_ - direction_ * c_ * tau * tau * tau;
  const double rest_s = t_s - t0_s_;
  // Still on the way to the stop: a line off its predicted place refutes it; one on its place
  // proves nothing yet.
  if (rest_s <= 0.0 && direction == direction_) {
    if (std::abs(expected - x) > kOff) {
      stops_.learn(false);
    }
    return;
  }
  // From rest nothing can come sooner than at the jerk of the stop.
  const bool stood = rest_s > 0.0 && c_ * rest_s * rest_s * rest_s > 0.5 * std::abs(x - x0_);
  stops_.learn(stood);
  if (!stood) {
    kind_ = Kind::none;
  }
}

void JerkRamp::begin(double t_s, double x, double at_rest) noexcept {
  const bool place_known = kind_ == Kind::stop && share_ > kSure;
  kind_ = Kind::none;
  // The limits of acceleration and speed end it after A³/6J² and √(V³/J)/6 at the earliest.
  const double most_a = config_.acceleration * config_.acceleration * config_.acceleration;
  const double most_v = config_.speed * config_.speed * config_.speed;
  if (!(jerk_ < kNoBound) || most_a < 6.0 * kLeastWay * jerk_ * jerk_ ||
      most_v < 36.0 * kLeastWay * kLeastWay * jerk_) {
    return;
  }
  kind_ = Kind::start;
  share_ = starts_.share() * at_rest;
  // It cannot have started before it stopped.
  from_s_ = place_known ? t0_s_ : 0.0;
  c_ = jerk_ / 6.0;
  known_ = false;
  judged_ = false;
  const double way = direction_ * (x - x0_);
  if (place_known && way > 0.0 && way < 1.0) {
    // way = c·(t − t₀)³, with the position of standstill known from the stop.
    t0_s_ = t_s - std::cbrt(way / c_);
    known_ = true;
  }
}

// Lines after the first of a start. The second gives t₀ (or confirms the t₀ left by the previous
// stop); each later one must come when the curve predicts, and the first that does not ends the
// start.
void JerkRamp::go_on() noexcept {
  const Passage& now = back(0);
  const Passage& last = back(1);
  if (count_ >= kPassages) {
    kind_ = Kind::none;
    return;
  }
  const double d = now.t_s - last.t_s;
  if (known_) {
    // Ways from the start at the last line and at this one; their difference must be the way
    // between the lines.
    const double then = last.t_s - t0_s_;
    const double next = now.t_s - t0_s_;
    const double expected = c_ * (next * next * next - then * then * then);
    const bool came = std::abs(expected - direction_ * (now.x - last.x)) < kOff;
    if (!judged_) {
      starts_.learn(came);
      judged_ = true;
    }
    if (!came) {
      kind_ = Kind::none;
      return;
    }
    share_ = std::max(share_, 0.95);
  }
  // c·(3dθ² + 3d²θ + d³) = way, θ from the start to the line before.
  const double root = (4.0 * direction_ * (now.x - last.x) / (c_ * d) - d * d) / 12.0;
  // The positive root of that quadratic in θ.
  const double theta = root > 0.0 ? std::sqrt(root) - 0.5 * d : -1.0;
  // Way from standstill to the previous line at the assumed jerk.
  const double way = c_ * theta * theta * theta;
  // The first line is at most one count from standstill.
  if (theta < 0.0 || (count_ == 2 && way > 1.0 + kOff)) {
    starts_.learn(false);
    kind_ = Kind::none;
    return;
  }
  if (!known_) {
    t0_s_ = last.t_s - theta;
    known_ = true;
  }
}

/// Extrapolates a parabola through the last three passages: v = a²/2J gives the rest.
bool JerkRamp::guess(Curve& out) const noexcept {
  const Passage& now = back(0);
  const double h1 = now.t_s - back(1).t_s;
  const double h2 = back(1).t_s - back(2).t_s;
  if (!(h2 > 0.0 && h1 > kSlower * h2)) {
    return false;
  }
  const double v1 = direction_ * (now.x - back(1).x) / h1;
  const double v2 = direction_ * (back(1).x - back(2).x) / h2;
  const double a = 2.0 * (v2 - v1) / (h1 + h2);
  // The speed now, half an interval on from the mean speed of the last one; bounded, since a
  // parabola near the end may pass through 0.
  const double v = std::max(v1 - 0.5 * h1 * a, 0.2 * v1);
  if (!(a > 0.0) || 2.0 * v * v > 3.0 * kFar * a) {
    return false;
  }
  // v = 3c·τ², a = 6c·τ, so τ = 2v/a and x₀ = v·τ/3.
  const double tau = 2.0 * v / a;
  out = {v * tau / 3.0, tau, v / (3.0 * tau * tau)};
  return true;
}

JerkRamp::Residual JerkRamp::residual(std::size_t age, const Curve& curve) const noexcept {
  const Passage& p = back(age);
  // Times and positions relative to the last passage: large parts cancel.
  const double tau = curve.t0_s - (p.t_s - back(0).t_s);
  const double slope = 3.0 * curve.c * tau * tau;
  // A stamp is off by up to half a clock period, evenly: variance (v·clock)²/12.
  const double blur = slope * config_.clock_s;
  return {direction_ * (p.x - back(0).x) - (curve.x0 - curve.c * tau * tau * tau),
          p.variance + blur * blur / 12.0 + kLeastVariance, slope, tau * tau * tau};
}

/// One step of Gauss–Newton; the 3×3 system by elimination.
/// Normal equations of the weighted residuals in x₀, t₀ and c. The signs: residual() gives −∂x/∂t₀
/// and −∂x/∂c, so column 1 (x₀) meets columns 2 and 3 with a minus. A 3×3 system of well-scaled
/// terms (times and positions from the last passage) needs no pivoting; a singular one gives a
/// value that is not finite, and the fit is dropped.
bool JerkRamp::improve(Curve& curve) const noexcept {
  double m11 = 0.0, m12 = 0.0, m13 = 0.0, m22 = 0.0, m23 = 0.0, m33 = 0.0;
  double g1 = 0.0, g2 = 0.0, g3 = 0.0;
  for (std::size_t k = 0; k < count_; ++k) {
    const Residual r = residual(k, curve);
    const double w = 1.0 / r.variance;
    m11 += w;
    m12 -= w * r.slope;
    m13 -= w * r.cube;
    m22 += w * r.slope * r.slope;
    m23 += w * r.slope * r.cube;
    m33 += w * r.cube * r.cube;
    g1 += w * r.value;
    g2 -= w * r.slope * r.value;
    g3 -= w * r.cube * r.value;
  }
  const double f2 = m12 / m11;
  const double f3 = m13 / m11;
  const double a22 = m22 - f2 * m12;
  const double a23 = m23 - f2 * m13;
  const double f = a23 / a22;
  const double b2 = g2 - f2 * g1;
  const double dc = (g3 - f3 * g1 - f * b2) / (m33 - f3 * m13 - f * a23);
  const double dt = (b2 - a23 * dc) / a22;
  const double dx = (g1 - m12 * dt - m13 * dc) / m11;
  curve.x0 += dx;
  curve.t0_s += dt;
  curve.c += dc;
  return std::isfinite(curve.x0);
}

void JerkRamp::fit() noexcept {
  const bool was = kind_ == Kind::stop;
  kind_ = Kind::none;
  const Passage& now = back(0);
  Curve curve;
  if (count_ < kLeast || !guess(curve)) {
    return;
  }
  // The last solution, shifted to the new passage's origin, is closer than the parabola's guess.
  if (was) {
    curve = {direction_ * (x0_ - now.x), t0_s_ - now.t_s, c_};
  }
  // From the last solution half of the steps suffice.
  for (int step = was ? kSteps / 2 : 0; step < kSteps; ++step) {
    if (!improve(curve)) {
      return;
    }
  }
  // Standstill must lie ahead in time and space, and the jerk within the limit.
  if (!(curve.c > 0.0) || !(curve.t0_s > 0.0) || curve.x0 < -kOff ||
      6.0 * curve.c > kBeyond * config_.jerk) {
    return;
  }
  // The unknown jerk needs all six passages: three unknowns through four leave only one residual.
  const bool same = std::abs(6.0 * curve.c - jerk_) < kSameJerk * jerk_;
  if (!same && count_ < kPassages) {
    return;
  }
  // The alternative, a motion without this jerk: no parabola comes nearer to the curve over the
  // window W than c·W³/32, RMS c·W³/45. Line errors above that hide the difference.
  const double window_s = now.t_s - back(count_ - 1).t_s;
  const double otherwise =
      std::min(kOtherwise, curve.c * window_s * window_s * window_s * (1.0 / 45.0));
  double chi2 = 0.0;
  double ratio = 1.0;
  for (std::size_t k = 0; k < count_; ++k) {
    const Residual r = residual(k, curve);
    chi2 += r.value * r.value / r.variance;
    ratio *= otherwise * otherwise / r.variance;
  }
  const auto n = static_cast<double>(count_);
  // Log likelihood ratio, minus the three fitted unknowns.
  const double evidence = 0.5 * ((n - 3.0) / n * std::log(ratio) - chi2);
  const double odds = stops_.share() * (same ? kOddsKnown : kOdds);
  share_ = evidence < -30.0 ? 0.0 : odds / (odds + std::exp(-evidence));
  // Below 1 % it would not show in the estimate but would delay a start.
  if (share_ < 0.01) {
    return;
  }
  kind_ = Kind::stop;
  x0_ = now.x + direction_ * curve.x0;
  t0_s_ = now.t_s + curve.t0_s;
  c_ = curve.c;
  from_s_ = back(count_ - 1).t_s;
  // The control's jerk, learnt here; starts use it.
  if (share_ > kSure) {
    jerk_ = 6.0 * c_;
  }
}

JerkRamp::Motion JerkRamp::stopping(double now_s, double when_s) const noexcept {
  const double now = std::max(0.0, t0_s_ - now_s);
  // The next line should have been passed by now: it was not, so this is not such a stop.
  if (direction_ * (x0_ - back(0).x) - c_ * now * now * now > 1.0 + kOff) {
    return {};
  }
  const double tau = std::max(0.0, t0_s_ - when_s);
  return {share_, direction_ * 3.0 * c_ * tau * tau, -direction_ * 6.0 * c_ * tau};
}

JerkRamp::Motion JerkRamp::starting(double now_s, double when_s) const noexcept {
  if (known_) {
    const double now = now_s - t0_s_;
    const double then = back(0).t_s - t0_s_;
    // The same for a start.
    if (c_ * (now * now * now - then * then * then) > 1.0 + kOff) {
      return {};
    }
    const double theta = std::max(0.0, when_s - t0_s_);
    return {share_, direction_ * 3.0 * c_ * theta * theta, direction_ * 6.0 * c_ * theta};
  }
  // The way w to the first line is evenly distributed over 0 … w₁ = c·θ³, beyond which the next
  // line would have been passed.
  const double d = now_s - back(0).t_s;
  double theta = std::cbrt(1.0 / c_);
  if (d > 0.0) {
    const double root = (4.0 / (c_ * d) - d * d) / 12.0;
    // Since the next line has not been passed yet, θ is bounded from above.
    theta = std::min(theta, root > 0.0 ? std::sqrt(root) - 0.5 * d : -1.0);
  }
  if (theta < 0.0) {
    return {};
  }
  const double when = when_s - back(0).t_s;
  if (when < 0.0) {  // use the mean start
    const double mean = std::max(0.0, 0.75 * theta + when);
    return {share_, direction_ * 3.0 * c_ * mean * mean, direction_ * 6.0 * c_ * mean};
  }
  // Means over w even within 0 … c·θ³: of θ it is ¾·θ, of θ² 3/5·θ².
  return {share_, direction_ * 3.0 * c_ * (0.6 * theta * theta + 1.5 * when * theta + when * when),
          direction_ * 6.0 * c_ * (0.75 * theta + when)};
}

}  // namespace steadyrest::motion::online
