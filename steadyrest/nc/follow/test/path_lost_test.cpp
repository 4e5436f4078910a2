// SPDX-License-Identifier: Apache-2.0
// Where the place is not certain, none is told.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/kernel/file/testing/own_folder.hpp>
#include <steadyrest/nc/follow/test/driven.hpp>

namespace steadyrest::nc::follow {
namespace {

using test::driven;
using test::Frame;
using test::kHead;
using test::planned;
using test::Step;
using test::told;

std::size_t on_path(const std::vector<Step>& steps) {
  return static_cast<std::size_t>(std::ranges::count_if(
      steps, [](const Step& step) { return step.seen.place == Place::on_path; }));
}

TEST(PathLost, NoPlaceWithoutARoute) {
  PathLocator locator;
  Frame frame;
  frame.program = kernel::signal::ProgramState::running;
  EXPECT_EQ(locator.update(frame).place, Place::no_route);
  const Route empty({});
  locator.follow(&empty);
  EXPECT_EQ(locator.update(frame).place, Place::no_route);
}

TEST(PathLost, BlocksByHandAreNoProgram) {
  const auto path = planned(kHead + "G1 X40 F4000\nY20\nM2\n");
  const Route route(path.segments);
  const auto steps = driven(path, route, [](std::size_t, Frame& frame) {
    frame.program = kernel::signal::ProgramState::stopped;
    return 1.0;
  });
  EXPECT_EQ(on_path(steps), 0U);
  EXPECT_EQ(steps.back().seen.place, Place::no_program);
}

TEST(PathLost, AnotherProgramIsNotFollowed) {
  const Route route(planned(kHead + "G1 X40 F4000\nY20\nX0\nM2\n").segments);
  const auto other = planned(kHead + "G1 X30 Y10 F4000\nX35 Y21\nX5 Y25\nX1 Y2\nM2\n");
  EXPECT_EQ(on_path(driven(other, route)), 0U);
}

// The first lines are the same: the place is told until the texts part, and not after.
TEST(PathLost, LeavesWhereAnEditedProgramLeavesIt) {
  const Route route(planned(kHead + "G1 X40 F4000\nY20\nX0\nY0\nM2\n").segments);
  const auto edited = planned(kHead + "G1 X40 F4000\nY19\nX0\nY-3\nM2\n");
  bool right = true;
  for (const Step& step : driven(edited, route)) {
    const double y = step.truth.position[1];
    const double x = step.truth.position[0];
    if (step.seen.place == Place::on_path) {
      // On the old path: y = 0, x = 40 or x = 0.
      right = right && (std::abs(y) < 0.02 || std::abs(x - 40.0) < 0.02 || std::abs(x) < 0.02);
    }
  }
  EXPECT_TRUE(right);
}

/// The layer comes while the program runs.
std::vector<Step> joined(const plan::PlannedPath& path, const Route& route, std::size_t at) {
  const auto machine = test::mill();
  auto interpolator = plan::Interpolator::make(machine, plan::whole(path)).value();
  PathLocator locator;
  locator.follow(&route);
  std::vector<Step> steps;
  for (std::size_t i = 0; i < 100000; ++i) {
    const auto setpoint = interpolator.update({});
    if (setpoint.finished) {
      break;
    }
    if (i >= at) {
      steps.push_back({setpoint, locator.update(test::frame_of(setpoint, i))});
    }
  }
  return steps;
}

TEST(PathLost, JoinsARunningProgramWhereItsPlaceIsTheOnlyOne) {
  const auto path = planned(kHead + "G1 X40 F4000\nY20\nX0\nY0\nM2\n");
  const auto steps = joined(path, Route(path.segments), 300);
  EXPECT_LE(told(steps).worst_mm, 1e-6);
  EXPECT_GE(told(steps).cycles + 20, told(steps).moving);
}

// Five equal passes: which one it is cannot be known before the path goes elsewhere.
TEST(PathLost, DoesNotGuessThePassOfALoop) {
  const auto path = planned(kHead +
                            "o1 repeat [5]\nG1 X20 F4000\nY20\nX0\nY0\no1 endrepeat\n"
                            "G1 X-10\nY-20\nM2\n");
  const auto steps = joined(path, Route(path.segments), 2000);
  const auto result = told(steps);
  EXPECT_LE(result.worst_mm, 1e-6);
  EXPECT_GT(result.cycles, 200U) << "after the loop";
  for (const Step& step : steps) {
    if (step.seen.place == Place::on_path) {
      EXPECT_TRUE(step.truth.position[0] < 0.1 || step.truth.line >= 8) << step.truth.line;
    }
  }
}

// A program that is started at a line does that line from where the machine stands.
TEST(PathLost, RestartFromALineIsFoundWhereItMeetsThePath) {
  const Route route(planned(kHead + "G1 X40 F4000\nY20\nX0\nY0\nM2\n").segments);
  // Line 3 from (30, 5): along the path's line 3 it is 10 mm away; line 4 is met at its full
  // length.
  interpret::Config config;
  config.dialect = read::Dialect::linuxcnc;
  config.axes = "XYZ";
  config.start = {30.0, 5.0};
  const auto restart = plan::plan_text("\n" + kHead + "G1 Y20 F4000\nX0\nY0\nM2\n", config,
                                       test::mill(), "restart.ngc")
                           .value();
  const auto steps = driven(restart, route);
  std::size_t seen = 0;
  for (const Step& step : steps) {
    if (step.seen.place == Place::on_path) {
      ++seen;
      const auto& at = step.truth.position;
      // 40 + 20 + 40 + 20 mm.
      const double expected = at[1] > 19.99 ? 60.0 + (40.0 - at[0]) : 100.0 + (20.0 - at[1]);
      EXPECT_NEAR(step.seen.position_mm, expected, 0.02);
    }
  }
  EXPECT_GT(seen, 700U);
}

/// A route planned from (0, 0) as `text` says, with its marks.
Route marked(const std::string& text) {
  const kernel::file::testing::OwnFolder folder;
  std::ofstream(folder.at("part.ngc")) << text;
  interpret::Config config;
  config.dialect = read::Dialect::linuxcnc;
  config.axes = "XYZ";
  const auto path = plan::plan_file_from_start(folder.at("part.ngc"), config, test::mill()).value();
  std::vector<bool> from_start;
  for (const plan::SegmentPlan& segment : path.plans) {
    from_start.push_back(segment.from_start);
  }
  return Route(path.segments, from_start);
}

/// Where the same text brings the axes from another start.
plan::PlannedPath begun_at(double x_mm, double y_mm, const std::string& text) {
  interpret::Config config;
  config.dialect = read::Dialect::linuxcnc;
  config.axes = "XYZ";
  config.start = {x_mm, y_mm};
  return plan::plan_text(text, config, test::mill(), "part.ngc").value();
}

const std::string kRelative =
    "G21 G91 G94 G17 G61\nG1 X40 F4000\nY20\nX-40\nY20\nX40\nY20\nX-40\nM2\n";

TEST(PathLost, ARelativeProgramIsFollowedFromItsStart) {
  const auto steps = driven(begun_at(0.0, 0.0, kRelative), marked(kRelative));
  EXPECT_LE(told(steps).worst_mm, 1e-6);
  EXPECT_GE(told(steps).cycles + 20, told(steps).moving);
}

// The control shows that the program runs when the axes have moved by some hundredths.
TEST(PathLost, ARelativeProgramThatIsShownLateIsFollowedFromItsStart) {
  std::size_t late = 0;
  const auto steps =
      driven(begun_at(0.0, 0.0, kRelative), marked(kRelative), [&](std::size_t i, Frame& frame) {
        const bool shown = i > 15;
        late += !shown && frame.axis[0].command_mm > 0.05 ? 1 : 0;
        frame.program = shown ? frame.program : test::ProgramState::stopped;
        return 1.0;
      });
  EXPECT_GT(late, 1U);
  EXPECT_LE(told(steps).worst_mm, 1e-6);
  EXPECT_GE(told(steps).cycles + 40, told(steps).moving);
}

// A frame that is not finite does not show that the axes stand.
TEST(PathLost, WhereTheAxesPassedInAnUnfitFrameTheyDidNotStand) {
  const auto path = begun_at(0.0, 0.0, kRelative);
  const Route route = marked(kRelative);
  const auto machine = test::mill();
  auto interpolator = plan::Interpolator::make(machine, plan::whole(path)).value();
  PathLocator locator;
  locator.follow(&route);
  for (const double x : {-1.0, 0.0, std::numeric_limits<double>::quiet_NaN(), 1.0}) {
    Frame moving;
    moving.program = kernel::signal::ProgramState::stopped;
    moving.axis[0].command_mm = x;
    (void)locator.update(moving);
  }
  for (std::size_t i = 0; i < 400; ++i) {
    const auto seen = locator.update(test::frame_of(interpolator.update({}), i));
    ASSERT_NE(seen.place, Place::on_path) << i;
  }
}

// Its third leg runs along the first of the route: a place there would be wrong.
TEST(PathLost, ARelativeProgramThatBeganElsewhereIsNot) {
  const auto steps = driven(begun_at(0.0, -20.0, kRelative), marked(kRelative));
  EXPECT_EQ(on_path(steps), 0U);
  EXPECT_TRUE(std::ranges::any_of(
      steps, [](const Step& step) { return step.seen.place == Place::start_unseen; }));
}

TEST(PathLost, ARelativeProgramIsNotJoined) {
  EXPECT_EQ(on_path(joined(begun_at(0.0, 0.0, kRelative), marked(kRelative), 300)), 0U);
}

// X40 and Y20 begin where Y was at the start; X0 does not.
TEST(PathLost, AnAbsoluteProgramIsFoundFromWhereItIsAbsolute) {
  const std::string text = kHead + "G1 X40 F4000\nY20\nX0\nY0\nM2\n";
  const auto steps = driven(begun_at(0.0, 7.0, text), marked(text));
  std::size_t absolute = 0;
  for (const Step& step : steps) {
    absolute += step.truth.line >= 4 && step.truth.path_speed_mm_s > 0.0 ? 1U : 0U;
    if (step.seen.place == Place::on_path) {
      EXPECT_GE(step.truth.line, 4U);
      const auto& at = step.truth.position;
      const double expected = step.truth.line == 4 ? 60.0 + (40.0 - at[0]) : 100.0 + (20.0 - at[1]);
      EXPECT_NEAR(step.seen.position_mm, expected, 0.02);
    }
  }
  EXPECT_GT(on_path(steps) + 30, absolute);
}

// Three equal squares, started at the second one's first line from where the first begins.
TEST(PathLost, StartedAtALineItIsNotTakenForTheFirstPass) {
  const std::string square = "G1 X10 F3000\nY10\nX0\nY0\n";
  const Route route(planned(kHead + square + square + square + "M2\n").segments);
  const auto second = planned("\n\n\n\n" + kHead + square + square + "M2\n");
  for (const Step& step : driven(second, route)) {
    if (step.seen.place == Place::on_path) {
      EXPECT_NEAR(step.seen.position_mm, 40.0 + step.truth.path_position_mm, 0.02);
    }
  }
}

// It touches at X30 of 100: what follows goes on from there.
TEST(PathLost, AProbingMoveEndsWhereItTouched) {
  const std::string probing = "G38.2 X100 F1500\nG91\nG1 X20 F1500\nY10\nM2\n";
  const Route route = marked(kHead + "G0 X0 Y0\n" + probing);
  auto real = planned(kHead + "G0 X0 Y0\n" + "G38.2 X30 F1500\nG91\nG1 X20 F1500\nY10\nM2\n");
  for (const Step& step : driven(real, route)) {
    if (step.truth.position[0] > 30.0 || step.truth.position[1] > 0.0) {
      EXPECT_NE(step.seen.place, Place::on_path) << step.truth.position[0];
    }
  }
}

TEST(PathLost, AnAbortEndsItAndTheNextRunIsFoundAgain) {
  const auto path = planned(kHead + "G1 X40 F4000\nY20\nX0\nM2\n");
  const Route route(path.segments);
  const auto machine = test::mill();
  PathLocator locator;
  locator.follow(&route);
  for (int run = 0; run < 2; ++run) {
    auto interpolator = plan::Interpolator::make(machine, plan::whole(path)).value();
    PathLocator::Output found;
    for (std::size_t i = 0; i < 400; ++i) {
      found = locator.update(test::frame_of(interpolator.update({}), i));
    }
    EXPECT_EQ(found.place, Place::on_path);
    Frame stopped;
    stopped.program = kernel::signal::ProgramState::stopped;
    EXPECT_EQ(locator.update(stopped).place, Place::no_program);
  }
}

// The end of each pass and the beginning of the next are one straight line: line 8 merges with line
// 4 of the next pass, which then has no segment of its own. LinuxCNC shows line 4 there.
TEST(PathLost, ALoopWhosePassesMergeIsNotTakenForItsFirst) {
  const auto path = planned(
      "G21 G90 G94 G17 G64 P0.01\nG0 X0 Y0\no1 repeat [3]\nG1 X20 F1500\nY10\nX-5\nY0\nG1 X8\n"
      "o1 endrepeat\nG1 Y-10\nM2\n");
  const auto steps = driven(path, Route(path.segments), [](std::size_t, Frame& frame) {
    const bool merged = frame.program_line == 8 && frame.path_speed_mm_s > 0.0;
    frame.program_line = merged ? 4 : frame.program_line;
    return 1.0;
  });
  EXPECT_LE(told(steps).worst_mm, 0.05);
  // The last pass has no merged block, so there the line shown is wrong, and the place is given up.
  EXPECT_GE(told(steps).cycles + 400, told(steps).moving);
}

TEST(PathLost, HostileFramesFindNothingAndBreakNothing) {
  const auto path = planned(kHead + "G1 X40 F4000\nY20\nX0\nM2\n");
  const Route route(path.segments);
  const double bad[] = {std::numeric_limits<double>::quiet_NaN(),
                        std::numeric_limits<double>::infinity(), -1e300, 1e300};
  const auto steps = driven(path, route, [&](std::size_t i, Frame& frame) {
    if (i % 50 == 7) {
      frame.axis[i % 3].command_mm = bad[(i / 50) % 4];
    }
    if (i % 50 == 17) {
      frame.path_speed_mm_s = bad[(i / 50) % 4];
    }
    if (i % 50 == 27) {
      frame.time_s = bad[(i / 50) % 4];
    }
    if (i % 50 == 37) {
      frame.axis_count = 255;
      frame.program_line = 0xffffffff;
    }
    return 1.0;
  });
  EXPECT_LE(told(steps).worst_mm, 0.01);
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (i % 50 == 7) {
      EXPECT_NE(steps[i].seen.place, Place::on_path) << i;
    }
  }
}

}  // namespace
}  // namespace steadyrest::nc::follow
