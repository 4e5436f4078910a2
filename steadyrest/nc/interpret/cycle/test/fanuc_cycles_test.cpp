// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include <steadyrest/nc/interpret/test/moves.hpp>

// Cycles that FANUC and Haas have and LinuxCNC has not, move by move as their manuals draw them.
namespace steadyrest::nc::interpret {
namespace {

using testing::ElementsAre;
using testing::ElementsAreArray;

Config cycling(read::Dialect dialect) {
  Config config;
  config.dialect = dialect;
  config.unit_known = true;
  return config;
}
const Config kFanucCycles = cycling(read::Dialect::fanuc);
const Config kHaasCycles = cycling(read::Dialect::haas);

const std::string kOver = "G21 G17 G90 G0 X0 Y0 Z10. F60. S600 M3\n";

std::vector<double> heights(const std::string& text, const Config& config = kFanucCycles) {
  std::vector<double> out;
  for (const Move& move : moves_of(kOver + text + "\nM30\n", config)) {
    if (move.kind != MoveKind::dwell) {
      out.push_back(move.end[2]);
    }
  }
  out.erase(out.begin());
  return out;
}

std::string cycle_fault(const std::string& text, const Config& config = kFanucCycles) {
  return reason_of(kOver + text + "\nM30\n", config);
}

TEST(FanucFineBoring, LeavesTheWallBeforeItComesOut) {
  Kept kept;
  const auto report =
      run_text(kOver + "G99 G76 X5. Z-8. R2. Q0.5 P1000\nM30\n", kFanucCycles, kept);
  ASSERT_TRUE(report && report->refused.empty());
  std::vector<double> xs;
  std::vector<double> zs;
  for (const Move& move : kept.moves) {
    xs.push_back(move.end[0]);
    zs.push_back(move.end[2]);
  }
  EXPECT_THAT(xs, ElementsAre(0, 5, 5, 5, 5, 5.5, 5.5, 5));
  EXPECT_THAT(zs, ElementsAre(10, 10, 2, -8, -8, -8, 2, 2));
  EXPECT_EQ(kept.moves[4].dwell_s, 1.0);
  std::vector<double> spindle;
  for (const Event& event : kept.events) {
    if (event.kind == EventKind::spindle) {
      spindle.push_back(event.value);
    }
  }
  EXPECT_THAT(spindle, ElementsAre(10, 0, 10)) << "off the wall and out with it oriented";
  ASSERT_EQ(report->assumed.size(), 1U);
  EXPECT_EQ(report->assumed.front().what, "shift_direction");
  EXPECT_EQ(cycle_fault("M5\nG76 X5. Z-8. R2. Q0.5"), "spindle_stands");
  EXPECT_EQ(cycle_fault("G76 X5. Z-8. R2."), "cycle_word_missing");
}

TEST(FanucBackBoring, GoesInToRAndCutsUpToZ) {
  EXPECT_THAT(heights("G87 X5. Z-4. R-12. Q1. F60"), ElementsAre(10, 10, -12, -12, -4, -4, 10, 10));
  EXPECT_EQ(cycle_fault("G87 X5. Z-14. R-12. Q1."), "retract_below_bottom");
}

TEST(FanucCycles, WaitAtTheBottomOfThePecksWhereTheySay) {
  const auto moves = moves_of(kOver + "G83 X5. Z-3. R2. Q5. P500\nM30\n", kFanucCycles);
  EXPECT_EQ(moves.at(moves.size() - 2).dwell_s, 0.5);
}

TEST(FanucCycles, TapRigidlyByTheirOwnCodes) {
  for (const char* code : {"G84.2", "G84.3"}) {
    EXPECT_THAT(heights(std::string(code) + " X5. Z-8. R2. F600."), ElementsAre(10, 2, -8, 10));
  }
}

// Haas, "G83 Normal peck drilling": the first peck I, each next one less by J, at least K.
TEST(HaasPecks, GrowSmallerDownToTheLeast) {
  EXPECT_THAT(heights("G99 G73 X5. Z-10. R0 I4. J1. K2.", kHaasCycles),
              ElementsAre(10, 0, -4, -3.746, -7, -6.746, -9, -8.746, -10, 0));
  EXPECT_EQ(cycle_fault("G83 X5. Z-10. R0 I4. J1.", kHaasCycles), "peck_words");
  EXPECT_EQ(cycle_fault("G83 X5. Z-10. R0 Q4. K1.", kHaasCycles), "peck_words");
  EXPECT_EQ(cycle_fault("G83 X5. Z-10. R0 I4. J1. K1.", kFanucCycles), "unused_word");
}

TEST(HaasTapping, TurnsTheSpindleItself) {
  EXPECT_THAT(heights("M5\nG84 X5. Z-8. R2. F600.", kHaasCycles), ElementsAre(10, 2, -8, 10));
  const auto moves = moves_of(kOver + "G84 X5. Z-8. R2. F600. J2.\nM30\n", kHaasCycles);
  EXPECT_NEAR(moves.back().feed_mm_s, 20.0, 1e-12) << "out twice as fast";
}

// Haas, "G70 Bolt hole circle", "G71 Bolt hole arc".
TEST(HaasPatterns, DrillRoundTheToolsPlaceAndNotInIt) {
  const auto holes = [](const std::string& text) {
    std::vector<std::pair<double, double>> out;
    for (const Move& move : moves_of(kOver + text + "\nM30\n", kHaasCycles)) {
      if (move.kind == MoveKind::linear) {
        out.emplace_back(std::round(move.end[0] * 1e6) / 1e6, std::round(move.end[1] * 1e6) / 1e6);
      }
    }
    return out;
  };
  const auto wanted = ElementsAre(std::pair{11.0, 2.0}, std::pair{1.0, 12.0}, std::pair{-9.0, 2.0},
                                  std::pair{1.0, -8.0});
  EXPECT_THAT(holes("X1. Y2.\nG81 G99 Z-3. R2. F60. L0\nG70 I10. J0 L4"), wanted);
  EXPECT_THAT(holes("X1. Y2.\nG81 G99 Z-3. R2. F60. G70 I10. J0 L4"), wanted);
  EXPECT_THAT(holes("G81 G99 Z-3. R2. F60. L0\nG70 X1. Y2. I10. J0 L4"), wanted);
  EXPECT_THAT(holes("X1. Y2.\nG81 G99 Z-3. R2. F60. L0\nG71 I10. J90. K-90. L2"),
              ElementsAre(std::pair{1.0, 12.0}, std::pair{11.0, 2.0}));
  EXPECT_THAT(holes("X1. Y2.\nG81 G99 Z-3. R2. F60. L0\nG70 I-10. J0 L4").at(1),
              (std::pair{1.0, -8.0}));
  EXPECT_EQ(cycle_fault("G70 I10. J0 L4", kHaasCycles), "pattern_without_cycle");
  EXPECT_EQ(cycle_fault("G81 Z-1. R1. F9. L0\nG70 I10. J0", kHaasCycles), "cycle_word_missing");
  EXPECT_EQ(cycle_fault("G81 Z-1. R1. F9. L0\nG72 I10. J0 L3", kHaasCycles),
            "g_code_not_interpreted");
  EXPECT_EQ(cycle_fault("G81 Z-1. R1. F9. K0\nG70 I10. J0 L3"), "lathe_code");
}

// K on FANUC and L on Haas repeat a cycle along increments.
TEST(HaasCycles, RepeatByL) {
  EXPECT_THAT(heights("G91 G99 G81 X5. Z-3. R-8. L2", kHaasCycles),
              ElementsAreArray(heights("G91 G99 G81 X5. Z-3. R-8. K2")));
}

TEST(HaasDwell, IsInSecondsWhereItHasAPoint) {
  for (const auto& [text, seconds] :
       {std::pair{"G4 P1.5", 1.5}, std::pair{"G4 P1500", 1.5}, std::pair{"G4 P2", 0.002}}) {
    EXPECT_EQ(moves_of(kOver + text + "\nM30\n", kHaasCycles).back().dwell_s, seconds) << text;
  }
  EXPECT_EQ(moves_of(kOver + "G82 X1. Z-1. R1. P0.5\nM30\n", kHaasCycles).at(4).dwell_s, 0.5);
}

}  // namespace
}  // namespace steadyrest::nc::interpret
