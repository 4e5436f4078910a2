// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>

#include <steadyrest/contour/offline/closed_form.hpp>
#include <steadyrest/trial/cut/worst_lines.hpp>

namespace steadyrest::trial::cut {
namespace {

kernel::machine::Machine with_gains(double gain_x_1_s, double gain_y_1_s) {
  kernel::machine::Machine machine;
  machine.contour.limit_mm = 0.010;
  machine.axes.resize(2);
  machine.axes[0].servo_gain_1_s = gain_x_1_s;
  machine.axes[1].servo_gain_1_s = gain_y_1_s;
  return machine;
}

Sample sample(std::uint32_t line, double error_mm, double speed_mm_s) {
  Sample out;
  out.line = line;
  out.contour_error_mm = error_mm;
  out.path_speed_mm_s = speed_mm_s;
  out.motion = kernel::signal::Motion::feed;
  return out;
}

TEST(HeldFeed, OfALongArcIsTheClosedForm) {
  // R = 10 mm, k = 50 1/s, ε = 10 µm: v = k·R·√((R/(R − ε))² − 1) = 22.38 mm/s.
  const LineError arc{.contour_error_mm = 0.087,
                      .path_speed_mm_s = 66.7,
                      .arc_radius_mm = 10.0,
                      .arc_length_mm = 62.8};
  const HeldFeed held = held_feed(arc, with_gains(50.0, 50.0));
  EXPECT_EQ(held.by, HeldBy::closed_form);
  EXPECT_NEAR(held.feed_mm_s, 500.0 * std::sqrt(std::pow(10.0 / 9.99, 2) - 1.0), 1e-9);
  // The axis that bears least counts.
  EXPECT_NEAR(held_feed(arc, with_gains(50.0, 25.0)).feed_mm_s, 0.5 * held.feed_mm_s, 1e-9);
}

TEST(HeldFeed, OfAnArcSmallerThanTheLimitIsAny) {
  const LineError arc{.contour_error_mm = 0.002,
                      .path_speed_mm_s = 0.01,
                      .arc_radius_mm = 0.005,
                      .arc_length_mm = 0.03};
  const HeldFeed held = held_feed(arc, with_gains(50.0, 50.0));
  EXPECT_EQ(held.by, HeldBy::closed_form);
  EXPECT_TRUE(std::isnan(held.feed_mm_s));
}

TEST(HeldFeed, OfAnArcTooShortForTheSteadyStateIsFromTheRecord) {
  const LineError corner{.contour_error_mm = -0.040,
                         .path_speed_mm_s = 30.0,
                         .arc_radius_mm = 0.5,
                         .arc_length_mm = 0.8};
  const HeldFeed held = held_feed(corner, with_gains(50.0, 50.0));
  EXPECT_EQ(held.by, HeldBy::record);
  EXPECT_DOUBLE_EQ(held.feed_mm_s, 15.0);  // a quarter of the error: half the feed
}

TEST(HeldFeed, OfAnArcThatLeftTheLimitAtAFeedThatItsRadiusBearsIsFromTheRecord) {
  // Line 213 of the rib pocket: 29.6 µm at 240 mm/min behind a corner; the radius would bear 1041.
  const LineError entry{.contour_error_mm = 0.0296,
                        .path_speed_mm_s = 4.0,
                        .arc_radius_mm = 6.0,
                        .arc_length_mm = 37.7};
  const HeldFeed held = held_feed(entry, with_gains(50.0, 50.0));
  EXPECT_EQ(held.by, HeldBy::record);
  EXPECT_NEAR(held.feed_mm_s, 4.0 * std::sqrt(0.010 / 0.0296), 1e-12);
  // Within the limit, the radius says more than the actual feed.
  LineError kept = entry;
  kept.contour_error_mm = 0.002;
  EXPECT_EQ(held_feed(kept, with_gains(50.0, 50.0)).by, HeldBy::closed_form);
}

TEST(HeldFeed, OfALineThatKeptTheLimitIsWhatWasDriven) {
  const HeldFeed held =
      held_feed({.contour_error_mm = 0.0099, .path_speed_mm_s = 30.0}, with_gains(50.0, 50.0));
  EXPECT_EQ(held.by, HeldBy::driven);
  EXPECT_DOUBLE_EQ(held.feed_mm_s, 30.0);
}

TEST(WorstLines, AreTheWorstOfBothRunsByWhatTheLayerLeft) {
  Recorder without({});
  Recorder with({});
  for (std::uint32_t line = 1; line <= 60; ++line) {
    without.add(sample(line, 0.001 * line, 50.0));
    with.add(sample(line, line == 2 ? -0.020 : 0.0001 * line, 25.0));
  }
  const auto lines = worst_lines("no-such-file", with_gains(50.0, 50.0), without, with);
  ASSERT_GE(lines.size(), 20U);
  EXPECT_EQ(lines[0].line, 2U);  // small without the layer, the largest with it
  EXPECT_DOUBLE_EQ(lines[0].with_um, -20.0);
  EXPECT_DOUBLE_EQ(lines[0].without_um, 2.0);
  EXPECT_DOUBLE_EQ(lines[0].feed_with_mm_min, 1500.0);
  EXPECT_NEAR(lines[0].hold_feed_mm_min, 1500.0 / std::sqrt(2.0), 1e-9);
  EXPECT_EQ(lines[1].line, 60U);
  for (std::size_t i = 1; i < lines.size(); ++i) {
    EXPECT_GE(std::abs(lines[i - 1].with_um), std::abs(lines[i].with_um));
  }
}

TEST(WorstLines, WhatOnlyOneRunCutHasNoFigureOfTheOther) {
  Recorder without({});
  Recorder with({});
  without.add(sample(3, 0.004, 50.0));
  with.add(sample(4, 0.002, 40.0));
  const auto lines = worst_lines("no-such-file", with_gains(50.0, 50.0), without, with);
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_EQ(lines[0].line, 4U);
  EXPECT_TRUE(std::isnan(lines[0].without_um));
  EXPECT_EQ(lines[1].line, 3U);
  EXPECT_TRUE(std::isnan(lines[1].with_um));
  EXPECT_DOUBLE_EQ(lines[1].hold_feed_mm_min, 3000.0);
}

TEST(WorstLines, ThatKeptTheLimitFasterWithoutTheLayerHoldAtThatFeed) {
  Recorder without({});
  Recorder with({});
  without.add(sample(1, 0.009, 50.0));
  with.add(sample(1, 0.003, 20.0));
  const auto lines = worst_lines("no-such-file", with_gains(50.0, 50.0), without, with);
  EXPECT_EQ(lines.at(0).held_by, HeldBy::driven);
  EXPECT_DOUBLE_EQ(lines.at(0).hold_feed_mm_min, 3000.0);
}

}  // namespace
}  // namespace steadyrest::trial::cut
