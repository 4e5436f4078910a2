// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <steadyrest/kernel/override/arbiter.hpp>
#include <steadyrest/kernel/units/constants.hpp>

namespace steadyrest::kernel::override {
namespace {

using outcome::Reason;
using signal::FeedRequest;
using signal::OffsetRequest;
using signal::Room;
using signal::SpindleRequest;
using units::kInfinity;
using units::kNan;

FeedRequest feed_decision(const std::vector<FeedRequest>& requests) {
  FeedArbiter arbiter;
  arbiter.add(requests);
  return arbiter.decision();
}

TEST(FeedArbiter, NoRequestIsNeutral) {
  const auto decision = feed_decision({});
  EXPECT_EQ(decision.ratio, 1.0);
  EXPECT_EQ(decision.reason, Reason::none);
}

// Three wishes: the losers must leave no trace in room or reason.
TEST(FeedArbiter, TheLowestWishWinsWithItsRoomAndReason) {
  const auto decision = feed_decision({{Room::motion, 0.9, Reason::contour_objective},
                                       {Room::contour, 0.4, Reason::contour_limit},
                                       {Room::chatter, 0.6, Reason::contour_hysteresis}});
  EXPECT_EQ(decision.room, Room::contour);
  EXPECT_EQ(decision.ratio, 0.4);
  EXPECT_EQ(decision.reason, Reason::contour_limit);
}

// A withdrawn room's 1.0 is not a limit: otherwise nobody could ask for 110 % while another room
// is idle.
TEST(FeedArbiter, AWithdrawnRoomDoesNotHoldTheOthersAtOne) {
  const auto decision = feed_decision(
      {{Room::thermal, 1.0, Reason::not_cutting}, {Room::contour, 1.1, Reason::contour_objective}});
  EXPECT_EQ(decision.ratio, 1.1);
  EXPECT_EQ(decision.reason, Reason::contour_objective);
}

// A wish with a wrong reason is still a wish for less feed: the safe reading.
TEST(FeedArbiter, ARatioBelowOneCountsWhateverItsReasonSays) {
  EXPECT_EQ(feed_decision({{Room::contour, 0.3, Reason::none}}).ratio, 0.3);
  EXPECT_EQ(feed_decision({{Room::contour, 0.3, Reason::not_cutting}}).ratio, 0.3);
}

// 11 is beyond the largest request of 10: most likely a ratio in percent.
TEST(FeedArbiter, AnUnfitRatioIsNeutralAndSaysWhy) {
  for (const double ratio : {kNan, kInfinity, -kInfinity}) {
    const auto decision = feed_decision({{Room::contour, ratio, Reason::contour_limit}});
    EXPECT_EQ(decision.ratio, 1.0);
    EXPECT_EQ(decision.reason, Reason::input_not_finite);
  }
  for (const double ratio : {-0.5, 11.0}) {
    const auto decision = feed_decision({{Room::contour, ratio, Reason::contour_limit}});
    EXPECT_EQ(decision.ratio, 1.0);
    EXPECT_EQ(decision.reason, Reason::input_out_of_range);
  }
}

// Not finite (a fault) before not cutting (a withdrawal) before none.
TEST(FeedArbiter, TheGraverReasonOfTwoWithdrawalsIsShown) {
  EXPECT_EQ(feed_decision({{Room::motion, 1.0, Reason::not_cutting},
                           {Room::contour, kNan, Reason::contour_limit},
                           {Room::thermal, 1.0, Reason::none}})
                .reason,
            Reason::input_not_finite);
}

// Whatever else is wished, the lowest wish comes out.
RC_GTEST_PROP(FeedArbiter, NoWishIsEverOverruledUpwards, (const std::vector<int>& percent)) {
  std::vector<FeedRequest> requests;
  double lowest = kInfinity;
  for (const int p : percent) {
    const double ratio = (((p % 300) + 300) % 300) / 100.0;
    requests.push_back({Room::contour, ratio, Reason::contour_limit});
    lowest = std::min(lowest, ratio);
  }
  const auto decision = feed_decision(requests);
  RC_ASSERT(decision.ratio == (requests.empty() ? 1.0 : lowest));
}

// 1.1 is 0.1 off, 0.7 is 0.3 off: the smaller change wins until chatter has a say.
TEST(SpindleArbiter, ChatterWinsElseTheLeastChange) {
  SpindleArbiter others;
  others.add(SpindleRequest{Room::motion, 0.7, Reason::contour_limit});
  others.add(SpindleRequest{Room::thermal, 1.1, Reason::contour_limit});
  EXPECT_EQ(others.decision().ratio, 1.1);
  others.add(SpindleRequest{Room::chatter, 0.6, Reason::contour_limit});
  EXPECT_EQ(others.decision().ratio, 0.6);
  others.add(SpindleRequest{Room::thermal, 1.0, Reason::contour_limit});
  EXPECT_EQ(others.decision().room, Room::chatter);
  EXPECT_EQ(others.wishes(), 4U);
  SpindleArbiter unfit;
  unfit.add(SpindleRequest{Room::chatter, kNan, Reason::contour_limit});
  EXPECT_EQ(unfit.decision().ratio, 1.0);
  EXPECT_EQ(unfit.decision().reason, Reason::input_not_finite);
}

OffsetRequest offset(double x_mm, double z_mm, bool in_cut, Reason reason) {
  OffsetRequest request{.tool_in_cut = in_cut, .reason = reason};
  request.offset_mm[0] = x_mm;
  request.offset_mm[2] = z_mm;
  return request;
}

TEST(OffsetArbiter, WishesAddAxisByAxis) {
  OffsetArbiter arbiter;
  arbiter.add(offset(0.01, 0.02, false, Reason::contour_limit));
  arbiter.add(offset(-0.03, 0.01, true, Reason::contour_objective));
  arbiter.add(OffsetRequest{});
  const auto sum = arbiter.decision();
  EXPECT_DOUBLE_EQ(sum.offset_mm[0], -0.02);
  EXPECT_DOUBLE_EQ(sum.offset_mm[1], 0.0);
  EXPECT_DOUBLE_EQ(sum.offset_mm[2], 0.03);
  EXPECT_TRUE(sum.tool_in_cut);
  EXPECT_EQ(sum.reason, Reason::contour_limit);
}

// Per axis: 0.001 before 0.02 on X, 0 holds Z, nobody cares about Y.
TEST(OffsetArbiter, OfTheSlopesThatAreAskedForTheSlowestHoldsOnEachAxis) {
  OffsetArbiter arbiter;
  auto slow = offset(0.01, 0.0, true, Reason::contour_limit);
  slow.slope_mm_s[0] = 0.001;
  auto fast = offset(0.01, 0.0, true, Reason::contour_limit);
  fast.slope_mm_s[0] = 0.02;
  fast.slope_mm_s[2] = 0.0;
  arbiter.add(slow);
  arbiter.add(fast);
  arbiter.add(OffsetRequest{.slope_mm_s = {}});
  EXPECT_EQ(arbiter.decision().slope_mm_s[0], 0.001);
  EXPECT_EQ(arbiter.decision().slope_mm_s[1], kInfinity) << "who asks for nothing holds nothing";
  EXPECT_EQ(arbiter.decision().slope_mm_s[2], 0.0);
}

TEST(OffsetArbiter, ASlopeThatIsNoneMakesTheSumUnknown) {
  for (const double slope_mm_s : {kNan, -0.01}) {
    OffsetArbiter arbiter;
    auto request = offset(0.01, 0.0, true, Reason::contour_limit);
    request.slope_mm_s[2] = slope_mm_s;
    arbiter.add(request);
    EXPECT_EQ(arbiter.decision().reason, Reason::input_out_of_range);
    EXPECT_EQ(arbiter.decision().offset_mm, signal::AxisValues{});
  }
}

// NaN, a withdrawn room and an overflow of finite numbers (1e308 twice).
TEST(OffsetArbiter, OneUnfitSummandMakesTheSumUnknown) {
  OffsetArbiter arbiter;
  arbiter.add(offset(0.01, 0.0, true, Reason::contour_limit));
  arbiter.add(offset(0.0, kNan, false, Reason::contour_limit));
  EXPECT_EQ(arbiter.decision().reason, Reason::input_not_finite);
  EXPECT_EQ(arbiter.decision().offset_mm, signal::AxisValues{});
  OffsetArbiter withdrawn;
  withdrawn.add(offset(0.01, 0.0, true, Reason::contour_limit));
  withdrawn.add(offset(0.0, 0.0, false, Reason::input_stale));
  EXPECT_EQ(withdrawn.decision().reason, Reason::input_stale);
  OffsetArbiter overflow;
  overflow.add(offset(1e308, 0.0, true, Reason::contour_limit));
  overflow.add(offset(1e308, 0.0, true, Reason::contour_limit));
  EXPECT_EQ(overflow.decision().reason, Reason::input_out_of_range);
  EXPECT_EQ(overflow.decision().offset_mm, signal::AxisValues{});
}

}  // namespace
}  // namespace steadyrest::kernel::override
