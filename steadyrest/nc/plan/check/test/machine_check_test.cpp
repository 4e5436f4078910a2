// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <vector>

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/nc/interpret/program.hpp>
#include <steadyrest/nc/plan/check/idle_override.hpp>
#include <steadyrest/nc/plan/check/machine_check.hpp>
#include <steadyrest/nc/plan/path/path_builder.hpp>

namespace steadyrest::nc::plan {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// Travel X 0 … 600, Y 0 … 400, Z −300 … 0; X and Y 12 m/min, Z 6; spindle 100 … 8000 rev/min.
kernel::machine::Machine limited_mill() {
  kernel::machine::Machine out;
  const auto axis = [](const char* name, double min_mm, double max_mm, double speed_mm_min) {
    kernel::machine::Axis one;
    one.name = name;
    one.min_au = min_mm;
    one.max_au = max_mm;
    one.max_speed_au_s = speed_mm_min / 60.0;
    one.max_acceleration_au_s2 = 1000.0;
    return one;
  };
  out.axes = {axis("X", 0, 600, 12000), axis("Y", 0, 400, 12000), axis("Z", -300, 0, 6000)};
  out.spindle.min_rev_s = 100.0 / 60.0;
  out.spindle.max_rev_s = 8000.0 / 60.0;
  out.feed_override.ratio = {0.5, 0.9, 1.0};
  out.feed_override.code = {0, 1, 2};
  return out;
}

void run(const std::string& text, interpret::Sink& sink, const interpret::Config& config = {}) {
  const auto report = interpret::run_text(text, config, sink);
  ASSERT_TRUE(report) << report.error().what;
  ASSERT_THAT(report->refused, IsEmpty());
}

/// `LINE: text` of each warning; where the work offset is known, it is 0.
std::vector<std::string> warned(const std::string& text, const Known& known = {}) {
  const auto machine = limited_mill();
  MachineCheck check(machine, known);
  run(text, check);
  std::vector<std::string> out;
  for (const Warning& w : check.warnings()) {
    out.push_back(fmt::format("{}: {}", w.line, w.text));
  }
  EXPECT_EQ(check.count(), out.size());
  return out;
}

constexpr Known kAll{.offsets = true, .tools = true};
const std::string kHead = "G21 G90 G17 G94\nS1000 M3\nG0 X10 Y10 Z-10\n";

TEST(MachineCheck, SaysNothingOfAProgramThatFits) {
  // Inclusive ends: the largest legal values must not warn.
  EXPECT_THAT(warned(kHead + "G1 X600 Y400 Z-300 F6000\nG0 Z0\nM5\nM2\n", kAll), IsEmpty());
}

TEST(MachineCheck, NamesTheLineThatLeavesTheTravel) {
  EXPECT_THAT(
      warned(kHead + "G1 X601 F1000\nX10\nG0 Y-1\nG0 Z5\nM2\n", kAll),
      ElementsAre(HasSubstr("4: the move takes X to 601.000 mm, outside its travel 0 … 600"),
                  HasSubstr("6: a rapid takes Y to -1.000 mm"),
                  HasSubstr("7: a rapid takes Z to 5.000 mm")));
  // The arc's ends are inside, its bulge is not.
  EXPECT_THAT(warned(kHead + "G1 X590 Y200 F1000\nG2 X590 Y100 I0 J-50\nM2\n", kAll),
              ElementsAre(HasSubstr("5: the move takes X to 640.000 mm")));
  // G53 is in machine coordinates whatever the offset.
  EXPECT_THAT(warned(kHead + "G53 G0 X-5\nM2\n", kAll),
              ElementsAre(HasSubstr("4: a rapid takes X")));
}

TEST(MachineCheck, TurnsWithTheWorkCoordinates) {
  // G54 at X500 Y100, turned by 30°: X100 is at 586.6 mm, X120 at 603.9; X0 Y-120 at 560, −3.9.
  // Without the rotation X120 would come out at 620 mm and Y-120 at −20.
  const std::string head =
      "G21 G90 G17 G94 G54\nG10 L2 P1 X500 Y100 Z-100 R30\nS1000 M3\nG0 X10 Y10 Z-10\n";
  EXPECT_THAT(warned(head + "G1 X100 Y0 F1000\nX120\nG0 X0 Y-120\nM2\n", kAll),
              ElementsAre(HasSubstr("6: the move takes X to 603.923 mm"),
                          HasSubstr("7: a rapid takes Y to -3.923 mm")));
}

TEST(MachineCheck, ArcsReachAsFarAsTheyDoWhereTheWorkCoordinatesTurn) {
  // G18, radius 50 about X40 Z-20, first by X-10, then by X90: 77.9 mm of the machine's X and 45 of
  // its Y from the zero.
  const std::string head =
      "G21 G90 G17 G94 G54\nG10 L2 P1 X{} Y{} Z-100 R30\nS1000 M3\nG0 X40 Y0 Z30\nG18 ";
  const auto half = [&](double x_mm, double y_mm) {
    return warned(fmt::format(fmt::runtime(head), x_mm, y_mm) +
                      "G2 X40 Z-70 I0 K-50 F1000\nG2 X40 Z30 I0 K50\nM2\n",
                  kAll);
  };
  EXPECT_THAT(half(522.0, 100.0), IsEmpty());
  EXPECT_THAT(half(522.2, 100.0), ElementsAre(HasSubstr("6: the move takes X to 600.142 mm")));
  EXPECT_THAT(half(100.0, 354.9), IsEmpty());
  EXPECT_THAT(half(100.0, 355.1), ElementsAre(HasSubstr("6: the move takes Y to 400.100 mm")));
}

TEST(MachineCheck, OfASplineTheCurveCounts) {
  // Control points at X602, outside the travel; the curve reaches 590 + 0.75·12 = 599 mm.
  const std::string curve = "G5 I{0} J5 P{0} Q-5 X590 Y40 F500\nM2\n";
  const std::string head = kHead + "G1 X590 F1000\n";
  EXPECT_THAT(warned(head + fmt::format(fmt::runtime(curve), 12), kAll), IsEmpty());
  EXPECT_THAT(warned(head + fmt::format(fmt::runtime(curve), 14), kAll),
              ElementsAre(HasSubstr("5: the move takes X to 600.500 mm")));
}

TEST(MachineCheck, ReadsInches) {
  // 23.6 in = 599.44 mm fits, 23.63 in = 600.202 mm does not; 473 in/min = 12014.2 mm/min.
  EXPECT_THAT(
      warned("G20 G90 G17 G94\nS1000 M3\nG0 X1 Y1 Z-1\nG1 X23.6 F472\nX23.63 F473\nM2\n", kAll),
      ElementsAre(HasSubstr("5: the move takes X to 600.202 mm"),
                  HasSubstr("5: the feed of 12014.2 mm/min")));
}

TEST(MachineCheck, KnowsByTheExtentWhatNoOffsetCanMend) {
  EXPECT_THAT(warned(kHead + "G1 X-300 F1000\nX290\nM2\n"), IsEmpty()) << "590 mm fits somewhere";
  EXPECT_THAT(warned(kHead + "G1 X-300 F1000\nX310\nX320\nM2\n"),
              ElementsAre(HasSubstr("5: the program covers 620.000 mm of X, from -300.000 to "
                                    "320.000 mm; its travel is only 600 mm")));
  EXPECT_THAT(warned(kHead + "G1 X20 F1000\nG0 X900\nM2\n"),
              ElementsAre(HasSubstr("5: the program covers 880.000 mm of X")));
  // A rapid in machine coordinates says nothing about the work offset and needs none.
  EXPECT_THAT(warned(kHead + "G1 X20 F1000\nG53 G0 X601 Z0\nX10\nM2\n"),
              ElementsAre(HasSubstr("5: a rapid takes X to 601.000 mm")));
  EXPECT_THAT(warned(kHead + "G1 X-300 F1000\nG53 G0 X600 Z0\nM2\n"), IsEmpty());
}

TEST(MachineCheck, DoesNotJudgeZWithAToolOfUnknownLength) {
  const std::string text = kHead + "T1 M6\nS1000 M3\nG0 Z-301\nM2\n";
  EXPECT_THAT(warned(text, {.offsets = true, .tools = false}), IsEmpty());
  EXPECT_THAT(warned(text, kAll), ElementsAre(HasSubstr("6: a rapid takes Z")));
}

TEST(MachineCheck, KnowsWhatTheAxesCanDo) {
  // Z alone does 6000 mm/min; the same modal F stays legal on X, so only the Z move warns.
  EXPECT_THAT(
      warned(kHead + "G1 X100 F12000\nZ-20\nX50\nM2\n"),
      ElementsAre(HasSubstr("5: the feed of 12000 mm/min is more than the axes can do here, "
                            "6000 mm/min")));
  EXPECT_THAT(warned(kHead + "G1 X100 Y100 F16000\nX50 F20000\nX20\nM2\n"),
              ElementsAre(HasSubstr("5: the feed of 20000 mm/min")))
      << "16.9 m/min along the diagonal is 12 on either axis";
  EXPECT_THAT(warned(kHead + "G1 X100 F1000000\nX50\nX20 F1000\nX10 F1000000\nM2\n"),
              ElementsAre(HasSubstr("4: the feed of 1000000 mm/min")))
      << "F is modal: one warning for each new one";
}

TEST(MachineCheck, KnowsWhatTheSpindleCanDo) {
  EXPECT_THAT(warned("G21 G90\nS9000 M3\nG1 X10 F100\nS50 M4\nX20\nM2\n"),
              ElementsAre(HasSubstr("2: S9000 is outside the spindle's 100 … 8000 rev/min"),
                          HasSubstr("4: S50 is outside")));
}

TEST(MachineCheck, NamesACutWithoutASpindle) {
  EXPECT_THAT(
      warned("G21 G90\nG0 X5\nG1 X10 F100\nX20\nS1000 M3\nX30\nM5\nX40\nM2\n"),
      ElementsAre(HasSubstr("3: cuts with the spindle stopped"), HasSubstr("8: cuts with")));
  EXPECT_THAT(warned("G21 G90\nM3\nG1 X10 F100\nM2\n"), ElementsAre(HasSubstr("3: cuts with")));
}

TEST(MachineCheck, CountsWhatItDoesNotKeep) {
  std::string text = kHead + "F1000\n";
  for (int i = 0; i < 1500; ++i) {
    text += fmt::format("G1 X{}\n", 700 + i);
  }
  const auto machine = limited_mill();
  MachineCheck check(machine, kAll);
  run(text + "M2\n", check);
  // The number shown is bounded, the count is not.
  EXPECT_EQ(check.warnings().size(), MachineCheck::kMost);
  EXPECT_EQ(check.count(), 1500U);
}

std::optional<Warning> idle(const std::string& text) {
  const auto machine = limited_mill();
  PathBuilder builder(machine);
  run(text, builder);
  const auto path = builder.take();
  EXPECT_TRUE(path);
  return path ? idle_override(*path, machine.feed_override) : std::nullopt;
}

TEST(IdleOverride, SaysWhenTheNextStepChangesNothing) {
  // F60000 is 1000 mm/s and the axes do 200: the override acts only below 20 %.
  const auto far = idle(kHead + "G1 X500 F60000\nX10\nM2\n");
  ASSERT_TRUE(far);
  EXPECT_EQ(far->line, 4U);
  EXPECT_THAT(
      far->text,
      HasSubstr("next step of the feed override, 90 %, changes nothing for 100 % of the cut"));
  EXPECT_THAT(far->text, HasSubstr("begins to act at about 20 %"));
  // 1 mm lines under exact stop: the axes never reach 6 m/min.
  // From stop to stop over 1 mm at 1000 mm/s² the peak is √(1·1000) = 31.6 mm/s, 32 % of F6000.
  std::string stairs = kHead + "G61.1\nF6000\n";
  for (int i = 0; i < 50; ++i) {
    stairs += fmt::format("G1 X{}\nY{}\n", 11 + i, 11 + i);
  }
  EXPECT_TRUE(idle(stairs + "M2\n"));
  EXPECT_FALSE(idle(kHead + "G1 X500 F3000\nX10\nM2\n"));
  EXPECT_FALSE(idle(kHead + "G1 X500 F12500\nX10\nM2\n")) << "at 90 % it acts";
  // The feed override does not act on rapids.
  EXPECT_FALSE(idle(kHead + "G0 X500\nM2\n"));
}

/// What is said of lines of 0.1 mm at F3000: 2 ms each.
std::vector<Warning> of_short_blocks(double block_time_s, double min_block_cycles = 0.0) {
  auto machine = limited_mill();
  machine.control.dialect = kernel::machine::Dialect::fanuc;
  machine.control.block_time_s = block_time_s;
  machine.control.min_block_cycles = min_block_cycles;
  MachineCheck check(machine, kAll);
  interpret::Config config;
  config.dialect = kernel::machine::Dialect::fanuc;
  run("G21 G90 S1000 M3\nG1 X1 F3000\nX1.1\nX1.2\nM30\n", check, config);
  return check.warnings();
}

TEST(MachineCheck, NamesTheFirstBlockThatTheControlIsTooSlowFor) {
  EXPECT_THAT(of_short_blocks(0.001), IsEmpty());
  const auto slow = of_short_blocks(0.004);
  ASSERT_EQ(slow.size(), 1U);
  EXPECT_EQ(slow[0].line, 3U);
  EXPECT_EQ(slow[0].text,
            "0.1 mm at 3000 mm/min take 2 ms, less than a block takes on the control (4 ms): it "
            "slows to 1500 mm/min");
}

TEST(MachineCheck, AssumesTheWorstOfAControlWhoseBlockTimeIsNotKnown) {
  const auto unknown = of_short_blocks(kernel::machine::kUnlimited);
  ASSERT_EQ(unknown.size(), 1U);
  EXPECT_THAT(unknown[0].text,
              HasSubstr("(20 ms): it slows to 300 mm/min; that time is not known"));
  // Periods say it, too.
  EXPECT_THAT(of_short_blocks(kernel::machine::kUnlimited, 1.0), IsEmpty());
}

TEST(MachineCheck, WarnsOfSmallArcsThatLinuxCncsPlannerWithLimitedJerkOverdoes) {
  const auto said = [](const std::string& mode, kernel::machine::LinuxCncPlanner planner) {
    auto machine = limited_mill();
    machine.control.planner = planner;
    MachineCheck check(machine, kAll);
    run("G21 G90 S1000 M3 " + mode + "\nG1 X10 Y20 F600\nG3 X18 I4 J0\nG1 X20\nM2\n", check);
    return check.warnings();
  };
  using kernel::machine::LinuxCncPlanner;
  const auto warned = said("G64 P0.1", LinuxCncPlanner::s_curve);
  ASSERT_EQ(warned.size(), 1U);
  EXPECT_EQ(warned[0].line, 3U);
  EXPECT_THAT(warned[0].text, HasSubstr("an arc of 4 mm under G64 P0.1"));
  EXPECT_THAT(said("G61", LinuxCncPlanner::s_curve), IsEmpty());
  EXPECT_THAT(said("G64 P0.1", LinuxCncPlanner::trapezoid), IsEmpty());
}

}  // namespace
}  // namespace steadyrest::nc::plan
