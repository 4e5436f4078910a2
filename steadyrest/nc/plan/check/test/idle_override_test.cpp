// SPDX-License-Identifier: Apache-2.0
// When a step of the feed override changes nothing, on segments of known speed.
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/nc/plan/check/idle_override.hpp>

namespace steadyrest::nc::plan {
namespace {

using testing::HasSubstr;

/// Segments of 10 mm that run at `reached` under a feed of 100 mm/s and never slow down in between.
PlannedPath reaching(const std::vector<double>& reached_mm_s) {
  PlannedPath path;
  for (const double mm_s : reached_mm_s) {
    SegmentPlan plan{.length_mm = 10.0,
                     .acceleration_mm_s2 = 1e6,
                     .feed_mm_s = 100.0,
                     .speed_limit_mm_s = mm_s,
                     .exit_speed_limit_mm_s = mm_s};
    path.plans.push_back(plan);
    path.segments.emplace_back();
    path.segments.back().line = static_cast<std::uint32_t>(10 * path.plans.size());
  }
  return path;
}

kernel::machine::OverrideTable switch_of(std::vector<double> ratio) {
  kernel::machine::OverrideTable table;
  table.ratio = std::move(ratio);
  return table;
}

const auto kSwitch = switch_of({0.0, 0.5, 0.9, 1.0, 1.2});

// The next step below 100 % is 90 %: it acts on a segment that reaches 91 mm/s of 100, not on one
// that reaches 90.
TEST(IdleOverride, BeginsWhereTheNextStepIsNotFelt) {
  EXPECT_FALSE(idle_override(reaching({91.0}), kSwitch));
  EXPECT_TRUE(idle_override(reaching({90.0}), kSwitch));
  EXPECT_FALSE(idle_override(reaching({90.0}), switch_of({0.5, 0.85, 1.0}))) << "85 % acts";
}

// Weighted by time, not by number: 10 mm at 20 mm/s last as long as four at 80.
TEST(IdleOverride, CountsTheTimeAndNotTheMoves) {
  const auto felt = switch_of({0.3, 1.0});
  EXPECT_FALSE(idle_override(reaching({20.0, 80.0, 80.0, 80.0, 80.0}), felt)) << "just half of it";
  EXPECT_TRUE(idle_override(reaching({19.9, 80.0, 80.0, 80.0, 80.0}), felt));
}

// 0.5 s each at 20 % of the feed, 0.17 s at 60 %, 0.1 s at 95 %: half of the cut is at 20 %.
TEST(IdleOverride, NamesTheFirstLineTheShareAndWhereItBeginsToAct) {
  const auto warning = idle_override(reaching({95.0, 20.0, 20.0, 60.0}), switch_of({0.7, 1.0}));
  ASSERT_TRUE(warning);
  EXPECT_EQ(warning->line, 20U);
  // 10/95 of felt time against 10/20 + 10/20 + 10/60 of idle time: 91.7 %.
  EXPECT_THAT(warning->text, HasSubstr("override, 70 %, changes nothing for 92 % of the cut"));
  EXPECT_THAT(warning->text, HasSubstr("begins to act at about 20 %"));
}

// Only moves whose feed the switch scales count.
TEST(IdleOverride, LooksAtFeedMovesAlone) {
  for (bool SegmentPlan::* kind :
       {&SegmentPlan::rapid, &SegmentPlan::locked, &SegmentPlan::per_revolution}) {
    auto path = reaching({10.0});
    path.plans[0].*kind = true;
    EXPECT_FALSE(idle_override(path, kSwitch));
  }
  auto still = reaching({10.0});
  still.plans[0].feed_mm_s = 0.0;
  EXPECT_FALSE(idle_override(still, kSwitch));
  EXPECT_FALSE(idle_override({}, kSwitch));
}

// From a stop to a stop over 10 mm at 250 mm/s² a segment reaches √(250·10) = 50 mm/s; with one
// end open at 60 mm/s √(60²/2 + 2500) = 65.6. The junction belongs to both its neighbours.
TEST(IdleOverride, AShortMoveReachesWhatItsAccelerationAllows) {
  const auto at = [](double step, double exit_mm_s) {
    auto path = reaching({100.0});
    path.plans[0].acceleration_mm_s2 = 250.0;
    path.plans[0].exit_speed_limit_mm_s = exit_mm_s;
    return idle_override(path, switch_of({step, 1.0})).has_value();
  };
  EXPECT_TRUE(at(0.51, 0.0));
  EXPECT_FALSE(at(0.49, 0.0));
  EXPECT_TRUE(at(0.66, 60.0));
  EXPECT_FALSE(at(0.65, 60.0));
  auto two = reaching({100.0, 100.0});
  two.plans[0].exit_speed_limit_mm_s = 60.0;
  two.plans[1].acceleration_mm_s2 = 250.0;
  two.plans[1].exit_speed_limit_mm_s = 0.0;
  two.plans[0].rapid = true;
  EXPECT_TRUE(idle_override(two, switch_of({0.66, 1.0}))) << "entered at the rapid's 60 mm/s";
  EXPECT_FALSE(idle_override(two, switch_of({0.65, 1.0})));
}

}  // namespace
}  // namespace steadyrest::nc::plan
