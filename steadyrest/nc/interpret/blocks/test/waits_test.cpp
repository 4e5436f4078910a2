// SPDX-License-Identifier: Apache-2.0
// Words that LinuxCNC 2.9.0~pre1 stops for, and words that it does not stop for: each between two
// lines of 2 mm at F2400, seen in its joint commands.
#include <string>

#include <gtest/gtest.h>

#include <steadyrest/nc/interpret/test/moves.hpp>

namespace steadyrest::nc::interpret {
namespace {

bool rests_at(const std::string& line) {
  const auto moves = moves_of("G21 G90 G54 F100\nG1 X2\n" + line + "\nG1 X4\nG1 X6\nM2\n");
  EXPECT_EQ(moves.size(), 3U) << line;
  EXPECT_FALSE(moves.at(0).after_rest) << line;
  EXPECT_FALSE(moves.at(2).after_rest) << line;
  return moves.at(1).after_rest;
}

TEST(Waits, LinuxCncStopsWhereAWordActsOnlyWhenTheMovesAreDone) {
  for (const char* line : {"G55", "G92 X1", "G92.1", "G52 X1", "G10 L2 P1 X1", "G10 L2 P0 X1",
                           "G49", "G43.1 Z1", "S1000", "M52 P1", "M64 P0", "M65 P0", "M66 P0 L0",
                           "M68 E0 Q1", "(MSG,hello)", "(debug, hello)"}) {
    EXPECT_TRUE(rests_at(line)) << line;
  }
}

TEST(Waits, LinuxCncGoesOnPastTheOthers) {
  for (const char* line :
       {"G54", "G10 L2 P2 X1", "M48", "M50 P1", "M53 P1", "M62 P0", "M63 P0", "M67 E0 Q1", "T2",
        "F1200", "G61", "G64 P0.1", "#1=5", "(print,hello)", "(a comment)"}) {
    EXPECT_FALSE(rests_at(line)) << line;
  }
}

TEST(Waits, AMoveInTheSameBlockComesAfterTheRest) {
  const auto moves = moves_of("G21 G90 F100\nG1 X2\nS500 G1 X4\nG1 X6\nM2\n");
  EXPECT_TRUE(moves.at(1).after_rest);
  EXPECT_FALSE(moves.at(2).after_rest);
}

TEST(Waits, OtherControlsArePlannedAsBefore) {
  Config config;
  config.dialect = kernel::machine::Dialect::fanuc;
  const auto moves = moves_of("G21 G90 F100\nG1 X2\nG55 S500\nG1 X4\nM30\n", config);
  EXPECT_FALSE(moves.at(1).after_rest);
}

}  // namespace
}  // namespace steadyrest::nc::interpret
