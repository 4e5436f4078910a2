// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include <steadyrest/trial/test/examples.hpp>
#include <steadyrest/trial/timing/demanding_path.hpp>

namespace steadyrest::trial::timing {
namespace {

using kernel::machine::Machine;
using kernel::signal::Geometry;
using kernel::signal::Motion;
using kernel::signal::PathSegment;
using test::machine_of;

double seconds_of(const nc::plan::PlannedPath& path) {
  double seconds = 0.0;
  for (const PathSegment& segment : path.segments) {
    seconds += segment.motion == Motion::feed ? segment.length_mm / segment.feed_mm_s : 0.0;
  }
  return seconds;
}

double fastest_cut_mm_s(const nc::plan::PlannedPath& path) {
  double fastest = 0.0;
  for (const PathSegment& segment : path.segments) {
    fastest = segment.motion == Motion::feed ? std::max(fastest, segment.feed_mm_s) : fastest;
  }
  return fastest;
}

/// Ends of all segments lie within the travel.
void expect_within_travel(const Machine& machine, const nc::plan::PlannedPath& path) {
  for (const PathSegment& segment : path.segments) {
    for (std::size_t i = 0; i < 3; ++i) {
      ASSERT_GE(segment.end_mm[i], machine.axes[i].min_au - 1e-9);
      ASSERT_LE(segment.end_mm[i], machine.axes[i].max_au + 1e-9);
    }
  }
}

// From both sides: as fast as the machine lets it, and no faster.
TEST(DemandingPath, OnEveryExampleMachineLastsAndStaysWithinItsTravelAndFeed) {
  for (const std::string name : {"ideal-k50.toml", "lathe-16k20f3.toml", "linuxcnc-mill.toml",
                                 "mill-802d.toml", "vmc-840d.toml"}) {
    SCOPED_TRACE(name);
    const Machine machine = machine_of(name);
    const auto path = demanding_path(machine, 40.0).value();
    EXPECT_GE(seconds_of(*path), 40.0);
    expect_within_travel(machine, *path);
    const double limit = machine.control.max_feed_mm_s;
    const double fastest = fastest_cut_mm_s(*path);
    EXPECT_LE(fastest, limit + 1e-9);
    EXPECT_GE(fastest, std::min(machine.axes[0].max_speed_au_s, limit) - 1e-9);
    const auto arcs = std::ranges::count(path->segments, Geometry::arc, &PathSegment::geometry);
    EXPECT_GE(arcs, 16);
  }
}

// A lathe has no Y: the drawing goes into G18.
TEST(DemandingPath, OfALatheLiesInThePlaneOfXAndZ) {
  const auto path = demanding_path(machine_of("lathe-16k20f3.toml"), 1.0).value();
  for (const PathSegment& segment : path->segments) {
    EXPECT_EQ(segment.end_mm[1], 0.0);
  }
}

// 4 mm of X for a drawing of 104 mm.
TEST(DemandingPath, ShrinksToTheTravel) {
  Machine machine = machine_of("linuxcnc-mill.toml");
  machine.axes[0].min_au = 100.0;
  machine.axes[0].max_au = 104.0;
  const auto path = demanding_path(machine, 1.0).value();
  expect_within_travel(machine, *path);
  EXPECT_GE(seconds_of(*path), 1.0);
}

TEST(DemandingPath, RefusesAMachineOfOneAxis) {
  Machine machine = machine_of("linuxcnc-mill.toml");
  machine.axes[0].present = machine.axes[1].present = false;
  EXPECT_FALSE(demanding_path(machine, 1.0));
}

}  // namespace
}  // namespace steadyrest::trial::timing
