// SPDX-License-Identifier: Apache-2.0
// The report's contents in everyday units: each conversion once, by hand.
#include <utility>

#include <gtest/gtest.h>

#include <steadyrest/trial/cut/comparison.hpp>

namespace steadyrest::trial::cut {
namespace {

using kernel::machine::ContourStrategy;
using kernel::outcome::Reason;
using kernel::signal::Motion;

kernel::machine::Machine mill_of_the_report() {
  kernel::machine::Machine machine;
  machine.name = "mill";
  machine.contour.limit_mm = 0.012;
  machine.feed_override.ratio = {0.0, 0.75, 1.2};
  machine.feed_override.code = {7, 8, 9};
  for (const char* name : {"X", "Y", "Z"}) {
    kernel::machine::Axis axis;
    axis.name = name;
    machine.axes.push_back(axis);
  }
  return machine;
}

Recorder record_of(double error_mm) {
  Recorder record({.limit_mm = 0.012, .cycle_s = 0.5});
  Sample sample{.time_s = 0.5,
                .position_mm = {1.0, 2.0, 3.0},
                .path_position_mm = 7.0,
                .contour_error_mm = -error_mm,
                .tracking_error_mm = 0.25,
                .feed_ratio = 0.75,
                .path_speed_mm_s = 20.0,
                .line = 4,
                .motion = Motion::feed,
                .reason = Reason::contour_limit};
  record.add(sample);
  sample.time_s = 1.0;
  sample.motion = Motion::rapid;
  sample.reason = Reason::none;
  record.add(sample);
  return record;
}

ReportData compared(const kernel::machine::Machine& machine) {
  return compare("/some/folder/plate.ngc", machine, record_of(0.030), record_of(0.009));
}

TEST(Comparison, IsInMicrometresPercentAndMillimetresPerMinute) {
  const ReportData data = compared(mill_of_the_report());
  ASSERT_EQ(data.with.trace.size(), 2U);
  const TracePoint& point = data.with.trace[0];
  EXPECT_DOUBLE_EQ(point.contour_error_um, -9.0);
  EXPECT_DOUBLE_EQ(point.tracking_error_um, 250.0);
  EXPECT_DOUBLE_EQ(point.override_percent, 75.0);
  EXPECT_DOUBLE_EQ(point.feed_mm_min, 1200.0);
  EXPECT_EQ(point.path_mm, 7.0);
  EXPECT_EQ(point.position_mm, (kernel::signal::Point{1.0, 2.0, 3.0}));
  EXPECT_EQ(point.line, 4U);
  EXPECT_DOUBLE_EQ(data.limit_um, 12.0);
}

TEST(Comparison, TellsCuttingFromRapidMotion) {
  const ReportData data = compared(mill_of_the_report());
  EXPECT_TRUE(data.without.trace[0].cutting);
  EXPECT_FALSE(data.without.trace[1].cutting);
}

TEST(Comparison, KeepsTheTwoRunsApart) {
  const ReportData data = compared(mill_of_the_report());
  EXPECT_DOUBLE_EQ(data.without.figures.contour_error_max_mm, 0.030);
  EXPECT_DOUBLE_EQ(data.with.figures.contour_error_max_mm, 0.009);
  EXPECT_GT(data.without.figures.samples_over_limit, 0U);
  EXPECT_EQ(data.with.figures.samples_over_limit, 0U);
  // Half a second each for the limit and for nothing.
  double seconds = 0.0;
  for (const ReasonTime& time : data.with.reasons) {
    seconds += time.seconds;
    EXPECT_DOUBLE_EQ(time.seconds, 0.5);
  }
  EXPECT_DOUBLE_EQ(seconds, 1.0);
  EXPECT_FALSE(data.with.vibration) << "no cut was simulated";
}

// The name of the file alone: a report says nothing about the folders of who made it.
TEST(Comparison, NamesTheProgramTheMachineAndTheStrategy) {
  kernel::machine::Machine machine = mill_of_the_report();
  const std::pair<ContourStrategy, const char*> strategies[] = {
      {ContourStrategy::contour_priority, "contour priority"},
      {ContourStrategy::feed_priority, "feed priority"},
      {ContourStrategy::combined, "combined"}};
  for (const auto& [strategy, name] : strategies) {
    machine.contour.strategy = strategy;
    const ReportData data = compared(machine);
    EXPECT_EQ(data.program, "plate.ngc");
    EXPECT_EQ(data.machine, "mill");
    EXPECT_EQ(data.strategy, name);
  }
}

TEST(Comparison, ShowsTheOverrideTableWithOrWithoutCodes) {
  kernel::machine::Machine machine = mill_of_the_report();
  const ReportData coded = compared(machine);
  ASSERT_EQ(coded.override_table.size(), 3U);
  EXPECT_EQ(coded.override_table[1].code, 8U);
  EXPECT_DOUBLE_EQ(coded.override_table[2].percent, 120.0);
  machine.feed_override.code.clear();
  EXPECT_EQ(compared(machine).override_table[1].code, 0U);
}

// The program cannot be read: its worst lines are there, their texts empty.
TEST(Comparison, HasItsWorstLinesWithoutTheProgramsFile) {
  const ReportData data = compared(mill_of_the_report());
  ASSERT_EQ(data.worst_lines.size(), 1U);
  EXPECT_EQ(data.worst_lines[0].line, 4U);
  EXPECT_EQ(data.worst_lines[0].text, "");
  EXPECT_NEAR(data.worst_lines[0].without_um, -30.0, 1e-9);
  EXPECT_NEAR(data.worst_lines[0].with_um, -9.0, 1e-9);
}

}  // namespace
}  // namespace steadyrest::trial::cut
