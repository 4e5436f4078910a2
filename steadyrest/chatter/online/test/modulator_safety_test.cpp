// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdint>

#include <gtest/gtest.h>

#include <steadyrest/chatter/online/test/modulator_hunt.hpp>

namespace steadyrest::chatter::online::test {
namespace {

struct Minute {
  double greatest_feed_per_tooth = 0.0;  ///< over the programmed one
  double lowest_speed_ratio = 1.0;
};

/// Runs a law: both overrides are scanned and act a dead time later, the spindle's later than the
/// feed's.
Minute minute_of(const Modulation& modulation) {
  constexpr double kFrame_s = 0.002;
  constexpr double kProgrammed_rev_s = 50.0;
  Modulator::Config c;
  c.modulation = modulation;
  c.spindle_table = kernel::override::test::spindle_840d();
  c.spindle_table.layer_may_exceed_panel = true;
  c.spindle_table.scan_period_s = 0.012;
  // The worst case for the coupling: a feed that rises at once meets a speed still on its way.
  c.spindle_table.dead_time_s = 0.060;
  c.feed_table = kernel::override::test::feed_840d();
  c.feed_table.scan_period_s = 0.012;
  c.max_feed_per_tooth_ratio = 1.05;
  auto modulator = Modulator::make(c).value();
  HuntedOverride spindle({.table = c.spindle_table, .fall_1_s = 10.0, .rise_1_s = 10.0}, false);
  HuntedOverride feed({.table = c.feed_table, .fall_1_s = 10.0, .rise_1_s = 10.0}, false);
  kernel::signal::Frame frame;
  frame.motion = kernel::signal::Motion::feed;
  frame.speed_modulation = true;
  frame.programmed_feed_mm_s = 10.0;
  frame.spindle_programmed_rev_s = kProgrammed_rev_s;
  Minute out;
  for (double t = kFrame_s; t < 60.0; t += kFrame_s) {
    frame.time_s = t;
    frame.spindle.effective_ratio = spindle.in_force(t);
    frame.spindle_actual_rev_s = kProgrammed_rev_s * frame.spindle.effective_ratio;
    frame.feed.effective_ratio = feed.in_force(t);
    frame.path_speed_mm_s = 10.0 * frame.feed.effective_ratio;
    out.greatest_feed_per_tooth = std::max(
        out.greatest_feed_per_tooth, frame.feed.effective_ratio / frame.spindle.effective_ratio);
    out.lowest_speed_ratio = std::min(out.lowest_speed_ratio, frame.spindle.effective_ratio);
    const auto asked =
        modulator.update(frame, {.feed = feed.told(), .spindle = spindle.told(), .written = true});
    spindle.drive(t, asked.spindle, frame.spindle, kernel::outcome::Reason::none, false);
    feed.drive(t, asked.feed, frame.feed, kernel::outcome::Reason::none, false);
  }
  return out;
}

// Random laws, since they turn unpredictably; a slow one must still move, or the bound would hold
// for a constant spindle.
TEST(ModulatorSafety, TheFeedDoesNotRiseWhileALowerSpeedIsStillOnItsWay) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    for (const double period_s : {0.4, 1.0, 3.0}) {
      const Minute seen = minute_of(
          {.law = Law::random, .amplitude_ratio = 0.2, .period_s = period_s, .seed = seed});
      EXPECT_LE(seen.greatest_feed_per_tooth, 1.05 + 1e-9)
          << "seed " << seed << ", period " << period_s;
      EXPECT_LE(seen.lowest_speed_ratio, period_s > 2.0 ? 0.9 + 1e-9 : 1.0) << "it is constant";
    }
  }
}

TEST(ModulatorSafety, NoChangeOfParametersLeavesTheLimitsOrMakesAnUnsafeWord) {
  // The same with 10⁹ changes: bench/chatter/modulator_hunt.
  const Hunt found = hunt(1, 400'000);
  EXPECT_EQ(found.outside, 0U) << found.first;
  EXPECT_EQ(found.phase_jumps, 0U) << found.first;
  EXPECT_EQ(found.speed_jumps, 0U) << found.first;
  EXPECT_EQ(found.feed_per_tooth, 0U) << found.first;
  EXPECT_EQ(found.invalid_codes, 0U) << found.first;
  EXPECT_EQ(found.words_outside, 0U) << found.first;
  // A hunt that finds nothing because nothing happened proves nothing.
  EXPECT_GT(found.wishes, found.changes / 4) << "too little of it modulates";
  EXPECT_GT(found.words, found.changes / 20) << "too few words change";
}

}  // namespace
}  // namespace steadyrest::chatter::online::test
