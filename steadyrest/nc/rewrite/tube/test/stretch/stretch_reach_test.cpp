// SPDX-License-Identifier: Apache-2.0
// A new move belongs to the place of its block: README and stretch.hpp promise a reach of path
// length before and after it, 4·tube + 0.1 s·feed.
#include <algorithm>

#include <gtest/gtest.h>

#include <steadyrest/nc/rewrite/tube/stretch.hpp>
#include <steadyrest/nc/rewrite/tube/test/made_moves.hpp>

namespace steadyrest::nc::rewrite {
namespace {

using interpret::FeedMode;
using interpret::Move;
using test::made_line;

constexpr double kBlock_mm = 0.05;  ///< length of each of the original's blocks
constexpr int kBlocks = 600;
constexpr double kReachTube_mm = 0.1;

/// A straight line of many blocks with this move's feed: one line as far as `to_mm` comes in place
/// of the first; those behind it stay.
bool may_go(const Move& feed_of, double to_mm) {
  Stretch stretch(kReachTube_mm);
  stretch.begin({0, 0, 0}, {0, 0, 0});
  for (int i = 0; i < kBlocks; ++i) {
    Move block = feed_of;
    block.start[0] = kBlock_mm * i;
    block.end[0] = kBlock_mm * (i + 1);
    stretch.block(block);
    if (i == 0) {
      stretch.fresh(made_line({0, 0, 0}, {to_mm, 0, 0}));
    } else if (block.end[0] > to_mm) {
      stretch.fresh(made_line({std::max(to_mm, block.start[0]), 0, 0}, {block.end[0], 0, 0}));
    }
  }
  return !stretch.close().has_value();
}

/// The line may lead ahead of its block by the reach and the tube, and no farther, to the length of
/// a block.
void expect_reach(const Move& feed_of, double reach_mm) {
  EXPECT_TRUE(may_go(feed_of, kBlock_mm + reach_mm + kReachTube_mm - 0.01));
  EXPECT_FALSE(may_go(feed_of, 2.0 * kBlock_mm + reach_mm + kReachTube_mm + 0.01));
}

TEST(StretchReach, GrowsWithTheFeed) {
  expect_reach(made_line({}, {}, 1.0), 0.4 + 0.1);
  expect_reach(made_line({}, {}, 10.0), 0.4 + 1.0);
  expect_reach(made_line({}, {}, 200.0), 0.4 + 20.0);
}

// 0.2 mm a revolution at 50 revolutions a second is 10 mm/s, whichever way the spindle turns.
TEST(StretchReach, OfAFeedPerRevolutionIsThatOfItsSpindle) {
  for (const double spindle_rev_s : {50.0, -50.0}) {
    Move turning = made_line({}, {}, 0.2);
    turning.feed_mode = FeedMode::per_revolution;
    turning.spindle_rev_s = spindle_rev_s;
    expect_reach(turning, 0.4 + 1.0);
  }
}

// The other way: what a block leaves to a later one.
TEST(StretchReach, GoesBackAsFarAsAhead) {
  const auto late_by = [](int blocks) {
    Stretch stretch(kReachTube_mm);
    stretch.begin({0, 0, 0}, {0, 0, 0});
    for (int i = 0; i < kBlocks; ++i) {
      stretch.block(made_line({kBlock_mm * i, 0, 0}, {kBlock_mm * (i + 1), 0, 0}, 10.0));
      if (i == blocks) {
        stretch.fresh(made_line({0, 0, 0}, {kBlock_mm * (i + 1), 0, 0}));
      } else if (i > blocks) {
        stretch.fresh(made_line({kBlock_mm * i, 0, 0}, {kBlock_mm * (i + 1), 0, 0}));
      }
    }
    return !stretch.close().has_value();
  };
  EXPECT_TRUE(late_by(29));   // 1.45 mm of a reach of 1.4 mm and a tube of 0.1 mm
  EXPECT_FALSE(late_by(32));  // 1.6 mm: more by a block
}

}  // namespace
}  // namespace steadyrest::nc::rewrite
