// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/contour/offline/predistort/hold/feed_caps.hpp>
#include <steadyrest/contour/online/test/paths.hpp>
#include <steadyrest/passport/file/machine_file.hpp>

namespace steadyrest::contour::offline {
namespace {

using online::test::PathMaker;

constexpr double kCapFeed_mm_s = 50.0;

nc::plan::PlannedPath capped_line() {
  nc::plan::PlannedPath path;
  path.segments = PathMaker({0, 0, 0}, kCapFeed_mm_s).line_to({100, 0, 0}).path();
  path.plans.resize(1);
  return path;
}

/// The command at the programmed feed throughout.
CommandSpeed capped_speed(double speed_mm_s = kCapFeed_mm_s) {
  CommandSpeed speed;
  for (int i = 0; i <= 1000; ++i) {
    speed.add(0.1 * i, speed_mm_s);
  }
  return speed;
}

std::vector<Piece> capped(const FeedCaps& caps, const nc::plan::PlannedPath& path) {
  Piece piece{.segment = path.segments.front()};
  piece.progress_end_mm = 100.0;
  piece.begins_run = true;
  return caps.apply({piece});
}

// ε ∝ v²: half of the error at 1/√2 of the speed, and 5 % of the limit are kept back.
TEST(FeedCaps, SlowTheStretchBetweenTheToolAndItsCommand) {
  const auto path = capped_line();
  FeedCaps caps(path, 0.1);
  EXPECT_TRUE(caps.tighten({{.foot_mm = 40.0, .progress_mm = 41.0, .error_mm = 0.02}},
                           capped_speed(), 0.01));
  const auto pieces = capped(caps, path);
  ASSERT_EQ(pieces.size(), 3U);
  EXPECT_DOUBLE_EQ(pieces[0].segment.feed_mm_s, kCapFeed_mm_s);
  EXPECT_NEAR(pieces[1].segment.feed_mm_s, kCapFeed_mm_s * std::sqrt(0.95 / 2.0), 1e-9);
  EXPECT_DOUBLE_EQ(pieces[2].segment.feed_mm_s, kCapFeed_mm_s);
  EXPECT_LE(pieces[1].progress_start_mm, 40.0);
  EXPECT_GE(pieces[1].progress_start_mm, 39.0);
  EXPECT_GE(pieces[1].progress_end_mm, 41.0);
  EXPECT_LE(pieces[1].progress_end_mm, 42.0);
}

TEST(FeedCaps, LeaveNoGapBetweenThePartsOfAPiece) {
  const auto path = capped_line();
  FeedCaps caps(path, 0.1);
  ASSERT_TRUE(caps.tighten({{10.0, 11.0, 0.02}, {30.0, 31.0, 0.015}, {99.5, 100.0, 0.02}},
                           capped_speed(), 0.01));
  const auto pieces = capped(caps, path);
  ASSERT_EQ(pieces.size(), 6U);
  EXPECT_TRUE(pieces.front().begins_run);
  for (std::size_t i = 1; i < pieces.size(); ++i) {
    EXPECT_EQ(pieces[i].segment.start_mm, pieces[i - 1].segment.end_mm) << i;
    EXPECT_DOUBLE_EQ(pieces[i].progress_start_mm, pieces[i - 1].progress_end_mm) << i;
    EXPECT_TRUE(pieces[i].joined && !pieces[i].begins_run) << i;
  }
  EXPECT_DOUBLE_EQ(pieces.back().progress_end_mm, 100.0);
}

// The control has braked for a corner already: only a feed below that speed changes anything.
TEST(FeedCaps, CountFromTheSpeedThatTheCommandHad) {
  const auto path = capped_line();
  FeedCaps caps(path, 0.01);
  ASSERT_TRUE(caps.tighten({{40.0, 41.0, 0.0095 * 1.25}}, capped_speed(10.0), 0.01));
  EXPECT_NEAR(capped(caps, path)[1].segment.feed_mm_s, 10.0 * std::sqrt(0.95 / (0.95 * 1.25)),
              1e-9);
}

// A stop between the tool and its command would slow all of the stretch down to the lowest feed.
TEST(FeedCaps, CountFromTheHighestSpeedWhereTheCommandMayBrake) {
  const auto path = capped_line();
  FeedCaps caps(path, 0.1);
  CommandSpeed speed = capped_speed();
  for (std::size_t i = 405; i < 407; ++i) {
    speed.speed_mm_s[i] = 0.0;
  }
  ASSERT_TRUE(caps.tighten({{40.0, 41.0, 0.019}, {40.0, 41.0, 0.019}}, speed, 0.01,
                           FeedCaps::Speed::highest));
  EXPECT_NEAR(capped(caps, path)[1].segment.feed_mm_s, kCapFeed_mm_s * std::sqrt(0.5), 1e-9);
}

// Closed form: the command's circle has R·√(1 + q²) and is run at v·√(1 + q²).
TEST(FeedCaps, LeaveAnArcTheFeedThatItsCommandCanHave) {
  const auto machine =
      passport::read(STEADYREST_SOURCE_DIR "/examples/machines/linuxcnc-mill.toml").value();
  nc::plan::PlannedPath path;
  path.segments = online::test::circle(2.0, 60.0 * kCapFeed_mm_s, 1.0);
  FeedCaps caps(path, 0.1);
  caps.lower_arcs(nc::plan::PathLimits(machine.axes, machine.control), 0.05, 0.9);
  const double v = caps.most_mm_s(3.0);
  const double q = v * 0.05 / 2.0;
  const double across_mm_s2 = v * v * std::sqrt(1.0 + q * q) / 2.0;
  EXPECT_LE(across_mm_s2, 0.81 * 0.866 * 2000.0);
  EXPECT_GT(across_mm_s2, 0.76 * 0.866 * 2000.0);
}

TEST(FeedCaps, EndAtTheLowestFeed) {
  const auto path = capped_line();
  FeedCaps caps(path, 0.5);
  const std::vector<ErrorPlace> bad = {{40.0, 41.0, 1.0}};
  int steps = 0;
  for (double speed = kCapFeed_mm_s; caps.tighten(bad, capped_speed(speed), 0.01) && steps < 100;
       ++steps) {
    speed = capped(caps, path)[1].segment.feed_mm_s;
  }
  EXPECT_EQ(steps, 2);  // 0.6, 0.5
  EXPECT_DOUBLE_EQ(capped(caps, path)[1].segment.feed_mm_s, 0.5 * kCapFeed_mm_s);
  EXPECT_FALSE(caps.tighten({{40.0, 41.0, 0.009}}, capped_speed(), 0.01)) << "within the limit";
}

}  // namespace
}  // namespace steadyrest::contour::offline
