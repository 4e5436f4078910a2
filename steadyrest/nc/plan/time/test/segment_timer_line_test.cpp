// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include <steadyrest/nc/plan/test/moves.hpp>
#include <steadyrest/nc/plan/time/segment_timer.hpp>

// The truth is the closed form of a single line.
namespace steadyrest::nc::plan {
namespace {

using interpret::EventKind;
using kernel::machine::Machine;
using test::mill;
using test::Program;

double closed_s(const Machine& m, const Program& p) {
  auto timer = SegmentTimer::make(m).value();
  for (const auto& move : p.moves) {
    timer.on_move(move);
  }
  timer.on_event({EventKind::end, 99, 0.0});
  return timer.take().value();
}

TEST(SegmentTimer, ALineTakesItsLengthOverTheSpeedAndTheSpeedOverTheAcceleration) {
  const auto m = mill();  // 200 mm/s, 2000 mm/s²
  // From a feed with negligible ramps to one where they take a tenth of the time.
  for (const double feed : {0.5, 10.0, 50.0, 150.0}) {
    // L/V + V/A, from stop to stop; the end is rounded up to a period.
    Program p;
    p.line(100, 0, feed);
    const double law_s = 100.0 / feed + feed / 2000.0;
    EXPECT_GE(closed_s(m, p), law_s - 1e-6);
    EXPECT_LE(closed_s(m, p), law_s + 0.001);  // it ends on a period
  }
  Program triangle;
  triangle.line(2, 0, 150.0);
  // 2 mm are too short for 150 mm/s: up and down in 2·√(L/A).
  EXPECT_NEAR(closed_s(m, triangle), 2.0 * std::sqrt(2.0 / 2000.0), 0.001);
}

TEST(SegmentTimer, WithAJerkLimitALineTakesAccelerationOverJerkBesides) {
  const auto m = mill(50000.0);
  Program p;
  p.line(100, 0, 50.0);
  // The average over A/J adds its length: the textbook S-curve.
  EXPECT_NEAR(closed_s(m, p), 100.0 / 50.0 + 50.0 / 2000.0 + 2000.0 / 50000.0, 0.003);
}

TEST(SegmentTimer, RefusesWhatThePlannerRefusesAndWhatNeverEnds) {
  const auto m = mill();
  auto without_feed = SegmentTimer::make(m).value();
  Program p;
  p.line(10, 0, 0.0);
  without_feed.on_move(p.moves[0]);
  EXPECT_FALSE(without_feed.take().has_value());

  auto endless = SegmentTimer::make(m).value();
  Program slow;
  slow.line(1000, 0, 1e-4);
  // 1000 mm at 1e-4 mm/s are 116 days.
  endless.on_move(slow.moves[0]);
  const auto refused = endless.take();
  ASSERT_FALSE(refused.has_value());
  EXPECT_NE(refused.error().what.find("30 days"), std::string::npos);

  auto blind = m;
  blind.control.look_ahead_blocks = 0;
  EXPECT_FALSE(SegmentTimer::make(blind).has_value());
}

}  // namespace
}  // namespace steadyrest::nc::plan
