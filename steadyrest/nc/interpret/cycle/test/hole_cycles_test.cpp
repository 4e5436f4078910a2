// SPDX-License-Identifier: Apache-2.0
// Deep holes, boring, tapping and patterns of holes of the dialect `sinumerik`.
#include <cmath>
#include <random>
#include <string>

#include <fmt/core.h>
#include <gmock/gmock.h>

#include <steadyrest/kernel/testing/cases.hpp>
#include <steadyrest/nc/interpret/test/moves.hpp>
#include <steadyrest/nc/interpret/test/sinumerik.hpp>

namespace steadyrest::nc::interpret {
namespace {

using test::along;
using test::reason_of_block;
using test::sinumerik;
using testing::DoubleNear;
using testing::ElementsAre;
using testing::Pointwise;

// Manual "Cycles", CYCLE83, with the values of its example: 150 − 100 = 50, then 30, 20 and 20; the
// last 25 are at most twice 20, so two strokes share them. 1 mm back to break the chips.
TEST(DeepHole, HasTheStrokesOfTheManual) {
  EXPECT_THAT(along(2, "F100 G0 Z155\nCYCLE83(155,150,1,5,0,100,,20,0,0,1,0)\nM30\n"),
              ElementsAre(155, 151, 100, 101, 70, 71, 50, 51, 30, 31, 17.5, 18.5, 5, 155));
}

// With the chips out: up to the safety clearance, down to the last depth but 90/50 = 1.8 mm.
TEST(DeepHole, LiftsTheChipsOut) {
  const auto moves =
      moves_of("F600 G0 Z155\nCYCLE83(155,150,1,60,,,50,0,1,2,0.5,1)\nM30\n", sinumerik());
  std::vector<double> z;
  std::vector<double> waits;
  for (const Move& move : moves) {
    if (move.kind == MoveKind::dwell) {
      waits.push_back(move.dwell_s);
    } else {
      z.push_back(move.end[2]);
    }
  }
  EXPECT_THAT(z, ElementsAre(155, 151, 100, 151, 101.8, 60, 155));
  EXPECT_THAT(waits, ElementsAre(1, 2, 1));
  EXPECT_DOUBLE_EQ(moves[2].feed_mm_s, 5.0);  // FRF: half of 10 mm/s
}

// Whatever the values, the strokes lead to the depth, none is longer than the first, and none
// shorter than half the degression but the last one of a rest.
TEST(DeepHole, ReachesItsDepthByStrokesThatDoNotGrow) {
  std::mt19937 engine{83};
  const auto draw = [&](double least, double most) {
    return std::round(std::uniform_real_distribution(least, most)(engine) * 100.0) / 100.0;
  };
  const int programs = kernel::testing::kSanitized ? 100 : 10'000;
  for (int i = 0; i < programs; ++i) {
    const double depth = draw(2, 150);
    const double first = draw(0.5, depth);
    const double degression = i % 3 == 0 ? 0.0 : draw(0.2, 20);
    const bool out = i % 2 == 0;
    const std::string text = fmt::format("F100 G0 Z20\nCYCLE83(10,0,1,,{},,{},{},0,0,1,{})\nM30\n",
                                         depth, first, degression, out ? 1 : 0);
    double deepest = 0.0;
    double before = first;
    for (const Move& move : moves_of(text, sinumerik())) {
      if (move.kind == MoveKind::linear && move.end[2] < deepest) {
        const double stroke = deepest - move.end[2];
        EXPECT_LE(stroke, std::max(before, degression) + 1e-9) << text;
        before = stroke;
        deepest = move.end[2];
      }
    }
    EXPECT_EQ(deepest, -depth) << text;
  }
}

TEST(DeepHole, IsRefusedByWhatItDoesNotSay) {
  const auto of = [](const std::string& values) {
    return reason_of_block("F100\nCYCLE83(" + values + ")");
  };
  EXPECT_EQ(of("10,0,1,-20"), "cycle_word_missing");
  EXPECT_EQ(of("10,0,1,-20,,-30"), "cycle_planes");
  EXPECT_EQ(of("10,0,1,-20,,-5,6"), "cycle_depth");
  EXPECT_EQ(of("10,0,1,-20,,-5,,-0.8"), "cycle_value");
  EXPECT_EQ(of("10,0,1,-20,,-5,,2,-3"), "out_of_range");
  EXPECT_EQ(of("10,0,1,-20,,-5,,2,0,0,1,2"), "cycle_value");
  EXPECT_EQ(of("10,0,1,-20,,-0.0001"), "out_of_range");
  EXPECT_EQ(of("10,0,1,-20,,-5,,2,0,0,1,0,3"), "");  // the axis of G17
  EXPECT_EQ(of("10,0,1,-20,,-5,,2,0,0,1,0,1"), "cycle_value");
}

// "Job planning", "Programming cycles externally": _GMODE, _DMODE and _AMODE.
TEST(DrillingModes, AreReadWhereTheyRepeatTheOtherValues) {
  const auto of = [](const std::string& call) { return reason_of_block("F100\n" + call); };
  EXPECT_EQ(of("CYCLE81(10,0,2,-5,,0.5,0,1,12)"), "");
  EXPECT_EQ(of("CYCLE82(10,0,2,,5,0.5,0,1,11)"), "");
  EXPECT_EQ(of("CYCLE81(10,0,2,-5,,0,10,1,12)"), "cycle_value");  // to a diameter
  EXPECT_EQ(of("CYCLE81(10,0,2,-5,,0,0,2,12)"), "cycle_value");   // G18
  EXPECT_EQ(of("CYCLE81(10,0,2,-5,,0,0,1,11)"), "cycle_value");   // incremental, but DP
  EXPECT_EQ(of("CYCLE81(10,0,2,-5,,0,0,1,22)"), "cycle_value");   // revolutions
  EXPECT_EQ(of("CYCLE83(10,0,2,-9,,-5,,0,0,0,1,0,0,0,0,0,0,0,1,21112)"), "");
  EXPECT_EQ(of("CYCLE83(10,0,2,-9,,-5,,0,0,0,1,0,0,0,0,0,0,0,1,11112)"), "cycle_value");
  EXPECT_EQ(of("CYCLE83(10,0,2,-9,,-5,,0,0,0,1,0,0,0,0,0,0,0,1,1021112)"), "cycle_value");
}

// CYCLE87 and 88 stop the spindle and the program; CYCLE89 comes out at the feed.
TEST(Boring, EndsAsTheManualSays) {
  Kept kept;
  const auto report =
      run_text("F60 S300\nG0 Z20\nCYCLE88(20,10,2,-5,,1.5,4)\nM30\n", sinumerik(), kept);
  ASSERT_TRUE(report && report->refused.empty());
  ASSERT_EQ(kept.moves.size(), 5U);
  EXPECT_DOUBLE_EQ(kept.moves[2].spindle_rev_s, -5.0);
  EXPECT_EQ(kept.moves[3].dwell_s, 1.5);
  EXPECT_EQ(kept.moves[4].spindle_rev_s, 0.0);
  EXPECT_EQ(kept.moves[4].kind, MoveKind::rapid);
  ASSERT_EQ(kept.events.size(), 4U);
  EXPECT_EQ(kept.events[2].kind, EventKind::stop);
  EXPECT_THAT(along(2, "F60 G0 Z20\nCYCLE87(20,10,2,-5,,3)\nM30\n"), ElementsAre(20, 12, -5, 20));
  const auto back = moves_of("F60 G0 Z20\nCYCLE89(20,10,2,-5,,0.5)\nM30\n", sinumerik());
  ASSERT_EQ(back.size(), 6U);
  EXPECT_EQ(back[4].kind, MoveKind::linear);
  EXPECT_EQ(back[4].end[2], 12.0);
}

// CYCLE840: the feed follows the spindle, which reverses by itself (SDR 0).
TEST(FloatingTap, FollowsTheSpindle) {
  const auto moves =
      moves_of("S300 M3 F10\nG0 Z20\nCYCLE840(20,10,2,-5,,,0,,0,8)\nG1 X1\nM30\n", sinumerik());
  ASSERT_EQ(moves.size(), 6U);
  EXPECT_EQ(moves[2].kind, MoveKind::thread);
  EXPECT_DOUBLE_EQ(moves[2].feed_mm_s, 1.25);  // M8, ISO 261
  EXPECT_DOUBLE_EQ(moves[2].spindle_rev_s, 5.0);
  EXPECT_DOUBLE_EQ(moves[3].spindle_rev_s, -5.0);
  EXPECT_EQ(moves[3].end[2], 12.0);
  EXPECT_DOUBLE_EQ(moves[5].spindle_rev_s, 5.0);
  EXPECT_DOUBLE_EQ(moves[5].feed_mm_s, 10.0 / 60.0);
  EXPECT_EQ(reason_of_block("S300\nCYCLE840(20,10,2,-5,,,0,,0,8)"), "speed_missing");
  EXPECT_EQ(reason_of_block("S300 M3\nCYCLE840(20,10,2,-5)"), "pitch_missing");
  EXPECT_EQ(reason_of_block("S300 M3\nCYCLE840(20,10,2,-5,,,4,,0,8)"), "bad_value");
}

std::vector<double> holes_along(std::size_t axis, const std::string& text) {
  std::vector<double> out;
  for (const Move& move : moves_of(text, sinumerik())) {
    if (move.kind == MoveKind::linear) {
      out.push_back(move.end[axis]);
    }
  }
  return out;
}

// Manual "Cycles", HOLES1: five holes from (20, 30) along 0°, the first 10 off, 20 apart; from the
// nearer end.
TEST(Holes, AreDrilledInARowFromTheNearerEnd) {
  const std::string drill = "F90 G0 Z50\nMCALL CYCLE81(50,0,2,-10)\n";
  const std::string row = "HOLES1(20,30,0,10,20,5)\nMCALL\nM30\n";
  EXPECT_THAT(holes_along(0, drill + row), ElementsAre(30, 50, 70, 90, 110));
  EXPECT_THAT(holes_along(0, "G0 X200 Y30\n" + drill + row), ElementsAre(110, 90, 70, 50, 30));
  EXPECT_THAT(holes_along(1, drill + "HOLES1(20,30,90,10,20,2)\nM30\n"),
              Pointwise(DoubleNear(1e-9), {40.0, 60.0}));
  EXPECT_THAT(holes_along(2, drill + row), ElementsAre(-10, -10, -10, -10, -10));
  EXPECT_EQ(reason_of_block("HOLES1(20,30,0,10,20,0)"), "out_of_range");
  EXPECT_EQ(reason_of_block("HOLES1(20,30,0,10,20,2.5)"), "out_of_range");
  EXPECT_EQ(reason_of_block("HOLES1(20,30,0,10,20,2,1)"), "cycle_value");
  EXPECT_EQ(reason_of_block("MCALL HOLES1(20,30,0,10,20,2)"), "modal_call");
}

// HOLES2: four holes on the radius 42 about (70, 60) from 33°, all around.
TEST(Holes, AreDrilledOnACircle) {
  const std::string text =
      "F90 G0 Z50\nMCALL CYCLE81(50,0,2,-10)\nHOLES2(70,60,42,33,0,4)\nMCALL\nM30\n";
  const double c = 42.0 * std::cos(33.0 * std::numbers::pi / 180.0);
  const double s = 42.0 * std::sin(33.0 * std::numbers::pi / 180.0);
  EXPECT_THAT(holes_along(0, text),
              Pointwise(DoubleNear(1e-9), {70.0 + c, 70.0 - s, 70.0 - c, 70.0 + s}));
  EXPECT_THAT(holes_along(1, text),
              Pointwise(DoubleNear(1e-9), {60.0 + s, 60.0 + c, 60.0 - s, 60.0 - c}));
  EXPECT_EQ(reason_of_block("HOLES2(70,60,0,33,0,4)"), "out_of_range");
}

}  // namespace
}  // namespace steadyrest::nc::interpret
