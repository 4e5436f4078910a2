// SPDX-License-Identifier: Apache-2.0
// The arbiter's law for every order of the same requests: the wiring alone decides which room asks
// first.
#include <algorithm>
#include <cmath>
#include <optional>
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

template <class Request>
Request any_request() {
  const double ratio =
      *rc::gen::inRange(0, 6) == 0
          ? *rc::gen::element(kNan, kInfinity, -kInfinity, -0.01, kMaxRequestRatio + 0.01)
          : *rc::gen::inRange(0, 200) / 100.0;
  return {.room = *rc::gen::element(Room::motion, Room::contour, Room::chatter, Room::thermal),
          .ratio = ratio,
          .reason = *rc::gen::element(Reason::none, Reason::not_cutting, Reason::input_stale,
                                      Reason::withdrawn_thread, Reason::contour_limit,
                                      Reason::chatter_modulating)};
}

template <class Request>
std::vector<Request> any_requests() {
  std::vector<Request> out(*rc::gen::inRange<std::size_t>(0, 7));
  std::ranges::generate(out, any_request<Request>);
  return out;
}

template <class Request>
bool is_fit(const Request& request) {
  return std::isfinite(request.ratio) && request.ratio >= 0.0 && request.ratio <= kMaxRequestRatio;
}

template <class Request>
bool wishes(const Request& request) {
  return is_fit(request) && (request.ratio < 1.0 || request.reason == Reason::contour_limit ||
                             request.reason == Reason::chatter_modulating);
}

/// Among those who ask for nothing: faults have the lowest numbers, `none` carries no reason.
template <class Request>
Reason gravest(const std::vector<Request>& requests) {
  Reason out = Reason::none;
  for (const Request& request : requests) {
    const Reason reason = is_fit(request)                ? request.reason
                          : std::isfinite(request.ratio) ? Reason::input_out_of_range
                                                         : Reason::input_not_finite;
    if (reason != Reason::none && (out == Reason::none || reason < out)) {
      out = reason;
    }
  }
  return out;
}

template <class Request>
std::vector<Request> wishes_of(const std::vector<Request>& requests) {
  std::vector<Request> out;
  std::ranges::copy_if(requests, std::back_inserter(out), wishes<Request>);
  return out;
}

template <class Request>
RatioArbiter<Request> arbitrate(const std::vector<Request>& requests) {
  RatioArbiter<Request> arbiter;
  arbiter.add(requests);
  return arbiter;
}

// By brute force over the wishes alone; without one, the most serious reason.
RC_GTEST_PROP(ArbiterOrder, TheFeedIsTheLeastOfTheWishesElseNeutralWithTheGravestReason, ()) {
  const auto requests = any_requests<FeedRequest>();
  const auto arbiter = arbitrate(requests);
  const auto asked = wishes_of(requests);
  RC_ASSERT(arbiter.wishes() == asked.size());
  if (asked.empty()) {
    RC_ASSERT(arbiter.decision().ratio == 1.0);
    RC_ASSERT(arbiter.decision().reason == gravest(requests));
  } else {
    RC_ASSERT(arbiter.decision().ratio ==
              std::ranges::min_element(asked, {}, &FeedRequest::ratio)->ratio);
  }
}

// Chatter's wishes if there are any, else all; of these the nearest to 1.
RC_GTEST_PROP(ArbiterOrder, TheSpindleIsChattersElseTheNearestToOne, ()) {
  const auto requests = any_requests<SpindleRequest>();
  const auto arbiter = arbitrate(requests);
  auto asked = wishes_of(requests);
  RC_ASSERT(arbiter.wishes() == asked.size());
  if (asked.empty()) {
    RC_ASSERT(arbiter.decision().ratio == 1.0);
    RC_ASSERT(arbiter.decision().reason == gravest(requests));
    return;
  }
  const auto by_chatter = [](const auto& wish) { return wish.room == Room::chatter; };
  if (std::ranges::any_of(asked, by_chatter)) {
    std::erase_if(asked, [&](const auto& wish) { return !by_chatter(wish); });
    RC_ASSERT(arbiter.decision().room == Room::chatter);
  }
  double least = kInfinity;
  for (const SpindleRequest& wish : asked) {
    least = std::min(least, std::abs(wish.ratio - 1.0));
  }
  RC_ASSERT(std::abs(arbiter.decision().ratio - 1.0) == least);
}

RC_GTEST_PROP(ArbiterOrder, DoesNotMoveTheRatio, ()) {
  auto feed = any_requests<FeedRequest>();
  auto spindle = any_requests<SpindleRequest>();
  const double feed_ratio = arbitrate(feed).decision().ratio;
  const double spindle_off = std::abs(arbitrate(spindle).decision().ratio - 1.0);
  std::ranges::reverse(feed);
  std::ranges::reverse(spindle);
  RC_ASSERT(arbitrate(feed).decision().ratio == feed_ratio);
  RC_ASSERT(std::abs(arbitrate(spindle).decision().ratio - 1.0) == spindle_off);
}

// On the page the reason must not flicker between two rooms with the same wish.
TEST(ArbiterOrder, OfEqualWishesTheFirstKeepsItsRoomAndReason) {
  const auto feed = arbitrate<FeedRequest>({{Room::contour, 0.6, Reason::contour_limit},
                                            {Room::chatter, 0.6, Reason::chatter_feed_follows}});
  EXPECT_EQ(feed.decision().room, Room::contour);
  EXPECT_EQ(feed.decision().reason, Reason::contour_limit);
  const auto spindle = arbitrate<SpindleRequest>(
      {{Room::motion, 0.75, Reason::contour_limit}, {Room::thermal, 1.25, Reason::contour_limit}});
  EXPECT_EQ(spindle.decision().room, Room::motion);
}

// kMaxRequestRatio itself is still a ratio, and so is 0.
TEST(ArbiterOrder, TheEndsOfTheRangeAreFit) {
  EXPECT_EQ(fault_of(0.0), Reason::none);
  EXPECT_EQ(fault_of(kMaxRequestRatio), Reason::none);
  EXPECT_EQ(fault_of(std::nextafter(kMaxRequestRatio, kInfinity)), Reason::input_out_of_range);
  EXPECT_EQ(fault_of(-1e-300), Reason::input_out_of_range);
}

// A reason's number tells whether a room asks: the rooms' own begin at 200.
TEST(ArbiterOrder, OnlyTheRoomsOwnReasonsAreWishes) {
  for (const outcome::ReasonEntry& entry : outcome::reasons()) {
    const bool own = static_cast<unsigned>(entry.reason) >= 200;
    EXPECT_EQ(is_wish(entry.reason), own) << entry.name;
    EXPECT_EQ(is_wish(1.0, entry.reason), own) << entry.name;
    EXPECT_TRUE(is_wish(std::nextafter(1.0, 0.0), entry.reason)) << entry.name;
  }
}

OffsetRequest asks(Room room, double x_mm, double slope_mm_s) {
  OffsetRequest request{.room = room, .reason = Reason::thermal_correcting};
  request.offset_mm[0] = x_mm;
  request.slope_mm_s[0] = slope_mm_s;
  return request;
}

// Sums of multiples of 1/1024 mm are exact in any order.
RC_GTEST_PROP(ArbiterOrder, OffsetsAddAndTheSlowestSlopeHoldsInAnyOrder, ()) {
  std::vector<OffsetRequest> requests(*rc::gen::inRange<std::size_t>(1, 7));
  double sum_mm = 0.0;
  double slowest_mm_s = kInfinity;
  for (OffsetRequest& request : requests) {
    request = asks(Room::thermal, *rc::gen::inRange(-100, 100) / 1024.0,
                   *rc::gen::inRange(0, 50) / 1000.0);
    sum_mm += request.offset_mm[0];
    slowest_mm_s = std::min(slowest_mm_s, request.slope_mm_s[0]);
  }
  for (int turn = 0; turn < 2; ++turn) {
    OffsetArbiter arbiter;
    arbiter.add(requests);
    RC_ASSERT(arbiter.decision().offset_mm[0] == sum_mm);
    RC_ASSERT(arbiter.decision().slope_mm_s[0] == slowest_mm_s);
    RC_ASSERT(arbiter.decision().slope_mm_s[1] == kInfinity);
    std::ranges::reverse(requests);
  }
}

TEST(ArbiterOrder, TheFirstThatWishesNamesTheSum) {
  OffsetArbiter arbiter;
  arbiter.add(OffsetRequest{.room = Room::motion});
  arbiter.add(asks(Room::contour, 0.01, 1.0));
  arbiter.add(asks(Room::chatter, 0.01, 1.0));
  EXPECT_EQ(arbiter.decision().room, Room::contour);
  EXPECT_EQ(arbiter.decision().reason, Reason::thermal_correcting);
}

// Stale (3) and not finite (1) withdraw: whichever comes first, the more serious one is shown. A
// withdrawn sum has no valid number, whatever was added before.
TEST(ArbiterOrder, OfTwoWithdrawnOffsetsTheGraverReasonIsShown) {
  const OffsetRequest stale{.reason = Reason::input_stale};
  OffsetRequest unfit = asks(Room::thermal, kNan, 1.0);
  for (const bool stale_first : {true, false}) {
    OffsetArbiter arbiter;
    arbiter.add(asks(Room::thermal, 0.05, 1.0));
    arbiter.add(stale_first ? stale : unfit);
    arbiter.add(stale_first ? unfit : stale);
    EXPECT_EQ(arbiter.decision().reason, Reason::input_not_finite);
    EXPECT_EQ(arbiter.decision().offset_mm, signal::AxisValues{});
  }
}

// Anyone's word puts the tool in the cut, even with an unfit offset.
TEST(ArbiterOrder, AnUnfitRequestStillSaysThatTheToolIsInTheCut) {
  for (const double x_mm : {kNan, 0.01}) {
    OffsetArbiter arbiter;
    OffsetRequest unfit = asks(Room::thermal, x_mm, -1.0);
    unfit.tool_in_cut = true;
    arbiter.add(unfit);
    EXPECT_TRUE(arbiter.decision().tool_in_cut);
  }
  EXPECT_FALSE(OffsetArbiter{}.decision().tool_in_cut);
}

}  // namespace
}  // namespace steadyrest::kernel::override
