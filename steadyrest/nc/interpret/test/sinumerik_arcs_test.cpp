// SPDX-License-Identifier: Apache-2.0
// Arcs of the dialect `sinumerik` that give no centre, and polar coordinates.
#include <cmath>
#include <numbers>
#include <random>
#include <string>

#include <fmt/core.h>
#include <gmock/gmock.h>

#include <steadyrest/kernel/testing/cases.hpp>
#include <steadyrest/nc/interpret/test/moves.hpp>
#include <steadyrest/nc/interpret/test/sinumerik.hpp>

namespace steadyrest::nc::interpret {
namespace {

using test::reason_of_block;
using test::sinumerik;

constexpr int kArcs = kernel::testing::kSanitized ? 200 : 10'000;
/// Values are written with nine decimals.
constexpr double kWritten_mm = 1e-5;

std::vector<Move> arcs_of(const std::string& text) {
  return moves_of("G17 G71 G90 F100\n" + text + "\nM30\n", sinumerik());
}

struct Circle {
  double x, y, radius;
  [[nodiscard]] double x_at(double angle) const { return x + radius * std::cos(angle); }
  [[nodiscard]] double y_at(double angle) const { return y + radius * std::sin(angle); }
};

class Draw {
 public:
  double number(double least, double most) {
    return std::uniform_real_distribution(least, most)(engine_);
  }
  Circle circle() {
    return {.x = number(-100, 100), .y = number(-100, 100), .radius = number(1, 50)};
  }
  double angle() { return number(-std::numbers::pi, std::numbers::pi); }
  bool coin() { return number(0, 1) < 0.5; }

 private:
  std::mt19937 engine_{20261130};
};

void expect_centre(const Move& move, const Circle& circle, const std::string& text) {
  EXPECT_EQ(move.kind, MoveKind::arc) << text;
  EXPECT_NEAR(move.centre_mm[0], circle.x, kWritten_mm * circle.radius) << text;
  EXPECT_NEAR(move.centre_mm[1], circle.y, kWritten_mm * circle.radius) << text;
}

// Three points of a circle drawn at random give its centre back, and the sense in which the middle
// one lies between the others.
TEST(SinumerikCip, FindsTheCircleThroughThreePoints) {
  Draw draw;
  for (int i = 0; i < kArcs; ++i) {
    const Circle circle = draw.circle();
    const double start = draw.angle();
    const double sense = draw.coin() ? 1.0 : -1.0;
    const double sweep = draw.number(0.3, 6.0);
    const double end = start + sense * sweep;
    const double way = start + sense * sweep * draw.number(0.2, 0.8);
    const double x = circle.x_at(start);
    const double y = circle.y_at(start);
    const int form = i % 3;  // absolute, AC( ) in G91, incremental: both from the start
    const double from_x = form == 2 ? x : 0.0;
    const double from_y = form == 2 ? y : 0.0;
    const std::string text = fmt::format(
        "G0 X={:.9f} Y={:.9f}\n{} CIP X={}({:.9f}) Y={}({:.9f}) I1={}({:.9f}) J1={}({:.9f})", x, y,
        form == 1 ? "G91" : "G90", form == 2 ? "IC" : "AC", circle.x_at(end) - from_x,
        form == 2 ? "IC" : "AC", circle.y_at(end) - from_y, form == 2 ? "IC" : "AC",
        circle.x_at(way) - from_x, form == 2 ? "IC" : "AC", circle.y_at(way) - from_y);
    const auto moves = arcs_of(text);
    ASSERT_EQ(moves.size(), 2U) << text;
    expect_centre(moves[1], circle, text);
    EXPECT_EQ(moves[1].turns, sense > 0.0 ? 1 : -1) << text;
  }
}

// "Fundamentals", CIP: modal, and in G91 all points count from the start.
TEST(SinumerikCip, IsModalAndFollowsG91) {
  const auto moves = arcs_of("G0 X0 Y0\nCIP X20 Y0 I1=10 J1=10\nG91 X20 Y0 I1=10 J1=-10\nG1 X1");
  ASSERT_EQ(moves.size(), 4U);
  EXPECT_NEAR(moves[1].centre_mm[0], 10.0, 1e-12);
  EXPECT_NEAR(moves[1].centre_mm[1], 0.0, 1e-12);
  EXPECT_EQ(moves[1].turns, -1);
  EXPECT_NEAR(moves[2].centre_mm[0], 30.0, 1e-12);
  EXPECT_EQ(moves[2].turns, 1);
  EXPECT_EQ(moves[2].end[0], 40.0);
}

TEST(SinumerikCip, IsRefusedWithoutOneCircleInThePlane) {
  const std::string head = "F100 G0 X0 Y0 Z0\n";
  EXPECT_EQ(reason_of_block(head + "CIP X2 Y2 I1=1 J1=1"), "arc_way_in_line");
  EXPECT_EQ(reason_of_block(head + "CIP X0 Y0 I1=1 J1=1"), "arc_way_in_line");
  EXPECT_EQ(reason_of_block(head + "CIP X2 Y2 I1=1"), "arc_way_missing");
  EXPECT_EQ(reason_of_block(head + "CIP X2 Y2"), "arc_way_missing");
  EXPECT_EQ(reason_of_block(head + "CIP X2 Y2 Z1 I1=1 J1=2"), "arc_off_plane");
  EXPECT_EQ(reason_of_block(head + "CIP X2 Y2 I1=1 J1=2 K1=3"), "arc_off_plane");
  EXPECT_EQ(reason_of_block(head + "G1 X2 I1=1 J1=2"), "unused_word");
  EXPECT_EQ(reason_of_block(head + "CIP X2 Y2 CR=3 I1=1 J1=2"), "unused_word");
}

// An arc that touches the line before it: its centre lies on the perpendicular at the start.
TEST(SinumerikCt, TouchesTheLineBeforeIt) {
  Draw draw;
  for (int i = 0; i < kArcs; ++i) {
    const Circle circle = draw.circle();
    const double start = draw.angle();
    const double sense = draw.coin() ? 1.0 : -1.0;
    const double end = start + sense * draw.number(0.2, 6.0);
    const double way = draw.number(5.0, 50.0);
    // Against the direction of travel along the tangent.
    const double before_x = circle.x_at(start) + sense * way * std::sin(start);
    const double before_y = circle.y_at(start) - sense * way * std::cos(start);
    const std::string text = fmt::format(
        "G0 X={:.9f} Y={:.9f}\nG1 X={:.9f} Y={:.9f}\nCT X={:.9f} Y={:.9f}", before_x, before_y,
        circle.x_at(start), circle.y_at(start), circle.x_at(end), circle.y_at(end));
    const auto moves = arcs_of(text);
    ASSERT_EQ(moves.size(), 3U) << text;
    EXPECT_NEAR(moves[2].centre_mm[0], circle.x, 2e-4 * circle.radius) << text;
    EXPECT_NEAR(moves[2].centre_mm[1], circle.y, 2e-4 * circle.radius) << text;
    EXPECT_EQ(moves[2].turns, sense > 0.0 ? 1 : -1) << text;
  }
}

// A half circle, then a tangential one on: the direction at the end of an arc counts.
TEST(SinumerikCt, TouchesTheArcBeforeIt) {
  const auto moves = arcs_of("G0 X0 Y0\nG3 X20 Y0 I10 J0\nCT X40 Y0\nCT Y-10 X50");
  ASSERT_EQ(moves.size(), 4U);
  EXPECT_NEAR(moves[2].centre_mm[0], 30.0, 1e-9);
  EXPECT_NEAR(moves[2].centre_mm[1], 0.0, 1e-9);
  EXPECT_EQ(moves[2].turns, -1);
  EXPECT_NEAR(moves[3].centre_mm[0], 50.0, 1e-9);
  EXPECT_NEAR(moves[3].centre_mm[1], 0.0, 1e-9);
  EXPECT_EQ(moves[3].turns, 1);
}

TEST(SinumerikCt, IsALineAlongTheTangentAndNeedsADirection) {
  const auto moves = arcs_of("G0 X0 Y0\nG1 X10 Y10\nCT X20 Y20");
  EXPECT_EQ(moves.at(2).kind, MoveKind::linear);
  EXPECT_EQ(moves.at(2).end[0], 20.0);
  EXPECT_EQ(reason_of_block("F100\nCT X20 Y20"), "arc_tangent_missing");
  EXPECT_EQ(reason_of_block("F100 G0 X5\nZ5\nCT X20 Y20"), "arc_tangent_missing");
  EXPECT_EQ(reason_of_block("F100 G1 X5\nROT Z30\nCT X20 Y20"), "arc_tangent_missing");
  EXPECT_EQ(reason_of_block("F100 G1 X5\nCT X1"), "arc_zero_radius");
}

// The angle of an arc from its end, and its end from the angle and the centre.
TEST(SinumerikAr, GivesTheCentreOrTheEnd) {
  Draw draw;
  for (int i = 0; i < kArcs; ++i) {
    const Circle circle = draw.circle();
    const double start = draw.angle();
    const double sense = draw.coin() ? 1.0 : -1.0;
    const double sweep = draw.number(0.2, 6.0);
    const double end = start + sense * sweep;
    const bool by_end = draw.coin();
    const std::string where =
        by_end ? fmt::format("X={:.9f} Y={:.9f}", circle.x_at(end), circle.y_at(end))
               : fmt::format("I={:.9f} J={:.9f}", circle.x - circle.x_at(start),
                             circle.y - circle.y_at(start));
    const std::string text =
        fmt::format("G0 X={:.9f} Y={:.9f}\n{} {} AR={:.9f}", circle.x_at(start), circle.y_at(start),
                    sense > 0.0 ? "G3" : "G2", where, sweep * 180.0 / std::numbers::pi);
    const auto moves = arcs_of(text);
    ASSERT_EQ(moves.size(), 2U) << text;
    expect_centre(moves[1], circle, text);
    EXPECT_NEAR(moves[1].end[0], circle.x_at(end), kWritten_mm) << text;
    EXPECT_NEAR(moves[1].end[1], circle.y_at(end), kWritten_mm) << text;
    EXPECT_EQ(moves[1].turns, sense > 0.0 ? 1 : -1) << text;
  }
  EXPECT_EQ(reason_of_block("F100 G2 X5 I3 AR=30"), "arc_centre_twice");
  EXPECT_EQ(reason_of_block("F100 G2 AR=30"), "arc_centre_twice");
  EXPECT_EQ(reason_of_block("F100 G2 X5 AR=360"), "out_of_range");
  EXPECT_EQ(reason_of_block("F100 G2 X0 Y0 AR=30"), "arc_without_chord");
}

// "Fundamentals", poles: the example of the manual has the poles (20, 10), (20 + 50 cos 30° − 10,
// 10 + 50 sin 30° + 20) and 40, 20 further.
TEST(SinumerikPolar, CountsFromThePoleInForce) {
  const double c30 = std::cos(std::numbers::pi / 6);
  const double h = std::sqrt(0.5) * 30.0;
  const auto moves = arcs_of(
      "G0 X0 Y0\nG111 X20 Y10\nG1 RP=50 AP=30\nG110 X-10 Y20\nG1 RP=30 AP=45\nG112 X40 Y20\n"
      "G1 RP=30 AP=135\nAP=IC(-90)\nRP=10");
  ASSERT_EQ(moves.size(), 6U);
  const double pole_x = 20.0 + 50.0 * c30 - 10.0;
  EXPECT_NEAR(moves[1].end[0], 20.0 + 50.0 * c30, 1e-9);
  EXPECT_NEAR(moves[1].end[1], 35.0, 1e-9);
  EXPECT_NEAR(moves[2].end[0], pole_x + h, 1e-9);
  EXPECT_NEAR(moves[2].end[1], 55.0 + h, 1e-9);
  EXPECT_NEAR(moves[3].end[0], pole_x + 40.0 - h, 1e-9);
  EXPECT_NEAR(moves[3].end[1], 75.0 + h, 1e-9);
  EXPECT_NEAR(moves[4].end[0], pole_x + 40.0 + h, 1e-9);
  EXPECT_NEAR(moves[5].end[0], pole_x + 40.0 + h / 3.0, 1e-9);
}

// Holes on a circle by polar words and by their coordinates; of an arc the pole is the centre.
TEST(SinumerikPolar, IsTheSameAsItsCartesianTwin) {
  Draw draw;
  for (int i = 0; i < kArcs / 10; ++i) {
    const Circle circle = draw.circle();
    const double angle = draw.angle();
    const double degrees = angle * 180.0 / std::numbers::pi;
    const std::string text = fmt::format(
        "G111 X={:.9f} Y={:.9f}\nG0 RP={:.9f} AP={:.9f}\nG3 AP={:.9f}\nG91 G1 AP=10 Z-1", circle.x,
        circle.y, circle.radius, degrees, degrees + 100.0);
    const auto moves = arcs_of(text);
    ASSERT_EQ(moves.size(), 3U) << text;
    EXPECT_NEAR(moves[0].end[0], circle.x_at(angle), kWritten_mm) << text;
    EXPECT_NEAR(moves[0].end[1], circle.y_at(angle), kWritten_mm) << text;
    expect_centre(moves[1], circle, text);
    EXPECT_NEAR(moves[1].end[0], circle.x_at(angle + std::numbers::pi / 1.8), kWritten_mm) << text;
    EXPECT_NEAR(moves[2].end[0], circle.x_at(std::numbers::pi / 18.0), kWritten_mm) << text;
    EXPECT_EQ(moves[2].end[2], -1.0) << text;
  }
  const auto zx = arcs_of("G18\nG111 Z10 X5\nG0 RP=2 AP=90");
  EXPECT_NEAR(zx.at(0).end[2], 10.0, 1e-12);
  EXPECT_NEAR(zx.at(0).end[0], 7.0, 1e-12);
}

TEST(SinumerikPolar, IsRefusedWhereAValueIsNotKnown) {
  EXPECT_EQ(reason_of_block("G0 RP=5"), "polar_words");
  EXPECT_EQ(reason_of_block("G0 AP=5"), "polar_words");
  EXPECT_EQ(reason_of_block("G0 RP=5 AP=IC(5)"), "polar_words");
  EXPECT_EQ(reason_of_block("G0 RP=5 AP=5\nG111 X1\nRP=5"), "polar_words");
  EXPECT_EQ(reason_of_block("G0 RP=5 AP=5\nG18\nRP=5"), "polar_words");
  EXPECT_EQ(reason_of_block("G0 RP=5 AP=5 X3"), "polar_and_axis_words");
  EXPECT_EQ(reason_of_block("G0 RP=-5 AP=5"), "out_of_range");
  EXPECT_EQ(reason_of_block("G111 RP=5"), "polar_words");
  EXPECT_EQ(reason_of_block("G111 X1 G0"), "data_and_motion");
  EXPECT_EQ(reason_of_block("G111 G110 X1"), "same_modal_group");
}

// "Fundamentals", contour definitions: a straight line by an end coordinate and its angle.
TEST(SinumerikAng, GivesTheOtherAxisOfALine) {
  Draw draw;
  for (int i = 0; i < kArcs; ++i) {
    const double angle = draw.angle();
    const double way = draw.number(1, 100);
    const double x = draw.number(-50, 50);
    const double y = draw.number(-50, 50);
    const double end_x = x + way * std::cos(angle);
    const double end_y = y + way * std::sin(angle);
    const bool by_x = std::abs(std::cos(angle)) > 0.5;
    const bool adds = i % 2 == 0;
    const std::string text =
        fmt::format("G0 X={:.9f} Y={:.9f}\n{} G1 {}={:.9f} ANG={:.9f}", x, y, adds ? "G91" : "G90",
                    by_x ? "X" : "Y", (by_x ? end_x : end_y) - (adds ? (by_x ? x : y) : 0.0),
                    angle * 180.0 / std::numbers::pi);
    const auto moves = arcs_of(text);
    ASSERT_EQ(moves.size(), 2U) << text;
    EXPECT_NEAR(moves[1].end[0], end_x, kWritten_mm) << text;
    EXPECT_NEAR(moves[1].end[1], end_y, kWritten_mm) << text;
  }
  EXPECT_EQ(reason_of_block("G0 X5 ANG=180"), "contour_angle");
  EXPECT_EQ(reason_of_block("G0 X5 ANG=90"), "contour_angle");
  EXPECT_EQ(reason_of_block("G0 X5 Y5 ANG=45"), "contour_angle");
  EXPECT_EQ(reason_of_block("G0 ANG=45"), "contour_angle");
  EXPECT_EQ(reason_of_block("F9 G2 X5 CR=9 ANG=45"), "contour_angle");
}

}  // namespace
}  // namespace steadyrest::nc::interpret
