// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <steadyrest/nc/interpret/program.hpp>
#include <steadyrest/nc/plan/program_timer.hpp>
#include <steadyrest/nc/plan/segment_timer.hpp>
#include <steadyrest/nc/plan/test/moves.hpp>

namespace steadyrest::nc::plan {
namespace {

constexpr std::string_view kDay = R"(G21 G90 G94
T1 M6
S3000 M3
G0 X0 Y0 Z5
G1 Z-1 F300
X100 F1200
Y80
G3 X60 Y120 I-40 J0
G4 P2.5
S6000
G1 X0 F2400
G0 Z50
M5
T2 M6
S1500 M4
G0 X10 Y10
G95 G1 Z-2 F0.2
X90
G94
M30
)";

// The truth is the interpolator, period by period.
TEST(SegmentTimer, FindsTheCyclogramOfTheInterpolator) {
  const kernel::machine::Machine machine = test::mill();
  auto stepped = ProgramTimer::make(machine);
  auto closed = SegmentTimer::make(machine);
  ASSERT_TRUE(stepped && closed);
  ASSERT_TRUE(interpret::run_text(kDay, {}, *stepped));
  ASSERT_TRUE(interpret::run_text(kDay, {}, *closed));
  const auto by_period = stepped->take();
  const auto by_segment = closed->take_cyclogram();
  ASSERT_TRUE(by_period && by_segment);
  EXPECT_NEAR(by_segment->total_s, by_period->total_s, 0.02);
  ASSERT_EQ(by_segment->cyclogram.size(), by_period->cyclogram.size());
  EXPECT_GE(by_period->cyclogram.size(), 5U);
  double sum_s = 0.0;
  for (std::size_t i = 0; i < by_period->cyclogram.size(); ++i) {
    const Transition& a = by_period->cyclogram[i];
    const Transition& b = by_segment->cyclogram[i];
    SCOPED_TRACE(i);
    EXPECT_EQ(b.tool, a.tool);
    EXPECT_EQ(b.speed_rev_s, a.speed_rev_s);
    EXPECT_EQ(b.line, a.line);
    EXPECT_EQ(b.load(), a.load());
    EXPECT_NEAR(b.start_s, a.start_s, 0.02);
    EXPECT_NEAR(b.seconds, a.seconds, 0.02);
    EXPECT_NEAR(b.cut_s, a.cut_s, 0.02);
    EXPECT_NEAR(b.cut_mm, a.cut_mm, 0.05);
    sum_s += b.seconds;
  }
  EXPECT_NEAR(sum_s, by_segment->total_s, 1e-9) << "without gaps";
}

}  // namespace
}  // namespace steadyrest::nc::plan
