// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <random>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <steadyrest/kernel/rt/testing/allocation_guard.hpp>
#include <steadyrest/nc/follow/test/driven.hpp>

namespace steadyrest::nc::follow {
namespace {

using test::driven;
using test::Frame;
using test::kHead;
using test::planned;
using test::told;

/// Where a path goes back on itself, both ways are equally near.
constexpr double kAtTurn_mm = 0.002;

void expect_followed(
    const std::string& text, double worst_mm,
    const std::function<double(std::size_t, Frame&)>& change = [](std::size_t, Frame&) {
      return 1.0;
    }) {
  const auto path = planned(text);
  const Route route(path.segments);
  const auto result = told(driven(path, route, change));
  EXPECT_LE(result.worst_mm, worst_mm);
  // What it needs to be sure: a tenth of a millimetre.
  EXPECT_GE(result.cycles + 40, result.moving) << text;
  EXPECT_GT(result.moving, 100U);
}

TEST(PathLocator, FollowsLinesArcsAndCorners) {
  expect_followed(kHead + "G0 X5 Z2\nG1 Z0 F3000\nX40\nG3 X40 Y20 J10\nG1 X0\nY0\nG0 Z2\nM2\n",
                  1e-6);
}

TEST(PathLocator, TurnsWithAPathThatGoesBackOnItself) {
  expect_followed(kHead + "G1 X10 F3000\nX0\nX10\nX2\nX9\nZ-5\nZ0\nZ-5\nZ0\nG4 P0.1\nX0\nM2\n",
                  kAtTurn_mm);
}

TEST(PathLocator, KnowsTheTurnOfACircle) {
  expect_followed(kHead + "G1 X10 F4000\nG3 X10 I-10 P6\nG3 X10 I-10 Z-3 P4\nG1 X0\nM2\n", 1e-6);
}

TEST(PathLocator, KnowsThePassOfALoop) {
  const std::string text = kHead +
                           "G1 X1 F3000\no1 repeat [5]\nG1 X10\nY10\nX0\nY0\no1 endrepeat\n"
                           "G1 Z-2\no2 repeat [3]\nX10\nX0\no2 endrepeat\nM2\n";
  expect_followed(text, kAtTurn_mm);
}

TEST(PathLocator, GoesThroughSubprograms) {
  expect_followed("o10 sub\nG1 X#1 F3000\nY#2\nX0 Y0\no10 endsub\n" + kHead +
                      "G1 Z-1 F2000\no10 call [5] [6]\nG1 Z-2\no10 call [5] [6]\no10 call [8] [9]\n"
                      "G1 Z5\nM2\n",
                  kAtTurn_mm);
}

TEST(PathLocator, IsNotMisledByOverridesAndPauses) {
  const std::string text = kHead + "G1 X20 F4000\nG2 X20 I-10 P3\nG1 Y20\nX0\nM2\n";
  expect_followed(text, kAtTurn_mm, [](std::size_t i, Frame& frame) {
    if (i % 700 > 500) {
      frame.program = kernel::signal::ProgramState::paused;
      return 0.0;
    }
    return 0.2 + 0.8 * std::abs(std::sin(0.01 * static_cast<double>(i)));
  });
}

TEST(PathLocator, TakesTheOffsetInForceFromThePosition) {
  expect_followed(kHead + "G1 X20 F4000\nY20\nX0\nM2\n", 1e-6, [](std::size_t i, Frame& frame) {
    frame.axis[1].offset_mm = 0.05 * std::sin(0.01 * static_cast<double>(i));
    frame.axis[1].command_mm += frame.axis[1].offset_mm;
    return 1.0;
  });
}

TEST(PathLocator, BridgesLostSamples) {
  const auto path = planned(kHead + "G1 X50 F6000\nY50\nG3 X50 Y50 I-10 P2\nG1 X0\nM2\n");
  const Route route(path.segments);
  const auto machine = test::mill();
  auto interpolator = plan::Interpolator::make(machine, plan::whole(path)).value();
  PathLocator locator;
  locator.follow(&route);
  std::size_t seen = 0;
  for (std::size_t i = 0; i < 5000; ++i) {
    const auto setpoint = interpolator.update({});
    if (setpoint.finished) {
      break;
    }
    if (i % 100 > 60) {
      continue;
    }
    const auto found = locator.update(test::frame_of(setpoint, i));
    if (found.place == Place::on_path && setpoint.path_speed_mm_s > 0.0) {
      EXPECT_NEAR(found.position_mm, setpoint.path_position_mm, 1e-3) << i;
      ++seen;
    }
  }
  EXPECT_GT(seen, 500U);
}

/// Lines and arcs over each other on a grid of 1 mm, so that most places are passed several times.
std::string random_program(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto pick = [&](int most) {
    return static_cast<int>(random() % static_cast<std::uint64_t>(most));
  };
  std::string text = fmt::format("G21 G90 G94 G17 {}\n", seed % 2 == 0 ? "G61" : "G64 P0.01");
  int x = 0;
  int y = 0;
  const int passes = 1 + pick(3);
  text += fmt::format("F{}\no1 repeat [{}]\nG0 X0 Y0 Z0\n", 500 + 100 * pick(60), passes);
  for (int i = 0; i < 12; ++i) {
    const int nx = pick(6);
    const int ny = pick(6);
    if (nx == x && ny == y) {
      text += fmt::format("G3 X{} Y{} I-1 P{}\n", x, y, 1 + pick(3));
    } else {
      text += fmt::format("G{} X{} Y{} Z{}\n", pick(5) == 0 ? 0 : 1, nx, ny, -pick(2));
    }
    x = nx;
    y = ny;
  }
  return text + "o1 endrepeat\nM2\n";
}

TEST(PathLocator, FindsItsWayThroughRandomPrograms) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    const auto path = planned(random_program(seed));
    if (path.segments.empty()) {
      continue;
    }
    const Route route(path.segments);
    const auto result = told(driven(path, route));
    EXPECT_LE(result.worst_mm, 0.01) << "seed " << seed;
    EXPECT_GE(result.cycles + 60, result.moving) << "seed " << seed;
  }
}

TEST(PathLocator, DoesNotAllocate) {
  const auto path = planned(kHead + "o1 repeat [40]\nG1 X10 F4000\nX0\no1 endrepeat\nM2\n");
  const Route route(path.segments);
  PathLocator locator;
  Frame frame;
  frame.program = kernel::signal::ProgramState::running;
  frame.program_line = 3;
  const kernel::rt::testing::AllocationGuard guard;
  locator.follow(&route);
  for (int i = 0; i < 1000; ++i) {
    frame.time_s = 0.001 * i;
    frame.axis[0].command_mm = 0.01 * i;
    frame.path_speed_mm_s = 10.0;
    (void)locator.update(frame);
  }
  EXPECT_EQ(guard.allocations(), 0U);
}

}  // namespace
}  // namespace steadyrest::nc::follow
