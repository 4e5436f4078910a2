// SPDX-License-Identifier: Apache-2.0
// Arcs whose Fréchet distance is known in closed form.
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/nc/rewrite/tube/stretch.hpp>
#include <steadyrest/nc/rewrite/tube/test/made_moves.hpp>

namespace steadyrest::nc::rewrite {
namespace {

using interpret::Move;
using kernel::signal::Point;
using test::made_arc;
using test::made_line;

constexpr double kCircle_mm = 10.0;  ///< radius

/// Once round about X0 Y0.
Move made_circle(double radius_mm, int turns = 1, double rise_mm = 0.0, double height_mm = 0.0) {
  return made_arc({radius_mm, 0, height_mm}, {radius_mm, 0, height_mm + rise_mm}, {0, 0, height_mm},
                  turns);
}

/// Moves in place of one block are within the tube; how far they are.
struct ArcVerdict {
  ArcVerdict(double tube_mm, const Move& block, const std::vector<Move>& fresh) {
    Stretch stretch(tube_mm);
    stretch.begin(machine_point(block, block.start), machine_point(fresh[0], fresh[0].start));
    stretch.block(block);
    for (const Move& move : fresh) {
      stretch.fresh(move);
    }
    proved = !stretch.close().has_value();
    farthest_mm = stretch.farthest_mm();
  }
  bool proved = false;
  double farthest_mm = 0.0;
};

// Circles about one centre are as far apart as their radii. Promised: outside by 1 µm is refused,
// inside by a few hundredths of a µm is proved.
TEST(StretchOfArcs, CirclesAboutOneCentreAreAsFarAsTheirRadii) {
  for (const double wider_mm : {-0.3, -0.02, 0.02, 0.3}) {
    const std::vector<Move> fresh = {made_circle(kCircle_mm + wider_mm)};
    const ArcVerdict inside(std::abs(wider_mm) + 1e-4, made_circle(kCircle_mm), fresh);
    EXPECT_TRUE(inside.proved) << wider_mm;
    EXPECT_NEAR(inside.farthest_mm, std::abs(wider_mm), 1e-3);
    EXPECT_FALSE(ArcVerdict(std::abs(wider_mm) - 1e-3, made_circle(kCircle_mm), fresh).proved);
  }
}

// Circles that touch at their start are apart by twice the difference of their radii, opposite it.
TEST(StretchOfArcs, CirclesThatTouchAreApartOppositeIt) {
  constexpr double kWider_mm = 0.15;
  const Point start = {kCircle_mm, 0, 0};
  const std::vector<Move> wider = {made_arc(start, start, {-kWider_mm, 0, 0}, 1)};
  EXPECT_TRUE(ArcVerdict(2.0 * kWider_mm + 1e-4, made_circle(kCircle_mm), wider).proved);
  EXPECT_FALSE(ArcVerdict(2.0 * kWider_mm - 1e-3, made_circle(kCircle_mm), wider).proved);
}

TEST(StretchOfArcs, AHelixIsAsFarAsItWasLifted) {
  const Move helix = made_circle(kCircle_mm, 1, 5.0);
  const std::vector<Move> lifted = {made_circle(kCircle_mm, 1, 5.0, 0.2)};
  EXPECT_TRUE(ArcVerdict(0.2001, helix, lifted).proved);
  EXPECT_FALSE(ArcVerdict(0.199, helix, lifted).proved);
}

// A chord over the angle φ is at most R·(1 − cos φ/2) from its arc.
TEST(StretchOfArcs, ChordsAreAsFarAsTheirSagitta) {
  constexpr int kChords = 40;
  const auto corner = [](int i) {
    const double angle = 2.0 * std::numbers::pi * i / kChords;
    return Point{kCircle_mm * std::cos(angle), kCircle_mm * std::sin(angle), 0.0};
  };
  std::vector<Move> chords;
  for (int i = 0; i < kChords; ++i) {
    chords.push_back(made_line(corner(i), corner(i + 1)));
  }
  const double sagitta_mm = kCircle_mm * (1.0 - std::cos(std::numbers::pi / kChords));
  EXPECT_TRUE(ArcVerdict(sagitta_mm + 1e-4, made_circle(kCircle_mm), chords).proved);
  EXPECT_FALSE(ArcVerdict(sagitta_mm - 1e-3, made_circle(kCircle_mm), chords).proved);
}

// Every point of one is a point of the other, and yet a turn is missing, or the way round is wrong.
TEST(StretchOfArcs, ATurnLessAndTheOtherWayRoundAreOtherPaths) {
  const Move twice = made_circle(kCircle_mm, 2);
  EXPECT_TRUE(ArcVerdict(0.5, twice, {made_circle(kCircle_mm), made_circle(kCircle_mm)}).proved);
  EXPECT_FALSE(ArcVerdict(0.5, twice, {made_circle(kCircle_mm)}).proved);
  EXPECT_FALSE(ArcVerdict(0.5, made_circle(kCircle_mm), {made_circle(kCircle_mm, -1)}).proved);
}

}  // namespace
}  // namespace steadyrest::nc::rewrite
