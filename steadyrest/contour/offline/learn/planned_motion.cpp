// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <steadyrest/contour/offline/learn/planned_motion.hpp>
#include <steadyrest/math/geometry/vector.hpp>

namespace steadyrest::contour::offline {
namespace {

using kernel::signal::Point;

constexpr double kSame_mm = 1e-5;

struct Between {
  std::size_t index = 0;  ///< of the point at or before
  double share = 0.0;
};

/// `next`: the first of the ascending places beyond.
Between between(const std::vector<double>& at, std::ptrdiff_t next, double place) noexcept {
  if (next <= 0) {
    return {};
  }
  const auto i = static_cast<std::size_t>(next);
  if (i >= at.size()) {
    return {at.size() - 1, 0.0};
  }
  const double span = at[i] - at[i - 1];
  return {i - 1, span > 0.0 ? std::clamp((place - at[i - 1]) / span, 0.0, 1.0) : 0.0};
}

double value(const std::vector<double>& of, const Between& at) noexcept {
  const std::size_t next = std::min(at.index + 1, of.size() - 1);
  return of[at.index] + at.share * (of[next] - of[at.index]);
}

}  // namespace

void PlannedMotion::add(const ModelSample& sample) {
  if (!position_mm_.empty() && sample.position_mm < position_mm_.back()) {
    return;
  }
  position_mm_.push_back(sample.position_mm);
  time_s_.push_back(sample.time_s);
  speed_mm_s_.push_back(sample.command_mm_s);
  // At the outer side of a corner many tools have the corner as their foot: the first counts.
  if (sample.cuts && (foot_mm_.empty() || sample.foot_mm > foot_mm_.back() + kSame_mm)) {
    foot_mm_.push_back(sample.foot_mm);
    off_mm_.push_back(sample.off_mm);
  }
}

PlannedMotion::Stay PlannedMotion::stay(double position_mm) const noexcept {
  if (position_mm_.empty()) {
    return {};
  }
  const double low = position_mm - kSame_mm;
  const double high = position_mm + kSame_mm;
  const auto first = std::ranges::lower_bound(position_mm_, low) - position_mm_.begin();
  const auto last = std::ranges::upper_bound(position_mm_, high) - position_mm_.begin();
  return {.from_s = value(time_s_, between(position_mm_, first, low)),
          .to_s = value(time_s_, between(position_mm_, last, high))};
}

double PlannedMotion::speed_mm_s(double position_mm) const noexcept {
  if (position_mm_.empty()) {
    return 0.0;
  }
  const auto next = std::ranges::upper_bound(position_mm_, position_mm) - position_mm_.begin();
  return value(speed_mm_s_, between(position_mm_, next, position_mm));
}

Point PlannedMotion::off_mm(double foot_mm) const noexcept {
  if (foot_mm_.empty()) {
    return {};
  }
  const auto next = std::ranges::upper_bound(foot_mm_, foot_mm) - foot_mm_.begin();
  const Between at = between(foot_mm_, next, foot_mm);
  const Point& a = off_mm_[at.index];
  const Point& b = off_mm_[std::min(at.index + 1, off_mm_.size() - 1)];
  return math::geometry::add_scaled(a, math::geometry::subtract(b, a), at.share);
}

}  // namespace steadyrest::contour::offline
