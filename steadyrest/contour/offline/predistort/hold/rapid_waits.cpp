// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <steadyrest/contour/offline/predistort/hold/rapid_waits.hpp>

namespace steadyrest::contour::offline {
namespace {

using kernel::signal::Motion;

constexpr double kAimedShare = 0.8;  ///< of the limit
constexpr int kTries = 4;
constexpr double kWonLittle = 0.7;    ///< of the error: a wait that leaves more is taken back
constexpr double kWaitStep_s = 0.01;  ///< as it is written
constexpr double kLongestWait_s = 2.0;
constexpr double kAt_mm = 1e-6;
constexpr double kFirst = 0.35;  ///< in 1/k: the cut has hardly begun

}  // namespace

RapidWaits::RapidWaits(const nc::plan::PlannedPath& path, const std::vector<SegmentUse>& use,
                       double limit_mm, double gain_1_s)
    : limit_mm_(limit_mm), gain_1_s_(gain_1_s) {
  bool behind = false;
  bool open = false;
  for (std::size_t i = 0; i < use.size(); ++i) {
    const auto& segment = path.segments[i];
    const bool rapid = segment.motion == Motion::rapid;
    if (behind && !rapid && use[i].free && !path.plans[i].per_revolution) {
      starts_.push_back({.line = segment.line, .from_mm = segment.position_mm});
      open = true;
    }
    open = open && !rapid;
    if (open) {
      starts_.back().to_mm = segment.position_mm + segment.length_mm;
    }
    behind = rapid;
  }
}

bool RapidWaits::adjust(const std::vector<ErrorPlace>& over) {
  std::vector<double> worst_mm(starts_.size(), 0.0);
  for (const ErrorPlace& place : over) {
    if (place.since_s > kFirst / gain_1_s_) {
      continue;  // of what the cut itself does
    }
    const auto after =
        std::ranges::upper_bound(starts_, place.progress_mm + kAt_mm, {}, &Start::from_mm);
    if (after != starts_.begin() && place.progress_mm <= std::prev(after)->to_mm) {
      double& worst = worst_mm[static_cast<std::size_t>(after - starts_.begin()) - 1];
      worst = std::max(worst, place.error_mm);
    }
  }
  bool changes = false;
  for (std::size_t i = 0; i < starts_.size(); ++i) {
    Start& start = starts_[i];
    const double error_mm = worst_mm[i];
    if (start.settled || error_mm <= limit_mm_) {
      start.settled = true;
      continue;
    }
    changes = true;
    const bool won = start.wait_s == 0.0 || error_mm <= kWonLittle * start.error_mm;
    start.in_vain = won ? 0 : start.in_vain + 1;
    if (start.in_vain == kTries) {
      start.wait_s = 0.0;
      start.settled = true;
      continue;
    }
    start.error_mm = error_mm;
    // Hidden by another wait, say for the spindle, it may have to be much longer.
    const double more_s =
        std::log(error_mm / (kAimedShare * limit_mm_)) / gain_1_s_ * std::pow(2.0, start.in_vain);
    start.wait_s =
        std::min(kLongestWait_s, kWaitStep_s * std::ceil((start.wait_s + more_s) / kWaitStep_s));
    start.settled = start.wait_s >= kLongestWait_s;
  }
  return changes;
}

Waits RapidWaits::waits() const {
  Waits out;
  for (const Start& start : starts_) {
    if (start.wait_s > 0.0) {
      out.emplace(start.line, start.wait_s);
    }
  }
  return out;
}

}  // namespace steadyrest::contour::offline
