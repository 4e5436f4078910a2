// SPDX-License-Identifier: Apache-2.0
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/nc/interpret/program.hpp>
#include <steadyrest/nc/plan/test/moves.hpp>
#include <steadyrest/nc/plan/time/program_timer.hpp>
#include <steadyrest/nc/plan/time/segment_timer.hpp>

namespace steadyrest::nc::plan {
namespace {

constexpr std::string_view kDay = R"(G21 G90 G94
T1 M6
S3000 M3
G0 X0 Y0 Z5
G1 Z-1 F300
X100 F1200
M8
Y80
G3 X60 Y120 I-40 J0
G4 P2.5
S6000
G1 X0 F2400
G0 Z50
M5 M9
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
    EXPECT_NEAR(b.path_mm, a.path_mm, 0.1);
    EXPECT_EQ(b.coolant, a.coolant);
    sum_s += b.seconds;
  }
  EXPECT_NEAR(sum_s, by_segment->total_s, 1e-9) << "without gaps";
}

struct Flow {
  std::string_view what;
  read::Dialect dialect;
  std::string_view program;
  std::vector<bool> coolant;  ///< of the transitions with the spindle turning
};

// From the controls' manuals: M7 and M8 switch on, M9 switches off. On LinuxCNC mist and flood may
// run together, and M9 switches both off; saved modes (M70, M72) restore the coolant.
TEST(Cyclogram, CoolantBeginsATransitionInEveryDialect) {
  using read::Dialect;
  const std::vector<Flow> flows = {
      {"flood",
       Dialect::linuxcnc,
       "G21 G90\nS3000 M3\nG1 X50 F1200\nM8\nX0\nM9\nX50\nM2\n",
       {false, true, false}},
      {"mist and flood",
       Dialect::linuxcnc,
       "G21 G90\nS3000 M3\nM7\nG1 X50 F1200\nM8\nX0\nM9\nX50\nM2\n",
       {true, false}},
      {"a tool later it is another matter",
       Dialect::linuxcnc,
       "G21 G90\nT1 M6\nS3000 M3 M8\nG1 X50 F1200\nM9\nM5\nT2 M6\nS3000 M3\nG1 X0\nM2\n",
       {true, false}},
      {"kept modes",
       Dialect::linuxcnc,
       "G21 G90\nS3000 M3 M8\nG1 X50 F1200\nM70\nM9\nX0\nM72\nX50\nM2\n",
       {true, false, true}},
      {"fanuc",
       Dialect::fanuc,
       "%\nO0001\nG21 G90 G94\nS3000 M03 M08\nG01 X50. F1200.\nM09\nX0.\nM30\n%\n",
       {true, false}},
      {"sinumerik",
       Dialect::sinumerik,
       "G710 G90 G94\nS3000 M3\nG1 X50 F1200 M8\nX0\nM9\nG1 X50\nM30\n",
       {true, false}},
  };
  const kernel::machine::Machine machine = test::mill();
  for (const Flow& flow : flows) {
    SCOPED_TRACE(flow.what);
    auto stepped = ProgramTimer::make(machine).value();
    auto closed = SegmentTimer::make(machine).value();
    for (interpret::Sink* const timer :
         {static_cast<interpret::Sink*>(&stepped), static_cast<interpret::Sink*>(&closed)}) {
      interpret::Config config;
      config.dialect = flow.dialect;
      const auto report = interpret::run_text(flow.program, config, *timer);
      ASSERT_TRUE(report && report->refused.empty());
    }
    const auto flows_in = [](const std::vector<Transition>& cyclogram) {
      std::vector<bool> out;
      for (const Transition& t : cyclogram) {
        if (t.load() == Load::cutting) {
          out.push_back(t.coolant);
        }
      }
      return out;
    };
    EXPECT_EQ(flows_in(stepped.take().value().cyclogram), flow.coolant);
    EXPECT_EQ(flows_in(closed.take_cyclogram().value().cyclogram), flow.coolant);
  }
}

}  // namespace
}  // namespace steadyrest::nc::plan
