// SPDX-License-Identifier: Apache-2.0
// A move starts where the machine is: where the move before has ended, whatever the control counts
// with. LinuxCNC ignores G52 and G92 when G10 changes the rotation under them, so its own position
// is another from there on, until the next move.
#include <cmath>
#include <string>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <steadyrest/nc/interpret/test/moves.hpp>

namespace steadyrest::nc::interpret {
namespace {

double apart(const Axes& a, const Axes& b) {
  double most = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    most = std::max(most, std::abs(a[i] - b[i]));
  }
  return most;
}

/// The largest jump of the machine between two moves; a probe ends where it touches.
double largest_jump(const std::vector<Move>& moves) {
  double largest = 0.0;
  for (std::size_t i = 1; i < moves.size(); ++i) {
    if (moves[i - 1].kind != MoveKind::probe) {
      largest = std::max(largest, apart(machine_of(moves[i - 1], moves[i - 1].end),
                                        machine_of(moves[i], moves[i].start)));
    }
  }
  return largest;
}

// rs274: the cut goes to X4.4956 Y20 in the turned work coordinates; the machine is at X10 Y5.
TEST(MoveStarts, AreWhereTheMachineIsAfterARotationUnderAShift) {
  for (const char* const shift : {"G52 Y3\n", "G92 Y2\n"}) {
    const auto moves = moves_of(std::string("G21 G90 G17 G54 F100\nG0 X10 Y5 Z1\n") + shift +
                                "G10 L2 P0 X2 R71\nG4 P1\nG1 Y20\nG1 X30\nM2\n");
    ASSERT_EQ(moves.size(), 4U) << shift;
    for (std::size_t i : {1U, 2U}) {  // the dwell, too
      const Axes start = machine_of(moves[i], moves[i].start);
      EXPECT_NEAR(start[0], 10.0, 1e-9) << shift;
      EXPECT_NEAR(start[1], 5.0, 1e-9) << shift;
    }
    EXPECT_NEAR(moves[2].end[0], 4.4956, kHalfDigit) << shift;
    EXPECT_NEAR(moves[2].end[1], 20.0, kHalfDigit) << shift;
    EXPECT_EQ(moves[3].start, moves[2].end) << shift;
  }
}

// A second change of the rotation, or of the offset, before anything moves.
TEST(MoveStarts, StayWhereTheMachineIsHoweverOftenOffsetsChange) {
  for (const char* const changes :
       {"G10 L2 P1 R30\nG10 L2 P1 R80\n", "G10 L2 P1 R30\nG55\n", "G10 L2 P1 R30\nG43.1 Z2\n",
        "G10 L2 P1 R30\nG92.1\n", "G10 L2 P1 R30\nG10 L2 P1 R0\n", "G10 L2 P1 R30\nG92 X0\n",
        "G41.1 D2 G1 X40\nG1 Y20\nG40\nG10 L2 P1 R30\n"}) {
    const auto moves =
        moves_of(std::string("G21 G90 G17 G54 F100\nG10 L2 P2 X5 R-20\nG0 X10 Y5 Z1\nG92 X3 Y2\n") +
                 changes + "G1 Z0\nG1 X9 Y9\nM2\n");
    EXPECT_LT(largest_jump(moves), 1e-9) << changes;
  }
}

RC_GTEST_PROP(MoveStarts, AreWhereTheMoveBeforeHasEnded, ()) {
  std::string text = "G21 G90 G17 G54 G94 F100\nG0 X1 Y2 Z3\n";
  const auto lines = *rc::gen::container<std::vector<std::string>>(rc::gen::element<std::string>(
      "G1 X5", "G1 Y-3 Z1", "X20", "G0 X1 Y1", "G91 X2 Y1", "G90", "G52 X1 Y-2", "G52 X0 Y0 Z0",
      "G92 X3", "G92 X0 Y1 Z2", "G92.1", "G92.2", "G92.3", "G10 L2 P1 X1 R30", "G10 L2 P0 R71",
      "G10 L2 P2 Y4 R-15", "G10 L2 P0 R0", "G10 L20 P1 X0 Y2", "G10 L20 P0 Z1", "G54", "G55",
      "G43.1 Z2 X1", "G49", "G53 G0 X3", "G28 Z5", "G20", "G21", "G4 P.1", "G1 A10",
      "G10 L1 P1 Z2 R3", "G10 L10 P1 X2", "T1 M6", "G38.3 Z-9", "G81 X1 Y1 Z-1 R2\nG80\nG1"));
  for (const std::string& line : lines) {
    text += line + "\n";
  }
  Kept kept;
  Config config;
  config.axes = "XYZA";
  RC_ASSERT(run_text(text + "M2\n", config, kept).has_value());
  RC_ASSERT(largest_jump(kept.moves) < 1e-6);
}

}  // namespace
}  // namespace steadyrest::nc::interpret
