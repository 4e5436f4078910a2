// SPDX-License-Identifier: Apache-2.0
// Offsets, rotations and units change what positions are called, never where the machine is.
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <rapidcheck/gtest.h>

#include <steadyrest/nc/interpret/test/moves.hpp>

namespace steadyrest::nc::interpret {
namespace {

using read::Dialect;
using testing::DoubleNear;
using testing::ElementsAre;

Axes machine_end_of(const Move& move) {
  return machine_of(move, move.end);
}

/// X, Y and Z of the machine at the end of the last move.
std::vector<double> last_machine_xyz(const std::string& text, const Config& config = {}) {
  const auto moves = moves_of(text, config);
  const Axes at = machine_end_of(moves.back());
  return {at[0], at[1], at[2]};
}

auto near_xyz(double x, double y, double z) {
  return ElementsAre(DoubleNear(x, 1e-9), DoubleNear(y, 1e-9), DoubleNear(z, 1e-9));
}

/// A word that changes coordinates, and no axis. G92 or rotations: under a shift LinuxCNC loses it
/// where G10 turns the work (README.md, "Order within a block").
std::string random_change(bool turns) {
  const auto number = [] { return std::to_string(*rc::gen::inRange(-500, 500) / 10.0); };
  switch (turns ? *rc::gen::inRange(4, 12) : *rc::gen::inRange(0, 11)) {
    case 0:
      return "G92 X" + number() + " Y" + number();
    case 1:
      return "G92.1";
    case 2:
      return "G92.2";
    case 3:
      return "G92.3";
    case 4:
      return "G10 L2 P" + std::to_string(*rc::gen::inRange(1, 4)) + " X" + number() + " Z" +
             number();
    case 5:
      return "G" + std::to_string(*rc::gen::inRange(54, 57));
    case 6:
      return "G49";
    case 7:
      return "G43.1 Z" + number();
    case 8:
      return *rc::gen::element<std::string>("G20", "G21");
    case 9:
    case 10:
      return "G10 L20 P" + std::to_string(*rc::gen::inRange(1, 4)) + " Y" + number();
    default:
      return "G10 L2 P" + std::to_string(*rc::gen::inRange(1, 4)) + " R" +
             std::to_string(*rc::gen::inRange(0, 360));
  }
}

// A move of W, which no offset here touches, shows where the machine is: after any changes X, Y and
// Z have not moved. Bound: 30 changes of some hundred millimetres, each rounded once or twice.
RC_GTEST_PROP(Coordinates, NoChangeOfThemMovesTheMachine, ()) {
  std::string text = "G21 G90\nG0 X12.5 Y-7.25 Z30\n";
  const bool turns = *rc::gen::arbitrary<bool>();
  const int changes = *rc::gen::inRange(1, 15);
  for (int i = 0; i < changes; ++i) {
    text += random_change(turns) + "\n";
  }
  Config config;
  config.axes = "XYZW";
  const auto moves = moves_of(text + "G91 G0 W1\nM2\n", config);
  RC_ASSERT(moves.size() == 2U);
  const Axes at = machine_end_of(moves[1]);
  const double wanted[] = {12.5, -7.25, 30.0};
  for (std::size_t i = 0; i < 3; ++i) {
    RC_ASSERT(std::abs(at[i] - wanted[i]) < 1e-9);
  }
}

// G92 gives the present position a name, whatever is in force beneath it.
TEST(Coordinates, G92NamesThePresentPosition) {
  Config config;
  config.work_offset[0] = {100.0, 50.0, 20.0};
  EXPECT_THAT(last_machine_xyz("G54 G0 X5 Y6\nG92 X0 Y1\nG0 X10 Y10\nM2\n", config),
              near_xyz(115.0, 65.0, 0.0));
  EXPECT_THAT(last_machine_xyz("G54 G0 X5\nG92 X0\nG92.1\nG0 X10\nM2\n", config),
              near_xyz(110.0, 0.0, 0.0));
  // G92.2 only suspends it.
  EXPECT_THAT(last_machine_xyz("G54 G0 X5\nG92 X0\nG92.2\nG92.3\nG0 X10\nM2\n", config),
              near_xyz(115.0, 0.0, 0.0));
}

// G52 is an offset on top of the work offset; 0 takes it off.
TEST(Coordinates, G52ShiftsTheWorkOffset) {
  Config config;
  config.work_offset[0][0] = 100.0;
  config.work_offset[1][0] = 200.0;
  EXPECT_THAT(last_machine_xyz("G54 G52 X7\nG0 X1\nM2\n", config), near_xyz(108.0, 0.0, 0.0));
  EXPECT_THAT(last_machine_xyz("G54 G52 X7\nG55 G0 X1\nM2\n", config), near_xyz(208.0, 0.0, 0.0));
  EXPECT_THAT(last_machine_xyz("G54 G52 X7\nG52 X0\nG0 X1\nM2\n", config),
              near_xyz(101.0, 0.0, 0.0));
}

// L2 sets the offset, L20 computes it so that the present position has the name.
TEST(Coordinates, G10SetsAnOffsetOrThePositionsName) {
  EXPECT_THAT(last_machine_xyz("G54\nG10 L2 P1 X40 Y-5\nG0 X1 Y1\nM2\n"), near_xyz(41, -4, 0));
  EXPECT_THAT(last_machine_xyz("G54 G0 X10\nG10 L20 P1 X0\nG0 X3\nM2\n"), near_xyz(13, 0, 0));
  // An inactive offset changes nothing until it is selected.
  EXPECT_THAT(last_machine_xyz("G54\nG10 L2 P2 X40\nG0 X1\nM2\n"), near_xyz(1, 0, 0));
  EXPECT_THAT(last_machine_xyz("G54\nG10 L2 P2 X40\nG55 G0 X1\nM2\n"), near_xyz(41, 0, 0));
}

// Counter-clockwise by 30°: (10, 0) is (10·cos 30°, 10·sin 30°) of the machine, behind the offset.
TEST(Coordinates, TurnAboutTheOffsetsZero) {
  Config config;
  config.work_offset[0] = {100.0, 50.0, 0.0};
  config.rotation_deg[0] = 30.0;
  EXPECT_THAT(last_machine_xyz("G54 G0 X10 Y0 Z2\nM2\n", config),
              near_xyz(100.0 + 10.0 * std::sqrt(0.75), 55.0, 2.0));
  // G53 goes to the machine's own coordinates.
  EXPECT_THAT(last_machine_xyz("G54 G0 X10 Y0\nG53 G0 X3 Y4\nM2\n", config), near_xyz(3, 4, 0));
  EXPECT_THAT(last_machine_xyz("G54 G0 X10 Y0\nG53 G0 X3\nM2\n", config), near_xyz(3, 55, 0));
}

// The tool's tip is where the program says, so the machine is a length higher; G53 of LinuxCNC is
// the machine's own position, without the tool.
TEST(Coordinates, TheToolLengthIsOfTheMachine) {
  EXPECT_THAT(last_machine_xyz("G43.1 Z50\nG0 Z10\nM2\n"), near_xyz(0, 0, 60));
  EXPECT_THAT(last_machine_xyz("G43.1 Z50\nG0 Z10\nG53 G0 Z0\nM2\n"), near_xyz(0, 0, 0));
  EXPECT_THAT(last_machine_xyz("G43.1 Z50\nG49\nG0 Z10\nM2\n"), near_xyz(0, 0, 10));
  // A rotation of the work does not turn the tool.
  Config config;
  config.rotation_deg[0] = 90.0;
  EXPECT_THAT(last_machine_xyz("G54 G43.1 X5\nG0 X10 Y0\nM2\n", config), near_xyz(5, 10, 0));
}

// Reference points are the machine's: G28 goes by way of the point given, and then there.
TEST(Coordinates, ReferencePointsAreOfTheMachine) {
  Config config;
  config.work_offset[0] = {100.0, 50.0, 20.0};
  config.home[0] = {1.0, 2.0, 300.0};
  config.home[1] = {7.0, 8.0, 9.0};
  const auto moves = moves_of("G54 G0 X0 Y0 Z0\nG28 Z5\nM2\n", config);
  ASSERT_EQ(moves.size(), 3U);
  EXPECT_EQ(machine_end_of(moves[1])[2], 25.0);
  EXPECT_EQ(machine_end_of(moves[2])[2], 300.0);
  EXPECT_EQ(machine_end_of(moves[2])[0], 100.0) << "axes without a word stay";
  EXPECT_THAT(last_machine_xyz("G54 G0 X0 Y0 Z0\nG30\nM2\n", config), near_xyz(7, 8, 9));
  EXPECT_THAT(last_machine_xyz("G54 G0 X1 Y1\nG28.1\nG0 X9\nG28\nM2\n", config),
              near_xyz(101, 51, 0));
}

// Polar words: a distance from zero at an angle from +X; in G91 they add.
TEST(Coordinates, PolarWordsAreAboutTheWorksZero) {
  EXPECT_THAT(last_machine_xyz("G0 @10 ^30\nM2\n"), near_xyz(10.0 * std::sqrt(0.75), 5.0, 0.0));
  EXPECT_THAT(last_machine_xyz("G0 @10 ^30\n^90\nM2\n"), near_xyz(0, 10, 0));
  EXPECT_THAT(last_machine_xyz("G0 @10 ^30\nG91 @5 ^60\nM2\n"), near_xyz(0, 15, 0));
  // As rs274 2.9 has it, the plane in force before the block decides.
  EXPECT_EQ(reason_of("G18\nG0 @10\nM2\n"), "polar_off_xy");
  EXPECT_EQ(reason_of("G18\nG17 G0 @10\nM2\n"), "polar_off_xy");
  EXPECT_THAT(last_machine_xyz("G18 G0 @10 ^30\nM2\n"), near_xyz(10.0 * std::sqrt(0.75), 5.0, 0.0));
  EXPECT_EQ(reason_of("G0 @10 X3\nM2\n"), "polar_and_axis_words");
}

}  // namespace
}  // namespace steadyrest::nc::interpret
