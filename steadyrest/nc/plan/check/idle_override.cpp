// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include <steadyrest/nc/plan/check/idle_override.hpp>

namespace steadyrest::nc::plan {
namespace {

constexpr double kMostTime = 0.5;  ///< of the cut, without effect: worth a warning

/// One segment: the override begins to act at u/F.
struct Part {
  double ratio = 0.0;
  double seconds = 0.0;
  std::uint32_t line = 0;
};

}  // namespace

// The override acts on a segment once F·ratio is below the speed u that the segment reaches without
// it: below ratio = u/F. Axes, control and the stops between short moves may keep u far below F;
// then neither the switch nor the contour room's requests have any effect.
std::optional<Warning> idle_override(const PlannedPath& path,
                                     const kernel::machine::OverrideTable& table) {
  // The switch's next step below 100 %.
  double step = 0.0;
  for (const double ratio : table.ratio) {
    step = ratio < 1.0 ? std::max(step, ratio) : step;
  }
  std::vector<Part> parts;
  double all_s = 0.0;
  double idle_s = 0.0;
  double in_mm_s = 0.0;
  for (std::size_t i = 0; i < path.plans.size(); ++i) {
    const SegmentPlan& plan = path.plans[i];
    const double entry_mm_s = std::exchange(in_mm_s, plan.exit_speed_limit_mm_s);
    if (plan.rapid || plan.locked || plan.per_revolution || !(plan.feed_mm_s > 0.0)) {
      continue;
    }
    // Peak between the junction limits at the segment's own acceleration: v_p² = (v_in² + v_out²)/2
    // + a·ℓ. Neighbours may bind more, so this is an upper bound of u: the warning errs towards
    // silence.
    const double by_acceleration = std::sqrt(
        0.5 * (entry_mm_s * entry_mm_s + plan.exit_speed_limit_mm_s * plan.exit_speed_limit_mm_s) +
        plan.acceleration_mm_s2 * plan.length_mm);
    const double most_mm_s = std::min({plan.feed_mm_s, plan.speed_limit_mm_s, by_acceleration});
    if (!(most_mm_s > 0.0)) {
      continue;
    }
    const double seconds = plan.length_mm / most_mm_s;
    parts.push_back({most_mm_s / plan.feed_mm_s, seconds, path.segments[i].line});
    all_s += seconds;
    idle_s += parts.back().ratio <= step ? seconds : 0.0;
  }
  if (!(idle_s > kMostTime * all_s)) {
    return std::nullopt;
  }
  const auto first = std::ranges::find_if(parts, [step](const Part& p) { return p.ratio <= step; });
  const std::uint32_t line = first->line;
  // The weighted median: at this ratio the override acts on half of the cutting time.
  std::ranges::sort(parts, {}, &Part::ratio);
  double passed_s = 0.0;
  double acts = 0.0;  // for half of the cut
  for (const Part& part : parts) {
    acts = part.ratio;
    passed_s += part.seconds;
    if (passed_s >= 0.5 * all_s) {
      break;
    }
  }
  return Warning{
      line, fmt::format("the next step of the feed override, {:.3g} %, changes nothing for {:.0f} "
                        "% of the cut: the programmed feed is far above what the axes reach. It "
                        "begins to act at about {:.0f} %; program a feed the axes reach",
                        100.0 * step, 100.0 * idle_s / all_s, 100.0 * acts)};
}

}  // namespace steadyrest::nc::plan
