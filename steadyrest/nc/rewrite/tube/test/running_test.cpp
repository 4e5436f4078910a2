// SPDX-License-Identifier: Apache-2.0
// A program that is run line by line, and where the machine is after each.
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/nc/rewrite/tube/running.hpp>
#include <steadyrest/nc/rewrite/tube/stretch.hpp>
#include <steadyrest/nc/rewrite/tube/test/made_moves.hpp>
#include <steadyrest/nc/rewrite/tube/test/tube_shop.hpp>

namespace steadyrest::nc::rewrite {
namespace {

using kernel::signal::Point;
using test::made_arc;

void expect_at(const Point& place, double x_mm, double y_mm, double z_mm) {
  EXPECT_NEAR(place[0], x_mm, 1e-9);
  EXPECT_NEAR(place[1], y_mm, 1e-9);
  EXPECT_NEAR(place[2], z_mm, 1e-9);
}

TEST(Running, NotesWhereTheMachineIsAfterEachLine) {
  test::TubeShop shop;
  shop.config.work_offset[0] = {100.0, 50.0, 0.0};
  const std::string path = shop.original();
  test::write_file(path, "G21 G90 G54\nG0 X1 Y2 Z3\nG4 P1\nG20\nG1 X1 F10\nG92 X0\nG1 X1\nM2\n");
  const auto program = Running::open(path, shop.config).value();
  std::vector<double> x_mm;
  std::vector<std::size_t> moves;
  while (program->step()) {
    program->note_position();
    x_mm.push_back(program->at_mm ? program->at_mm->at(0) : -1.0);
    moves.push_back(program->kept.moves.size());
  }
  // In inches 1 is 25.4 mm; G92 X0 gives the place another name, from which it is an inch more.
  const std::vector<double> truth = {-1, 101, 101, 101, 125.4, 125.4, 150.8};
  ASSERT_GE(x_mm.size(), truth.size());
  for (std::size_t i = 0; i < truth.size(); ++i) {
    EXPECT_NEAR(x_mm[i], truth[i], 1e-9) << "line " << i + 1;
  }
  // Kept are the moves of the line alone.
  EXPECT_EQ(std::vector(moves.begin(), moves.begin() + 7),
            (std::vector<std::size_t>{0, 1, 1, 0, 1, 0, 1}));
  expect_at(*program->at_mm, 150.8, 52.0, 3.0);
}

TEST(Running, RefusesAFileThatIsNotThere) {
  const test::TubeShop shop;
  const std::string absent = shop.original();
  const auto program = Running::open(absent, shop.config);
  ASSERT_FALSE(program);
  EXPECT_EQ(program.error().file, absent);
}

// What a work offset turned by 90° calls X is the machine's Y.
TEST(MachinePoint, IsTurnedThenShifted) {
  interpret::Move block = made_arc({10, 0, 0}, {0, 10, 0}, {0, 0, 0}, 1);
  block.rotation_deg = 90.0;
  block.offset = {1, 2, 3};
  expect_at(machine_point(block, block.start), 1.0, 12.0, 3.0);
  expect_at(machine_point(block, block.end), -9.0, 2.0, 3.0);
  const auto fault = [&](const interpret::Move& fresh) {
    Stretch stretch(0.01);
    stretch.begin({1, 12, 3}, {1, 12, 3});
    stretch.block(block);
    stretch.fresh(fresh);
    return stretch.close().has_value();
  };
  EXPECT_FALSE(fault(made_arc({1, 12, 3}, {-9, 2, 3}, {1, 2, 3}, 1)));
  EXPECT_TRUE(fault(made_arc({1, 12, 3}, {-9, 2, 3}, {1, 2.1, 3}, 1)));
}

}  // namespace
}  // namespace steadyrest::nc::rewrite
