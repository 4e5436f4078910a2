// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <steadyrest/apps/live_page/heat/corrections.hpp>

namespace steadyrest::apps::live_page {
namespace {

constexpr double kOneMove_s = 2.0;
constexpr double kRounding_mm = 1e-9;

}  // namespace

Correction* Corrections::still_moving(std::size_t axis, double time_s, double change_mm) {
  const auto last = std::find_if(list_.rbegin(), list_.rend(),
                                 [axis](const Correction& of) { return of.axis == axis; });
  const bool same = last != list_.rend() && time_s - last->to_s < kOneMove_s &&
                    (last->to_mm - last->from_mm) * change_mm > 0.0;
  return same ? &*last : nullptr;
}

void Corrections::see(double time_s, const kernel::signal::AxisValues& offset_mm,
                      std::size_t axes) {
  for (std::size_t i = 0; i < std::min(axes, offset_mm.size()); ++i) {
    const double away_mm = offset_mm[i] - listed_mm_[i];
    const double steps = std::floor((std::abs(away_mm) + kRounding_mm) / kStep_mm);
    if (!(steps >= 1.0)) {
      continue;
    }
    const double change_mm = std::copysign(steps * kStep_mm, away_mm);
    const double to_mm = listed_mm_[i] + change_mm;
    if (Correction* const last = still_moving(i, time_s, change_mm)) {
      last->to_s = time_s;
      last->to_mm = to_mm;
    } else {
      list_.push_back(
          {.from_s = time_s, .to_s = time_s, .axis = i, .from_mm = listed_mm_[i], .to_mm = to_mm});
    }
    listed_mm_[i] = to_mm;
    if (list_.size() > kMost) {
      list_.pop_front();
    }
  }
}

}  // namespace steadyrest::apps::live_page
