// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <cmath>

#include <steadyrest/nc/plan/time/look_ahead.hpp>

namespace steadyrest::nc::plan {
namespace {

constexpr double kSpindleReplan_ratio = 0.005;
constexpr double kNone = std::numeric_limits<double>::infinity();

}  // namespace

double target_mm_s(const SegmentPlan& p, const Overrides& overrides) noexcept {
  double v = p.feed_mm_s;
  if (p.per_revolution) {
    v *= std::abs(overrides.spindle_actual_rev_s);
  }
  if (p.rapid) {
    v *= overrides.rapid_ratio;
  } else if (!p.locked) {
    v *= overrides.feed_ratio;
  }
  return std::min(v, p.speed_limit_mm_s);
}

// The ring is a power of two, so that an index wraps by a mask.
LookAhead::LookAhead(std::size_t blocks, double period_s, double jerk_time_s)
    : blocks_(blocks),
      period_s_(period_s),
      jerk_time_s_(jerk_time_s),
      limits_(std::bit_ceil(blocks + 2)),
      mask_(limits_.size() - 1) {}

bool LookAhead::outdated(double spindle_rev_s) const noexcept {
  // 0.5 %, not every count of the spindle encoder: planning costs a pass over the window.
  const double drift = std::abs(spindle_rev_s - planned_spindle_rev_s_);
  return follows_spindle_ && drift > kSpindleReplan_ratio * std::abs(planned_spindle_rev_s_);
}

/// Computes the limit at the end of segment i from that of i + 1. True when it is unchanged.
bool LookAhead::plan_junction(const PathWindow& path, std::size_t i,
                              const Overrides& overrides) noexcept {
  const SegmentPlan& here = path.plan(i);
  const SegmentPlan& next = path.plan(i + 1);
  // One segment back from the end of i + 1 to the end of i: the flat part shrinks by the length of
  // i + 1, and before it v² may be higher by 2·a for each mm of braking.
  Limit limit = limits_[(i + 1) & mask_];
  const double gain = 2.0 * next.acceleration_mm_s2;
  limit.hold_mm -= next.length_mm;
  if (limit.hold_mm < 0.0) {
    limit.square -= gain * limit.hold_mm;
    limit.hold_mm = 0.0;
  }
  limit.cap_reach_mm -= next.length_mm;
  if (limit.cap_reach_mm < 0.0) {  // beyond its reach the cap is one more limit to brake for
    limit.square = std::min(limit.square, limit.cap_square - gain * limit.cap_reach_mm);
    limit.cap_reach_mm = 0.0;
    limit.cap_square = kNone;
  }
  // The targets of both neighbours bind here: the slower must be reached at the joint itself.
  const double c = std::min(
      {here.exit_speed_limit_mm_s, target_mm_s(here, overrides), target_mm_s(next, overrides)});
  const double reach = 0.5 * c * jerk_time_s_;
  if (c * c <= limit.square) {
    limit.square = c * c;
    limit.hold_mm = reach;
  } else if (jerk_time_s_ > 0.0 && c * c <= limit.cap_square) {
    // The braking curve is below c at the joint but may be above it within the reach before. The
    // average would then carry a speed above c through the joint, so c is kept as a second limit.
    limit.cap_square = c * c;
    limit.cap_reach_mm = reach;
  }
  limit.square = std::min(limit.square, limit.cap_square);
  Limit& stored = limits_[i & mask_];
  const bool same = stored.square == limit.square && stored.hold_mm == limit.hold_mm &&
                    stored.cap_square == limit.cap_square &&
                    stored.cap_reach_mm == limit.cap_reach_mm;
  stored = limit;
  return same;
}

// Nothing is known beyond the window, so its end counts as a stop. A short look-ahead therefore
// slows down rows of tiny blocks, as on real controls.
void LookAhead::plan_all(const PathWindow& path, std::size_t from,
                         const Overrides& overrides) noexcept {
  planned_spindle_rev_s_ = overrides.spindle_actual_rev_s;
  follows_spindle_ = false;
  end_ = std::min(from + blocks_, path.end);
  const std::size_t last = end_ - 1;
  limits_[last & mask_] = Limit{};
  follows_spindle_ = path.plan(last).per_revolution;
  for (std::size_t i = last; i-- > from;) {
    plan_junction(path, i, overrides);
    follows_spindle_ = follows_spindle_ || path.plan(i).per_revolution;
  }
}

/// The window slides: replans only what the new end changes.
void LookAhead::plan_more(const PathWindow& path, std::size_t from,
                          const Overrides& overrides) noexcept {
  const std::size_t end = std::min(from + blocks_, path.end);
  if (end <= end_) {
    return;
  }
  const std::size_t old_last = end_ - 1;
  const std::size_t last = end - 1;
  end_ = end;
  limits_[last & mask_] = Limit{};
  for (std::size_t i = last; i-- > from;) {
    follows_spindle_ = follows_spindle_ || path.plan(i + 1).per_revolution;
    // Each limit depends only on its successor: an unchanged one leaves all before it unchanged.
    // Those after old_last are new and have no old value to compare with.
    if (plan_junction(path, i, overrides) && i < old_last) {
      break;
    }
  }
}

// The largest v' after this cycle from which the limit ahead can still be met. The cycle covers (v
// + v')·T/2, the plateau v'·plateau_s, the rest is braking at a. With q = plateau_s + T/2:
// v'² + 2·a·q·v' ≤ w + 2·a·(room − v·T/2), so v' = √((a·q)² + w + 2·a·(room − v·T/2)) − a·q.
// √w itself is always allowed: at that speed there is nothing to brake for.
LookAhead::Bound LookAhead::bound(const PathWindow& path, const Lead& lead, double want_mm_s,
                                  double plateau_s) const noexcept {
  const double v = lead.speed_mm_s;
  const double half = 0.5 * period_s_;
  const double q = plateau_s + half;
  double best = want_mm_s;
  double braking = path.plan(lead.segment).acceleration_mm_s2;
  double left = path.plan(lead.segment).length_mm - lead.distance_mm;
  for (std::size_t k = lead.segment;;) {
    const Limit& limit = limits_[k & mask_];
    const double a = path.plan(k).acceleration_mm_s2;
    // v'² ≤ w + 2a·(room − v·T/2 − v'·q); within the hold, w itself.
    const auto fit = [&](double w, double room) {
      if (best * best > w + 2.0 * a * (room - v * half - best * q)) {
        const double discriminant = a * q * a * q + w + 2.0 * a * (room - v * half);
        const double brake = discriminant > 0.0 ? std::sqrt(discriminant) - a * q : 0.0;
        best = std::min(best, std::max(brake, std::sqrt(w)));
      }
    };
    fit(limit.square, left - limit.hold_mm);
    if (limit.cap_square < kNone) {
      fit(limit.cap_square, left - limit.cap_reach_mm);
    }
    // The cycle ends within segment k: w_k already covers everything beyond it.
    if (v * half + std::max(best, v - braking * period_s_) * q <= left) {
      break;
    }
    // The end of k lies within the cycle, where v² falls in a straight line to w: the constant
    // deceleration (v² − w)/(2·left) over one period.
    if (v * v > limit.square && left > kEndTolerance_mm) {  // falling through the end of k
      best = std::min(best, std::max(0.0, v + half * (limit.square - v * v) / left));
    }
    if (++k >= end_) {
      break;
    }
    left += path.plan(k).length_mm;
    braking = std::max(braking, path.plan(k).acceleration_mm_s2);
  }
  return {best, braking};
}

}  // namespace steadyrest::nc::plan
