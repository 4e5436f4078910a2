// SPDX-License-Identifier: Apache-2.0
// G5, G5.1 and G5.2 … G5.3 by LinuxCNC's manual ("G codes"): control points, and what is refused.
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>

#include <steadyrest/nc/interpret/test/moves.hpp>

namespace steadyrest::nc::interpret {
namespace {

using testing::ElementsAre;

using Points = std::vector<std::pair<double, double>>;

/// The control points of each spline: they live during the call only.
struct KeptSplines {
  std::vector<Points> splines;
  std::vector<std::vector<double>> weights;
  std::vector<int> orders;
  Axes end{};
};
struct SplineKeeper final : public Sink, public KeptSplines {
  void on_move(const Move& move) override {
    end = move.end;
    if (move.kind != MoveKind::spline) {
      return;
    }
    splines.emplace_back();
    weights.emplace_back();
    orders.push_back(move.spline_order);
    for (const SplinePoint& point : move.spline) {
      splines.back().emplace_back(point.x_mm, point.y_mm);
      weights.back().push_back(point.weight);
    }
  }
  void on_event(const Event& /*event*/) override {}
};

KeptSplines splines_of(const std::string& text) {
  SplineKeeper kept;
  const auto report = run_text("G21 G90 F100\n" + text + "\nM2\n", {}, kept);
  EXPECT_TRUE(report && report->refused.empty())
      << text << ": " << (report && !report->refused.empty() ? report->refused.front().text : "");
  return kept;
}

std::string spline_fault(const std::string& text) {
  return reason_of("G21 G90 F100\n" + text + "\nM2\n");
}

// The manual's N-shape: G5 I0 J3 P0 Q-3 X1 Y1, from the origin. I and J from the start, P and Q
// from the end.
TEST(Splines, CubicHasItsControlPointsFromBothEnds) {
  const auto kept = splines_of("G0 X0 Y0\nG5 I0 J3 P0 Q-3 X1 Y1");
  ASSERT_EQ(kept.splines.size(), 1U);
  EXPECT_EQ(kept.orders[0], 4);
  EXPECT_EQ(kept.splines[0], (Points{{0, 0}, {0, 3}, {1, -2}, {1, 1}}));
}

// "A second curvy N attached smoothly": without I and J the last P and Q are mirrored.
TEST(Splines, CubicGoesOnTangentially) {
  const auto kept = splines_of("G0 X0 Y0\nG5 I0 J3 P0 Q-3 X1 Y1\nG5 P0 Q-3 X2 Y2");
  ASSERT_EQ(kept.splines.size(), 2U);
  EXPECT_EQ(kept.splines[1], (Points{{1, 1}, {1, 4}, {2, -1}, {2, 2}}));
  // Another move in between ends it.
  EXPECT_EQ(spline_fault("G5 I0 J3 P0 Q-3 X1 Y1\nG5.1 X2 I0.5 J1\nG5 P0 Q-3 X3"), "spline_words");
}

// The manual's parabola: from X-2 Y4, G5.1 X2 I2 J-8.
TEST(Splines, QuadraticHasOneControlPointFromTheStart) {
  const auto kept = splines_of("G0 X-2 Y4\nG5.1 X2 I2 J-8");
  EXPECT_EQ(kept.orders, std::vector<int>{3});
  EXPECT_EQ(kept.splines[0], (Points{{-2, 4}, {0, -4}, {2, 4}}));
}

// The first G5.2 makes the present position a control point too; P is the weight.
TEST(Splines, NurbsCollectsItsPointsUntilG53) {
  const auto kept = splines_of("G0 X0 Y0\nG5.2 P1 L3 X0 Y1\nX1 Y2 P2\nX3 Y1 P0.5\nG5.3\nG0 X9");
  ASSERT_EQ(kept.splines.size(), 1U);
  EXPECT_EQ(kept.orders[0], 3);
  EXPECT_EQ(kept.splines[0], (Points{{0, 0}, {0, 1}, {1, 2}, {3, 1}}));
  EXPECT_THAT(kept.weights[0], ElementsAre(1, 1, 2, 0.5));
  EXPECT_EQ(kept.end[0], 9.0);
}

// rs274 (LinuxCNC 2.9) prints NURBS_FEED(4, ...) for it.
TEST(Splines, NurbsMayBeginWithTheWeightOfThePresentPosition) {
  const auto kept = splines_of("G0 X5 Y6\nG5.2 P2 L3\nX0 Y1 P1\nX1 Y2 P2\nX3 Y1 P0.5\nG5.3");
  ASSERT_EQ(kept.splines.size(), 1U);
  EXPECT_EQ(kept.orders[0], 3);
  EXPECT_EQ(kept.splines[0], (Points{{5, 6}, {0, 1}, {1, 2}, {3, 1}}));
  EXPECT_THAT(kept.weights[0], ElementsAre(2, 1, 2, 0.5));
}

TEST(Splines, AreInMillimetresInInchPrograms) {
  const auto kept = splines_of("G20 G0 X0 Y0\nG5.1 X2 Y0 I1 J1");
  EXPECT_EQ(kept.splines[0], (Points{{0, 0}, {25.4, 25.4}, {50.8, 0}}));
}

TEST(Splines, AreRefusedByName) {
  const std::pair<const char*, const char*> cases[] = {
      {"G5 I0 P0 Q-3 X1", "spline_words"},      // I without J
      {"G5 I0 J3 X1", "spline_words"},          // no P and Q
      {"G5 P0 Q-3 X1", "spline_words"},         // the first needs I and J
      {"G5.1 X2 I2", "spline_words"},           // no J
      {"G5.2 P1 L9 X1 Y1", "spline_words"},     // order 2 … 8
      {"G5.2 P1 L1 X1 Y1", "spline_words"},     //
      {"G5.2 L3 X1 Y1", "spline_words"},        // no weight
      {"G5.2 P0 L3 X1 Y1", "spline_words"},     // of nothing
      {"G5.2 P1 L3 X1", "spline_words"},        // X and Y, both
      {"G5.2 P1 L3 X1 Y1\nP1", "unused_word"},  // later ones too
      {"G5.2 P1 L3 X1 Y1\nP1 L3 X2 Y2", "spline_words"},
      {"G5.2 P1 L3 X1 Y1\nG5.3", "spline_words"},  // fewer points than the order
      {"G5.3", "spline_words"},
      {"G91 G5.2 P1 L3 X1 Y1\nX1 Y1 P1\nG5.3", "spline_words"},
      {"G18 G5 I0 J3 P0 Q-3 X1", "spline_off_xy"},
      {"G5.1 X2 Z1 I1 J1", "axis_in_spline"},
      {"G93 G5.1 X2 I1 J1 F1", "spline_in_inverse_time"},
      {"F0 G5.1 X2 I1 J1", "feed_missing"}};
  for (const auto& [text, reason] : cases) {
    EXPECT_EQ(spline_fault(text), reason) << text;
  }
}

}  // namespace
}  // namespace steadyrest::nc::interpret
