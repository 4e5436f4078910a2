// SPDX-License-Identifier: Apache-2.0
// A record whose columns have each other's names must not teach; one that is right must.
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/contour/offline/learn/swapped_columns.hpp>
#include <steadyrest/contour/offline/learn/test/recorded_part.hpp>

namespace steadyrest::contour::offline {
namespace {

using kernel::signal::Point;

struct Recorded {
  kernel::machine::Machine machine = test::ideal_mill();
  nc::plan::PlannedPath path = test::planned_moves(
      machine, "G1 X40 Y10 F3000\nG3 X40 Y40 I0 J15\nG1 X5\nG2 X5 Y25 I0 J-7.5\nG1 X60 Z-2\n");
  PartRecord record = test::recorded_part(machine, path, 47.0);

  [[nodiscard]] std::string said() const {
    return swapped_columns(record, path.segments, servo_models(machine.axes));
  }
  static void swap(std::vector<Point>& of, std::size_t a, std::size_t b) {
    for (Point& point : of) {
      std::swap(point[a], point[b]);
    }
  }
};

TEST(SwappedColumns, AreNotSeenInARecordThatIsRight) {
  const Recorded part;
  EXPECT_EQ(part.said(), "");
}

// A program that goes only half-way, and back: a restart.
TEST(SwappedColumns, AreNotSeenWhereTheProgramIsAnother) {
  Recorded part;
  part.path = test::planned_moves(part.machine, "G1 X-40 Y10 F3000\nG1 X0 Y-60\n");
  EXPECT_EQ(part.said(), "");
}

TEST(SwappedColumns, OfCommandedAndMeasuredPositionsAreNamed) {
  Recorded part;
  std::swap(part.record.command_mm, part.record.actual_mm);
  const std::string said = part.said();
  EXPECT_NE(said.find("x_cmd_mm with x_act_mm, y_cmd_mm with y_act_mm"), std::string::npos) << said;
  EXPECT_NE(said.find("ahead"), std::string::npos) << said;
}

TEST(SwappedColumns, OfOneAxisAreNamed) {
  Recorded part;
  for (std::size_t i = 0; i < part.record.size(); ++i) {
    std::swap(part.record.command_mm[i][1], part.record.actual_mm[i][1]);
  }
  const std::string said = part.said();
  EXPECT_NE(said.find("(y_cmd_mm with y_act_mm)"), std::string::npos) << said;
}

TEST(SwappedColumns, OfTwoAxesAreNamed) {
  Recorded both;
  Recorded::swap(both.record.command_mm, 0, 1);
  Recorded::swap(both.record.actual_mm, 0, 1);
  EXPECT_NE(both.said().find("columns of x and y"), std::string::npos) << both.said();
  Recorded commands;
  Recorded::swap(commands.record.command_mm, 0, 1);
  EXPECT_NE(commands.said().find("x_cmd_mm and y_cmd_mm"), std::string::npos) << commands.said();
  Recorded actual;
  Recorded::swap(actual.record.actual_mm, 1, 2);
  EXPECT_NE(actual.said().find("y_act_mm and z_act_mm"), std::string::npos) << actual.said();
}

// With full feed-forward the tool is where it is commanded, and noise decides who is ahead.
TEST(SwappedColumns, AreNotSeenWithoutLag) {
  Recorded part;
  for (auto& axis : part.machine.axes) {
    axis.feed_forward = 1.0;
  }
  part.record.actual_mm = part.record.command_mm;
  for (std::size_t i = 1; i < part.record.size(); ++i) {
    part.record.actual_mm[i - 1] = part.record.command_mm[i];
  }
  EXPECT_EQ(part.said(), "");
}

}  // namespace
}  // namespace steadyrest::contour::offline
