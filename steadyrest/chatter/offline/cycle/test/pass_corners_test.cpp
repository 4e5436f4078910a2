// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/chatter/offline/cycle/modal_answers.hpp>
#include <steadyrest/chatter/offline/test/cuts.hpp>

namespace steadyrest::chatter::offline {
namespace {

constexpr double kHalfTurn = std::numbers::pi;
constexpr double kDegrees = kHalfTurn / 180.0;

void expect_corners(const std::vector<double>& found, const std::vector<double>& degrees) {
  ASSERT_EQ(found.size(), degrees.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_NEAR(found[i], degrees[i] * kDegrees, 1e-9) << i;
  }
}

std::vector<double> corners_at(const Process& p, double pass_deg,
                               const std::vector<double>& others = {}) {
  return corners_of_pass(p, CuttingCoefficients(p, 0.0), pass_deg * kDegrees, others);
}

// Two teeth, a quarter of the diameter: each cuts from 0° to 60° of its half turn.
TEST(PassCorners, AreWhereAToothEntersAndLeaves) {
  const Process up = test::benchmark_cut(0.25, Direction::up);
  expect_corners(corners_at(up, 180.0), {0.0, 60.0, 180.0});
  expect_corners(corners_at(test::benchmark_cut(0.25, Direction::down), 180.0),
                 {0.0, 120.0, 180.0});
  expect_corners(corners_at(test::benchmark_cut(1.0, Direction::up), 180.0), {0.0, 180.0});
  // Those of the speed's law fold into the pass; one that is there already is no second corner.
  expect_corners(corners_at(up, 180.0, {200.0 * kDegrees, 240.0 * kDegrees, 355.0 * kDegrees}),
                 {0.0, 20.0, 60.0, 175.0, 180.0});
}

// Pitches of 150° and 210°: tooth 1 enters at 210° (tooth 0 at 0°) and leaves 60° later. A kink in
// the surface comes back with either tooth's delay: 0, 60, 210 and 270 once more 150 or 210 on.
TEST(PassCorners, OfUnevenPitchReturnWithEachDelay) {
  Process p = test::benchmark_cut(0.25, Direction::up);
  p.tool.pitch_rad = {150.0 * kDegrees, 210.0 * kDegrees};
  expect_corners(corners_at(p, 360.0), {0.0, 60.0, 120.0, 150.0, 210.0, 270.0, 360.0});
}

TEST(PassCuts, WhereverAToothIsInTheWork) {
  for (const double immersion : {0.25, 0.75}) {
    const Process p = test::benchmark_cut(immersion, Direction::up);
    const CuttingCoefficients coefficients(p, 0.0);
    const double leaves_deg = immersion < 0.5 ? 60.0 : 120.0;
    for (double deg = 1.0; deg < 180.0; deg += 2.0) {
      EXPECT_EQ(cuts_at(coefficients, kHalfTurn, deg * kDegrees), deg < leaves_deg) << deg;
    }
  }
  // Four teeth as far in the work: one leaves at 120°, after the next has entered at 90°.
  Process four = test::benchmark_cut(0.75, Direction::up);
  four.tool.teeth = 4;
  const CuttingCoefficients coefficients(four, 0.0);
  for (double deg = 1.0; deg < 90.0; deg += 2.0) {
    EXPECT_TRUE(cuts_at(coefficients, 0.5 * kHalfTurn, deg * kDegrees)) << deg;
  }
}

TEST(PassDirections, AreTwoOnceAModeMovesAlongY) {
  Process p = test::benchmark_cut(0.25, Direction::up);
  EXPECT_EQ(directions(p), 1);
  p.modes.push_back(p.modes[0]);
  p.modes[1].shape = {0.8, 0.6};
  EXPECT_EQ(directions(p), 2);
}

}  // namespace
}  // namespace steadyrest::chatter::offline
