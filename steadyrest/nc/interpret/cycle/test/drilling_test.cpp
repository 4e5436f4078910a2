// SPDX-License-Identifier: Apache-2.0
// The drilling cycles of LinuxCNC's manual ("G codes", Canned Cycles), whose examples print every
// move.
#include <cmath>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>

#include <steadyrest/nc/interpret/test/moves.hpp>

namespace steadyrest::nc::interpret {
namespace {

using testing::ElementsAre;

constexpr auto kFast = MoveKind::rapid;
constexpr auto kCut = MoveKind::linear;

/// Kind and end point of a move in XYZ.
struct Leg {
  MoveKind kind;
  double x, y, z;
  friend bool operator==(const Leg&, const Leg&) = default;
  friend void PrintTo(const Leg& leg, std::ostream* out) {
    *out << static_cast<int>(leg.kind) << " to " << leg.x << ' ' << leg.y << ' ' << leg.z;
  }
};

/// The moves after the first, which goes to the start. Ends rounded to 1 nm: the manual prints
/// decimal numbers, and a sum of increments has its own last digit.
std::vector<Leg> legs_of(const std::string& text, const Config& config = {}) {
  const auto nm = [](double mm) { return std::round(mm * 1e6) / 1e6; };
  std::vector<Leg> out;
  for (const Move& move : moves_of(text, config)) {
    out.push_back({move.kind, nm(move.end[0]), nm(move.end[1]), nm(move.end[2])});
  }
  out.erase(out.begin());
  return out;
}

/// Depths of a cycle at one place: Z of each move.
std::vector<double> depths_of(const std::string& cycle) {
  std::vector<double> out;
  for (const Leg& leg : legs_of("G98 G0 X1 Y2 Z3\nF60 S600 M3\n" + cycle + "\nM2\n")) {
    out.push_back(leg.z);
  }
  return out;
}

// Manual, G81, example 1: from (1, 2, 3).
TEST(Drilling, AbsoluteHoleAsTheManualPrintsIt) {
  EXPECT_THAT(legs_of("G0 X1 Y2 Z3\nF60 G90 G98 G81 X4 Y5 Z1.5 R2.8\nM2\n"),
              ElementsAre(Leg{kFast, 4, 5, 3}, Leg{kFast, 4, 5, 2.8}, Leg{kCut, 4, 5, 1.5},
                          Leg{kFast, 4, 5, 3}));
}

// Manual, G81, example 2: the R plane is 1.8 above Z3, that is 4.8, the bottom 0.6 below that.
TEST(Drilling, IncrementalRowAsTheManualPrintsIt) {
  EXPECT_THAT(legs_of("G0 X1 Y2 Z3\nF60 G91 G81 G98 X4 Y5 Z-0.6 R1.8 L3\nM2\n"),
              ElementsAre(Leg{kFast, 1, 2, 4.8},                            // lifts first
                          Leg{kFast, 5, 7, 4.8}, Leg{kCut, 5, 7, 4.2},      // 1 + 4, 2 + 5
                          Leg{kFast, 5, 7, 4.8}, Leg{kFast, 9, 12, 4.8},    //
                          Leg{kCut, 9, 12, 4.2}, Leg{kFast, 9, 12, 4.8},    //
                          Leg{kFast, 13, 17, 4.8}, Leg{kCut, 13, 17, 4.2},  //
                          Leg{kFast, 13, 17, 4.8}));
}

// Under G98 the tool goes across at the initial level, never at R or on a slope between them: a
// clamp stands there.
TEST(Drilling, GoesAcrossAtTheInitialLevelFromHoleToHole) {
  EXPECT_THAT(legs_of("G0 X0 Y2 Z3\nF60 G91 G98 G81 X4 Z-0.6 R-1 L2\nM2\n"),
              ElementsAre(Leg{kFast, 4, 2, 3}, Leg{kFast, 4, 2, 2}, Leg{kCut, 4, 2, 1.4},
                          Leg{kFast, 4, 2, 3}, Leg{kFast, 8, 2, 3}, Leg{kFast, 8, 2, 2},
                          Leg{kCut, 8, 2, 1.4}, Leg{kFast, 8, 2, 3}));
}

TEST(Drilling, DwellsAtTheBottomInG82AndG89) {
  const std::string head = "G98 G0 X1 Y2 Z3\nF60\n";
  EXPECT_THAT(legs_of(head + "G82 Z1 R2 P1.5\nM2\n"),
              ElementsAre(Leg{kFast, 1, 2, 3}, Leg{kFast, 1, 2, 2}, Leg{kCut, 1, 2, 1},
                          Leg{MoveKind::dwell, 1, 2, 1}, Leg{kFast, 1, 2, 3}));
  const auto bored = moves_of(head + "G99 G89 Z1 R2 P1.5\nM2\n");
  // Out at feed, to the R plane in G99.
  EXPECT_EQ(bored.at(4).dwell_s, 1.5);
  EXPECT_EQ(bored.at(5).kind, kCut);
  EXPECT_EQ(bored.at(5).end[2], 2.0);
}

// Pecks of 0.4 from R2 to Z1 end at 1.6, 1.2, 1. G83 clears to R, G73 by 0.254 only; G83 also comes
// back to 0.254 above the last bottom.
TEST(Drilling, PecksClearOrBreakTheChips) {
  EXPECT_THAT(depths_of("G83 Z1 R2 Q0.4"), ElementsAre(3, 2, 1.6, 2, 1.854, 1.2, 2, 1.454, 1, 3));
  EXPECT_THAT(depths_of("G73 Z1 R2 Q0.4"), ElementsAre(3, 2, 1.6, 1.854, 1.2, 1.454, 1, 3));
  // A peck as deep as the hole is one cut.
  EXPECT_THAT(depths_of("G83 Z1 R2 Q1"), ElementsAre(3, 2, 1, 3));
}

TEST(Drilling, BoresOutAtFeedOrWithTheSpindleStopped) {
  const std::string head = "G98 G0 X1 Y2 Z3\nF60 S600 M3\n";
  EXPECT_THAT(legs_of(head + "G85 Z1 R2\nM2\n"),
              ElementsAre(Leg{kFast, 1, 2, 3}, Leg{kFast, 1, 2, 2}, Leg{kCut, 1, 2, 1},
                          Leg{kCut, 1, 2, 2}, Leg{kFast, 1, 2, 3}));
  const auto stopped = moves_of(head + "G86 Z1 R2 P0.5\nM2\n");
  ASSERT_EQ(stopped.size(), 6U);
  EXPECT_EQ(stopped[3].spindle_rev_s, 10.0);
  EXPECT_EQ(stopped[4].dwell_s, 0.5);
  EXPECT_EQ(stopped[5].kind, kFast);
  EXPECT_EQ(stopped[5].spindle_rev_s, 0.0);
}

// G88: the operator brings the bar out; no move of the program leaves the hole.
TEST(Drilling, StopsForTheOperatorInG88) {
  Kept kept;
  ASSERT_TRUE(
      run_text("G98 G0 X1 Y2 Z3\nF60 S600 M3\nG88 Z1 R2 P0\nG0 X9\nM2\n", {}, kept).has_value());
  std::vector<EventKind> kinds;
  for (const Event& event : kept.events) {
    kinds.push_back(event.kind);
  }
  EXPECT_THAT(kinds, ElementsAre(EventKind::spindle, EventKind::spindle, EventKind::stop,
                                 EventKind::spindle, EventKind::end));
  // The next move starts at the clearance, where the manual asks the operator to be.
  EXPECT_EQ(kept.moves.back().start[2], 3.0);
  EXPECT_EQ(kept.moves.back().end[0], 9.0);
}

TEST(Drilling, TapsWithTheSpindleReversedOnTheWayOut) {
  const auto right = moves_of("G0 Z3\nF60 S600 M3\nG84 Z1 R2\nM2\n");
  const auto left = moves_of("G0 Z3\nF60 S600 M4\nG74 Z1 R2\nM2\n");
  for (const auto& [moves, sign] : {std::pair{right, 1.0}, std::pair{left, -1.0}}) {
    ASSERT_EQ(moves.back().kind, kCut);
    EXPECT_EQ(moves.back().spindle_rev_s, -10.0 * sign);
    EXPECT_EQ(moves.at(moves.size() - 3).spindle_rev_s, 10.0 * sign);
  }
}

// G87 with I0.5: aside, down with the spindle stopped, back on the axis, up to K2.5, and out again
// the same way.
TEST(Drilling, BackBoresFromBelow) {
  EXPECT_THAT(legs_of("G98 G0 X1 Y2 Z5\nF60 S600 M3\nG87 Z1 R4 I0.5 J0 K2.5\nM2\n"),
              ElementsAre(Leg{kFast, 1, 2, 5}, Leg{kFast, 1, 2, 4}, Leg{kFast, 1.5, 2, 4},
                          Leg{kFast, 1.5, 2, 1}, Leg{kFast, 1, 2, 1}, Leg{kCut, 1, 2, 2.5},
                          Leg{kCut, 1, 2, 1}, Leg{kFast, 1.5, 2, 1}, Leg{kFast, 1.5, 2, 5},
                          Leg{kFast, 1, 2, 5}));
}

// Whatever the modal path mode is, the holes are on the exact path; it comes back after them.
TEST(Drilling, RunsOnTheExactPathAndGivesThePathModeBack) {
  const auto moves = moves_of("G64 P0.1\nG0 X1 Y2 Z3\nF60 G81 X4 Z1 R2\nG80 G0 X5\nM2\n");
  EXPECT_EQ(moves.front().path_mode, PathMode::continuous);
  EXPECT_EQ(moves.at(3).path_mode, PathMode::exact_path);
  EXPECT_EQ(moves.back().path_mode, PathMode::continuous);
}

TEST(Drilling, InInchesAndOtherPlanesGoesAlongTheNormal) {
  const auto moves = moves_of("G20 G19 G98\nG0 X1\nF10 G81 Y2 Z3 X-1 R0.5\nM2\n");
  EXPECT_DOUBLE_EQ(moves.at(1).end[1], 50.8);  // across at the initial level: Y2 Z3 in inches
  EXPECT_DOUBLE_EQ(moves.at(1).end[2], 76.2);
  EXPECT_EQ(moves.at(2).end[0], 12.7);
  EXPECT_EQ(moves.at(3).end[0], -25.4);
  EXPECT_EQ(moves.at(4).end[0], 25.4);
}

// Like rs274, a program starts in G99, without the initial level.
TEST(Drilling, ReturnsToTheRetractPlaneUntilG98) {
  EXPECT_EQ(legs_of("G0 Z3\nF60 G81 Z1 R2\nM2\n").back().z, 2.0);
  EXPECT_EQ(legs_of("G0 Z3\nF60 G98 G81 Z1 R2\nM2\n").back().z, 3.0);
  // An initial level below R: G98 never returns below R.
  EXPECT_EQ(legs_of("G0 Z1.5\nF60 G98 G81 Z1 R2\nM2\n").back().z, 2.0);
}

TEST(Drilling, IsRefusedByName) {
  const std::string head = "G0 Z3\nF60 S600 M3\n";
  const std::pair<const char*, const char*> cases[] = {
      {"G81 Z1", "cycle_word_missing"},
      {"G81 X1 R2", "cycle_word_missing"},
      {"G83 Z1 R2", "cycle_word_missing"},
      {"G82 Z1 R2", "cycle_word_missing"},
      {"G87 Z1 R2 I0 J0", "cycle_word_missing"},
      {"G83 Z1 R2 Q0", "out_of_range"},
      {"G81 Z2 R1", "retract_below_bottom"},
      {"G81 Z1 R2 A5", "axis_in_cycle"},
      {"G93 G81 Z1 R2 F1", "cycle_in_inverse_time"},
      {"G81 Z1 R2 L0", "out_of_range"},
      {"G74 Z1 R2", "spindle_direction"},
      {"M5\nG84 Z1 R2", "spindle_direction"},
      {"M5\nG86 Z1 R2 P0", "spindle_stands"},
      {"M5\nG87 Z1 R2 I0 J0 K2", "spindle_stands"},
      {"G18 G84 Y1 R2", "tapping_off_xy"},
      {"G84 Z1 R2 P-1", "out_of_range"},
      {"F0 G81 Z1 R2", "feed_missing"},
      {"G83 Z1 R2 Q0.000001", "out_of_range"}};
  for (const auto& [text, reason] : cases) {
    EXPECT_EQ(reason_of(head + text + "\nM2\n"), reason) << text;
  }
}

}  // namespace
}  // namespace steadyrest::nc::interpret
