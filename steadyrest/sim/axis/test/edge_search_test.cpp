// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <utility>

#include <gtest/gtest.h>

#include <steadyrest/sim/axis/edge_search.hpp>
#include <steadyrest/sim/machine_body.hpp>

namespace steadyrest::sim {
namespace {

constexpr double kCount_mm = 0.001;
constexpr double kClock_s = 1e-7;

Encoder encoder_of(double line_error_mm) {
  kernel::machine::Encoder scale;
  scale.count_au = kCount_mm;
  scale.line_error_au = line_error_mm;
  scale.line_period_au = 4.0 * kCount_mm;
  return Encoder::make(scale).value();
}

std::optional<Passage> passage(const Encoder& encoder, const Stretch& stretch) {
  return last_passage(encoder, stretch, encoder.count(stretch.end_mm));
}

// At constant speed a floor() gives the last border before the end.
TEST(EdgeSearch, AtConstantSpeedTheLastLineIsWhereTheClosedFormHasIt) {
  const Encoder encoder = encoder_of(0.0);
  for (const double v : {3.7, -3.7, 123.4, -800.0}) {
    for (double x0 = 0.0; x0 < 0.002; x0 += 0.000137) {
      const double h = 0.001;
      const double x1 = x0 + v * h;
      const auto edge = passage(encoder, {h, x0, v, x1, v});
      ASSERT_TRUE(edge);
      EXPECT_EQ(edge->direction, v > 0.0 ? 1 : -1);
      const double n =
          v > 0.0 ? std::floor(x1 / kCount_mm + 0.5) : std::floor(x1 / kCount_mm + 1.5);
      EXPECT_NEAR(edge->before_end_s, (x1 - (n - 0.5) * kCount_mm) / v, 1e-12);
    }
  }
}

TEST(EdgeSearch, ThePassageIsWhereTheReadingWithItsLineErrorCrossesTheBorder) {
  const double error_mm = 0.0001;
  const Encoder encoder = encoder_of(error_mm);
  for (double x1 = 0.05; x1 < 0.06; x1 += 0.000037) {
    const double v = 1.9;
    const auto edge = passage(encoder, {0.001, x1 - 0.001 * v, v, x1, v});
    ASSERT_TRUE(edge);
    const double x = x1 - v * edge->before_end_s;
    const double seen = x + error_mm * std::sin(2.0 * std::numbers::pi * x / (4.0 * kCount_mm));
    const double beyond = seen / kCount_mm + 0.5 - std::round(seen / kCount_mm + 0.5);
    EXPECT_NEAR(beyond, 0.0, 1e-8) << x1;
    EXPECT_LE(x1 - x, 1.2 * kCount_mm) << "a later line was missed";
  }
}

/// x = v·t − a·t²/2 crosses a line and comes back across it.
TEST(EdgeSearch, SeesALineThatIsPassedThereAndBack) {
  const Encoder encoder = encoder_of(0.0);
  const double h = 0.004;
  const double a = 500.0;
  const double v = 0.5 * a * h;
  const auto edge = passage(encoder, {h, 0.0, v, 0.0, -v});
  ASSERT_TRUE(edge);
  EXPECT_EQ(edge->direction, -1);
  // The last line on the way back is the first above 0, ½ count: v·t − a·t²/2 = q/2.
  const double t = (v + std::sqrt(v * v - a * kCount_mm)) / a;
  EXPECT_NEAR(edge->before_end_s, h - t, 1e-11);
  EXPECT_FALSE(passage(encoder, {h, 0.0, 0.1, 0.0, -0.1})) << "turns below the line";
}

// Not even where the line error has a slope.
TEST(EdgeSearch, StandstillHasNoEdge) {
  EXPECT_FALSE(passage(encoder_of(0.0001), {0.001, 0.0123, 0.0, 0.0123, 0.0}));
}

/// One axis that follows its command by full feed-forward: at next to no gain the position loop's
/// counts do not move it.
kernel::machine::Machine follower(double clock_s) {
  kernel::machine::Machine machine;
  machine.control.interpolator_period_s = 0.004;
  machine.axes.resize(1);
  auto& axis = machine.axes[0];
  axis.servo_gain_1_s = 0.001;
  axis.feed_forward = 1.0;
  axis.encoder.count_au = kCount_mm;
  axis.encoder.clock_s = clock_s;
  return machine;
}

using MotionLaw = std::function<std::pair<double, double>(double t_s)>;

/// The body's axis sample in each cycle of the motion.
void follow(const kernel::machine::Machine& machine, const MotionLaw& motion, int cycles,
            const std::function<void(const kernel::signal::Frame&)>& look) {
  auto body = MachineBody::make({.machine = machine}).value();
  nc::plan::Setpoint setpoint;
  setpoint.position[0] = motion(0.0).first;
  body.reset(setpoint.position);
  for (int i = 1; i <= cycles; ++i) {
    const auto [x, v] = motion(machine.control.interpolator_period_s * i);
    setpoint.position[0] = x;
    setpoint.velocity[0] = v;
    body.begin({});
    body.end(setpoint);
    look(body.frame());
  }
}

// Edges at constant speed are q/v apart; a stamp is truncated to the clock, so any two may differ
// from that by one tick of 0.1 µs.
TEST(Counter, AtConstantSpeedItsStampsAreEquidistantWithinTheClock) {
  const double v = 7.3;
  double first_s = -1.0;
  std::int64_t first = 0;
  int edges = 0;
  follow(
      follower(kClock_s), [&](double t) { return std::pair{v * t, v}; }, 2000,
      [&](const kernel::signal::Frame& frame) {
        const auto& axis = frame.axis[0];
        ASSERT_TRUE(axis.encoder_shown);
        ASSERT_EQ(axis.edge_direction, 1);
        ASSERT_EQ(axis.actual_mm, static_cast<double>(axis.count) * kCount_mm);
        ASSERT_LE(axis.edge_s, frame.time_s);
        ASSERT_GE(axis.edge_s, frame.time_s - kCount_mm / v - kClock_s) << "not the last one";
        ASSERT_NEAR(axis.edge_s / kClock_s, std::round(axis.edge_s / kClock_s), 1e-4);
        if (frame.time_s > 1.0) {  // the start has died away
          first = edges == 0 ? axis.count : first;
          first_s = edges == 0 ? axis.edge_s : first_s;
          ++edges;
          const double spacing_s = static_cast<double>(axis.count - first) * kCount_mm / v;
          ASSERT_NEAR(axis.edge_s - first_s, spacing_s, 1.05 * kClock_s) << edges;
        }
      });
  EXPECT_GT(edges, 1000);
}

// The stamp inserted into the closed form of the motion must give the line's position.
TEST(Counter, OnACircleEachStampIsWhenTheClosedFormPassesTheLine) {
  const double radius_mm = 10.0;
  const double rate_1_s = 4000.0 / 60.0 / radius_mm;
  int reversals = 0;
  std::int8_t direction = 0;
  follow(
      follower(kClock_s),
      [&](double t) {
        return std::pair{radius_mm * std::cos(rate_1_s * t),
                         -radius_mm * rate_1_s * std::sin(rate_1_s * t)};
      },
      1500,
      [&](const kernel::signal::Frame& frame) {
        const auto& axis = frame.axis[0];
        ASSERT_FALSE(std::isnan(axis.edge_s));
        const double line =
            static_cast<double>(axis.count) + (axis.edge_direction > 0 ? -0.5 : 0.5);
        const double x = radius_mm * std::cos(rate_1_s * axis.edge_s);
        const double v = radius_mm * rate_1_s * std::abs(std::sin(rate_1_s * axis.edge_s));
        // The loop's feedback of its counts adds at most what k·count/2 can move it within 1/k:
        // q/2.
        ASSERT_NEAR(x, line * kCount_mm, v * kClock_s + 2e-5) << frame.time_s;
        reversals += axis.edge_direction != direction;
        direction = axis.edge_direction;
      });
  EXPECT_GE(reversals, 12);
}

TEST(Counter, WithoutAClockItCountsAndWithoutCountsItIsNotShown) {
  const auto straight = [](double t) { return std::pair{5.0 * t, 5.0}; };
  std::int64_t last = 0;
  follow(follower(0.0), straight, 100, [&](const kernel::signal::Frame& frame) {
    EXPECT_TRUE(std::isnan(frame.axis[0].edge_s));
    EXPECT_GT(frame.axis[0].count, last);
    last = frame.axis[0].count;
  });
  auto ideal = follower(kClock_s);
  ideal.axes[0].encoder.count_au = 0.0;
  follow(ideal, straight, 100, [&](const kernel::signal::Frame& frame) {
    EXPECT_FALSE(frame.axis[0].encoder_shown);
    EXPECT_TRUE(std::isnan(frame.axis[0].edge_s));
  });
}

}  // namespace
}  // namespace steadyrest::sim
