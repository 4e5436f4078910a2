// SPDX-License-Identifier: Apache-2.0
// G33, G33.1 and G76 by the laws of LinuxCNC's manual ("G codes"): depth of pass n is J·n^(1/R).
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>

#include <steadyrest/nc/interpret/test/moves.hpp>

namespace steadyrest::nc::interpret {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;

const std::string kLathe = "G18 G8 G0 X20 Z5\nS600 M3\n";

std::vector<Move> threads_of(const std::string& text) {
  std::vector<Move> out;
  for (const Move& move : moves_of(kLathe + text + "\nM2\n")) {
    if (move.kind == MoveKind::thread) {
      out.push_back(move);
    }
  }
  return out;
}

/// How deep each pass of a cycle cuts below X20 − 2 (I−2).
std::vector<double> depths_below_peak(const std::string& words) {
  std::vector<double> out;
  for (const Move& move : threads_of("G76 P1.5 Z-10 I-2 " + words)) {
    out.push_back(18.0 - move.end[0]);
  }
  return out;
}

std::string refused_thread(const std::string& block) {
  return reason_of(kLathe + block + "\nM2\n");
}

TEST(Threading, FeedsByThePitchOfItsMoveAlone) {
  const auto moves = moves_of("G0 X0\nF120 S600 M3\nG33 Z-5 K-1.25\nG1 Z0\nM2\n");
  ASSERT_EQ(moves.size(), 3U);
  EXPECT_EQ(moves[1].kind, MoveKind::thread);
  EXPECT_EQ(moves[1].feed_mode, FeedMode::per_revolution);
  EXPECT_EQ(moves[1].feed_mm_s, 1.25);  // mm/rev; the sign of K has no meaning
  EXPECT_TRUE(moves[1].override_locked);
  EXPECT_EQ(moves[2].feed_mode, FeedMode::per_minute);
  EXPECT_EQ(moves[2].feed_mm_s, 2.0);
  EXPECT_FALSE(moves[2].override_locked);
  // 20 threads per inch: K0.05 in G20 is 1.27 mm.
  EXPECT_DOUBLE_EQ(moves_of("G20 S600 M3\nG33 Z-1 K0.05\nM2\n").back().feed_mm_s, 1.27);
}

TEST(Threading, RigidTapComesBackWithTheSpindleReversed) {
  const auto moves = moves_of("G0 X1 Z5\nS300 M4\nG33.1 Z-5 K1\nG0 X2\nM2\n");
  ASSERT_EQ(moves.size(), 4U);
  EXPECT_EQ(moves[1].end[2], -5.0);
  EXPECT_EQ(moves[1].spindle_rev_s, -5.0);
  EXPECT_EQ(moves[2].end[2], 5.0);
  EXPECT_EQ(moves[2].spindle_rev_s, 5.0);
  EXPECT_EQ(moves[3].spindle_rev_s, -5.0);
}

// R1 gives equal depths, R2 equal areas of chip: 0.5·√n. The last pass is at K, H more follow.
TEST(Threading, PassesGoDeeperByTheDegression) {
  EXPECT_THAT(depths_below_peak("J0.4 K1"),
              ElementsAre(DoubleNear(0.4, 1e-12), DoubleNear(0.8, 1e-12), DoubleNear(1.0, 1e-12)));
  EXPECT_THAT(depths_below_peak("J0.5 K1 R2 H2"),
              ElementsAre(DoubleNear(0.5, 1e-12), DoubleNear(0.5 * std::numbers::sqrt2, 1e-12),
                          DoubleNear(0.5 * std::sqrt(3.0), 1e-12), DoubleNear(1.0, 1e-12),
                          DoubleNear(1.0, 1e-12), DoubleNear(1.0, 1e-12)));
}

// In G7 I, J and K are diameters like X: the same thread by other numbers.
TEST(Threading, DepthsInDiameterModeAreDiameters) {
  const auto by_radius = threads_of("G76 P1.5 Z-10 I-2 J0.4 K1");
  const auto by_diameter = threads_of("G7\nG76 P1.5 Z-10 I-4 J0.8 K2");
  ASSERT_EQ(by_radius.size(), by_diameter.size());
  for (std::size_t i = 0; i < by_radius.size(); ++i) {
    EXPECT_DOUBLE_EQ(by_radius[i].end[0], by_diameter[i].end[0]) << i;
  }
}

// The compound slide at 30° begins a pass of depth d earlier by d·tan 30° on the way to −Z and ends
// it later by what is left.
TEST(Threading, CompoundSlideMovesThePassesAlongTheThread) {
  const double slope = std::tan(std::numbers::pi / 6.0);
  const auto passes = threads_of("G76 P1.5 Z-10 I-2 J0.4 K1 Q30");
  ASSERT_EQ(passes.size(), 3U);
  for (const Move& pass : passes) {
    const double depth = 18.0 - pass.end[0];
    EXPECT_NEAR(pass.start[2], 5.0 - depth * slope, 1e-12);
    EXPECT_NEAR(pass.end[2], -10.0 + (1.0 - depth) * slope, 1e-12);
  }
}

// L3 tapers both ends over E: entry, thread, exit. Along the taper the pitch grows so that the
// travel in Z stays one pitch in a turn: by hypot(E, K)/E.
TEST(Threading, TapersItsEnds) {
  const auto passes = threads_of("G76 P1.5 Z-10 I-2 J1 K1.5 E2 L3");
  ASSERT_EQ(passes.size(), 8U);  // J1 and K1.5: two passes of four threaded pieces
  const double along_taper = 1.5 * std::hypot(2.0, 1.5) / 2.0;  // 1.875
  EXPECT_DOUBLE_EQ(along_taper, 1.875);
  EXPECT_EQ(passes[5].end[0], 16.5);  // 18 − 1.5
  EXPECT_EQ(passes[5].end[2], 3.0);   // 5 − E
  EXPECT_DOUBLE_EQ(passes[5].feed_mm_s, along_taper);
  EXPECT_EQ(passes[6].end[2], -8.0);  // −10 + E
  EXPECT_DOUBLE_EQ(passes[6].feed_mm_s, 1.5);
  EXPECT_EQ(passes[7].end[2], -10.0);
  EXPECT_DOUBLE_EQ(passes[7].feed_mm_s, along_taper);
}

// I > 0 cuts an inside thread: the tool goes outwards, and comes back to the drive line.
TEST(Threading, InsideThreadsGoOutwards) {
  const auto moves = moves_of(kLathe + "G76 P1.5 Z-10 I2 J0.4 K1\nM2\n");
  EXPECT_EQ(moves.back().kind, MoveKind::rapid);
  EXPECT_EQ(moves.back().end[0], 20.0);
  EXPECT_EQ(moves.back().end[2], -10.0);
  double largest = 0.0;
  for (const Move& move : moves) {
    largest = std::max(largest, move.end[0]);
  }
  EXPECT_EQ(largest, 23.0);  // 20 + 2 + 1
}

TEST(Threading, IsRefusedByName) {
  EXPECT_EQ(refused_thread("G33 Z-5"), "pitch_missing");
  EXPECT_EQ(refused_thread("M5\nG33 Z-5 K1"), "spindle_stands");
  EXPECT_EQ(refused_thread("S0\nG33 Z-5 K1"), "spindle_stands");
  EXPECT_EQ(refused_thread("G33.1 Z-5 K0"), "out_of_range");
  EXPECT_EQ(refused_thread("G33.1 Z-5 K1 A3"), "axis_in_cycle");
  const std::pair<const char*, const char*> cases[] = {
      {"P1 Z-10 I-2 J0.4", "cycle_word_missing"},     {"Z-10 I-2 J0.4 K1", "cycle_word_missing"},
      {"P1 Z-10 I-2 J0.4 K1 B1", "axis_in_cycle"},    {"P0 Z-10 I-2 J0.4 K1", "out_of_range"},
      {"P1 Z-10 I0 J0.4 K1", "out_of_range"},         {"P1 Z-10 I-2 J0 K1", "out_of_range"},
      {"P1 Z-10 I-2 J1 K1", "out_of_range"},          {"P1 Z-10 I-2 J0.4 K1 R0.5", "out_of_range"},
      {"P1 Z-10 I-2 J0.4 K1 H1.5", "not_an_integer"}, {"P1 Z-10 I-2 J0.4 K1 L4", "out_of_range"},
      {"P1 Z-10 I-2 J0.4 K1 Q80", "out_of_range"},    {"P1 Z-10 I-2 J0.4 K1 L1", "out_of_range"},
      {"P1 Z-10 I-2 J0.0001 K1 R2", "out_of_range"}};
  for (const auto& [words, reason] : cases) {
    EXPECT_EQ(refused_thread(std::string{"G76 "} + words), reason) << words;
  }
  // Just inside the bounds.
  EXPECT_EQ(refused_thread("G76 P1 Z-10 I-2 J0.4 K1 R1 H0 L0 Q79"), "");
}

}  // namespace
}  // namespace steadyrest::nc::interpret
