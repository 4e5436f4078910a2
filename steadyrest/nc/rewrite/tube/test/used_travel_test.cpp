// SPDX-License-Identifier: Apache-2.0
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/nc/rewrite/tube/test/tube_shop.hpp>
#include <steadyrest/nc/rewrite/tube/used_travel.hpp>

namespace steadyrest::nc::rewrite {
namespace {

using test::TubeShop;
using testing::StartsWith;

/// Half a circle of R 10 whose top is at Y10; the mark is line 1.
const std::string kHalf =
    "G21 G90 G94 G17\n"     // 1, changed 2
    "G0 X-10 Y0\n"          // 2, changed 3
    "G2 X10 Y0 I10 F500\n"  // 3, changed 4; its new lines from 5 on
    "G0 X0 Y0\n"
    "M2\n";
/// Its top is at Y10.1.
const NewLines kHigher = {
    {3, {"G1 X-10.1 Y0 F500.0", "G2 X10.1 Y0 I10.1 J0 F500.0", "G1 X10 Y0 F500.0"}}};

/// A shop with a known start whose Y ends at this place.
class ShortY : public TubeShop {
 public:
  explicit ShortY(double max_mm) {
    config.start_known = true;
    for (auto& axis : machine.axes) {
      axis.min_au = -500.0;
      axis.max_au = axis.name == "Y" ? max_mm : 500.0;
    }
  }
};

TEST(UsedTravel, AChangedPathMayNotLeaveTheTravelThatTheOriginalKeeps) {
  EXPECT_EQ(ShortY(10.11).verdict(kHalf, kHigher), "proved");
  EXPECT_THAT(ShortY(10.05).verdict(kHalf, kHigher),
              StartsWith("changed:6: takes Y to 10.1000 mm, past the end of its travel at 10.05"));
}

TEST(UsedTravel, WhatTheOriginalUsesBeyondTheTravelIsItsOwn) {
  const std::string beyond =
      "G21 G90 G94 G17\nG0 X-10 Y0\nG2 X10 Y0 I10 F500\nG0 Y11\nG0 X0 Y0\nM2\n";
  EXPECT_EQ(ShortY(10.05).verdict(beyond, kHigher), "proved");
}

TEST(UsedTravel, AnUnknownStartIsNotJudged) {
  ShortY shop(10.05);
  shop.config.start_known = false;
  EXPECT_EQ(shop.verdict(kHalf, kHigher), "proved");
}

TEST(UsedTravel, RotaryAxesAndOthersAreLeftOut) {
  UsedTravel original;
  UsedTravel changed;
  interpret::Move move;
  move.end[0] = 5.0;
  original.add(move, 1);
  move.end[0] = 6.0;
  changed.add(move, 1);
  kernel::machine::Axis axis;
  axis.name = "X";
  axis.max_au = 5.5;
  EXPECT_TRUE(travel_fault({&axis, 1}, original, changed).has_value());
  axis.rotary = true;
  EXPECT_FALSE(travel_fault({&axis, 1}, original, changed).has_value());
  axis.rotary = false;
  axis.name = "U";
  EXPECT_FALSE(travel_fault({&axis, 1}, original, changed).has_value());
}

}  // namespace
}  // namespace steadyrest::nc::rewrite
