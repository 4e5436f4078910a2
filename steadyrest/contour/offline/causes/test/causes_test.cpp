// SPDX-License-Identifier: Apache-2.0
// Why a line is over the limit, and what cures it. Truth: the same program with the cure written
// into its text, planned and run afresh.
#include <algorithm>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/contour/offline/causes/causes.hpp>
#include <steadyrest/contour/offline/test/ideal_mill.hpp>

namespace steadyrest::contour::offline {
namespace {

using testing::HasSubstr;

constexpr double kLimit_mm = 0.01;

/// A program and what it leaves.
struct Foretold {
  explicit Foretold(const std::string& moves, double gain_1_s = 30.0)
      : machine(test::ideal_mill(gain_1_s)), path(test::planned_moves(machine, moves)) {
    const PathMap map = same_path(path);
    const OverTask task{
        .machine = machine, .path = path, .original = path, .map = map, .limit_mm = kLimit_mm};
    over = lines_over(task, 8).value();
    const auto runs = line_runs(task).value();
    for (const auto& [line, run] : runs) {
      seconds += run.seconds;
      largest_mm = std::max(largest_mm, run.error_mm);
    }
  }
  kernel::machine::Machine machine;
  nc::plan::PlannedPath path;
  std::vector<OverLine> over;
  double seconds = 0.0;
  double largest_mm = 0.0;
};

// Along Y the rapid's lag in X leaves a mark; a dwell lets it run out.
TEST(Causes, ARapidIsCuredByADwell) {
  const std::string rapid = "G0 X0 Y0\nG0 X60\n";
  const Foretold now(rapid + "G1 Y60 F1200\n");
  ASSERT_EQ(now.over.size(), 1U);
  const OverLine& line = now.over.front();
  EXPECT_EQ(line.line, 4U);
  EXPECT_THAT(line.reason, HasSubstr("the rapid before it"));
  ASSERT_FALSE(line.cures.empty());
  const Cure& cure = line.cures.front();
  EXPECT_TRUE(cure.holds(kLimit_mm));
  const std::string words = " before line 4";
  ASSERT_THAT(cure.what, HasSubstr("G4 P"));
  ASSERT_THAT(cure.what, testing::EndsWith(words));
  const Foretold cured(rapid + cure.what.substr(0, cure.what.size() - words.size()) +
                       "\nG1 Y60 F1200\n");
  EXPECT_TRUE(cured.over.empty());
  EXPECT_NEAR(cured.largest_mm, cure.leaves_mm, 1e-3);
  EXPECT_NEAR(cured.seconds - now.seconds, cure.seconds, 0.03);
}

TEST(Causes, AnArcIsCuredByTheFeedThatTheClosedFormGives) {
  const std::string start = "G0 X8 Y0\nG4 P1\n";
  const Foretold now(start + "G3 X8 Y0 I-8 J0 F2400\n");
  ASSERT_EQ(now.over.size(), 1U);
  EXPECT_THAT(now.over.front().reason, HasSubstr("arc of 8 mm"));
  ASSERT_FALSE(now.over.front().cures.empty());
  const Cure& cure = now.over.front().cures.front();
  ASSERT_TRUE(cure.holds(kLimit_mm));
  // v²/(2Rk²) = 10 µm at 12 mm/s: F720.
  const std::string feed = cure.what.substr(0, cure.what.find(' '));
  EXPECT_GT(std::stod(feed.substr(1)), 600.0);
  EXPECT_LE(std::stod(feed.substr(1)), 730.0);
  EXPECT_THAT(cure.what, HasSubstr(" on line 4"));
  const Foretold cured(start + "G3 X8 Y0 I-8 J0 " + feed + "\n");
  EXPECT_TRUE(cured.over.empty());
  EXPECT_NEAR(cured.largest_mm, cure.leaves_mm, 1e-3);
  EXPECT_NEAR(cured.seconds - now.seconds, cure.seconds, 0.05);
}

// A stop at a corner lets the tool arrive: nothing is cut off it.
TEST(Causes, ACornerIsNamedWithItsAngleAndCuredByAStop) {
  const std::string before = "G0 X0 Y0\nG4 P1\nG1 X30 F1800\n";
  const Foretold now(before + "G1 X45 Y25.980762\n", 20.0);
  ASSERT_FALSE(now.over.empty());
  EXPECT_THAT(now.over.front().reason, HasSubstr("corner of 60° at the end of line 4"));
  ASSERT_FALSE(now.over.front().cures.empty());
  const Cure& cure = now.over.front().cures.front();
  EXPECT_TRUE(cure.holds(kLimit_mm));
  ASSERT_THAT(cure.what, HasSubstr("G4 P"));
  const std::string dwell = cure.what.substr(0, cure.what.find(" before"));
  const Foretold cured(before + dwell + "\nG1 X45 Y25.980762\n", 20.0);
  EXPECT_TRUE(cured.over.empty());
  EXPECT_NEAR(cured.seconds - now.seconds, cure.seconds, 0.05);
}

TEST(Causes, ALineThatMustStaySaysWhy) {
  const Foretold run("G0 X8 Y0\nG4 P1\nG3 X8 Y0 I-8 J0 F2400\n");
  const PathMap map = same_path(run.path);
  const auto over = lines_over({.machine = run.machine,
                                .path = run.path,
                                .original = run.path,
                                .map = map,
                                .limit_mm = kLimit_mm,
                                .kept = [](std::uint32_t) { return "it is in a loop"; }},
                               0);
  ASSERT_TRUE(over && over->size() == 1U);
  EXPECT_THAT(over->front().reason, HasSubstr("; unchanged, because it is in a loop"));
  EXPECT_TRUE(over->front().cures.empty()) << "none was asked for";
}

TEST(Causes, UnequalLagsAreTheReasonOnALine) {
  kernel::machine::Machine machine = test::ideal_mill(50.0);
  machine.axes[1].servo_gain_1_s = 40.0;
  const auto path = test::planned_moves(machine, "G0 X0 Y0\nG4 P1\nG1 X40 Y30 F3000\n");
  const PathMap map = same_path(path);
  const auto over = lines_over(
      {.machine = machine, .path = path, .original = path, .map = map, .limit_mm = kLimit_mm}, 0);
  ASSERT_TRUE(over && over->size() == 1U);
  EXPECT_THAT(over->front().reason, HasSubstr("the axes lag differently, by 20.0 to 25.0 ms"));
  // v·(1/k₁ − 1/k₂)·cos·sin of the direction
  EXPECT_NEAR(over->front().error_mm, 50.0 * 0.005 * 0.8 * 0.6, 1e-3);
}

}  // namespace
}  // namespace steadyrest::contour::offline
