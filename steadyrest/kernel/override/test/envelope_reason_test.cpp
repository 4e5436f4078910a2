// SPDX-License-Identifier: Apache-2.0
// What the envelope reports about itself. The operator goes by the reason: it must name what holds
// the feed now, not what held it a moment ago.
#include <gtest/gtest.h>

#include <steadyrest/kernel/override/envelope.hpp>
#include <steadyrest/kernel/override/test/cycle.hpp>
#include <steadyrest/kernel/units/constants.hpp>

namespace steadyrest::kernel::override {
namespace {

using outcome::Reason;
using test::kCycle_s;

/// An envelope that falls by 0.01 and rises by 0.002 a cycle.
struct Told {
  explicit Told(const RatioEnvelope::Config& config = {})
      : envelope(RatioEnvelope::make(config).value()) {
    envelope.update(input);
  }
  RatioEnvelope::Output cycles(int count) {
    RatioEnvelope::Output out;
    for (int i = 0; i < count; ++i) {
      out = envelope.update(input);
    }
    return out;
  }
  void wish(double ratio) {
    input.ratio = ratio;
    input.reason = Reason::contour_limit;
  }
  void no_wish(Reason reason = Reason::none) {
    input.ratio = 1.0;
    input.reason = reason;
  }

  RatioEnvelope envelope;
  RatioEnvelope::Input input{.step_s = kCycle_s};
};

// From 0.9 back to 1.0 at 2 1/s: 50 cycles on the way, then nothing left to report.
TEST(EnvelopeReason, OnItsWayBackItIsSlewLimitedAndThenNothing) {
  Told told;
  told.wish(0.9);
  told.cycles(20);
  told.no_wish();
  for (int i = 0; i < 49; ++i) {
    ASSERT_EQ(told.cycles(1).reason, Reason::slew_limited) << "cycle " << i;
  }
  EXPECT_EQ(told.cycles(3).reason, Reason::none);
}

// A room that withdrew gives its reason, on the way back and after it.
TEST(EnvelopeReason, AWithdrawalIsNamedOnTheWholeWayBack) {
  Told told;
  told.wish(0.9);
  told.cycles(20);
  told.no_wish(Reason::not_cutting);
  EXPECT_EQ(told.cycles(1).reason, Reason::not_cutting);
  EXPECT_EQ(told.cycles(100).reason, Reason::not_cutting);
}

// The wish is the panel's own 80 %: the panel takes nothing away.
TEST(EnvelopeReason, APanelThatIsJustHighEnoughLimitsNothing) {
  Told told;
  told.input.panel.panel_ratio = 0.8;
  told.wish(0.8);
  EXPECT_EQ(told.cycles(100).reason, Reason::contour_limit);
}

// The operator turns from 50 to 70 %, the layer wants 90 %. On the way up the slew holds the ratio,
// at 70 % the panel.
TEST(EnvelopeReason, ThePanelIsTheReasonOnlyOnceItIsReached) {
  Told told;
  told.input.panel.panel_ratio = 0.5;
  told.wish(0.9);
  EXPECT_EQ(told.cycles(1).reason, Reason::panel_lower);
  told.input.panel.panel_ratio = 0.7;
  EXPECT_EQ(told.cycles(50).reason, Reason::slew_limited);
  EXPECT_EQ(told.cycles(100).reason, Reason::panel_lower);
}

// No time has passed: the ratio is still at the panel, and the panel is not to blame.
TEST(EnvelopeReason, AFallThatHasNotBegunIsSlewLimited) {
  Told told;
  told.wish(0.5);
  told.input.step_s = 0.0;
  EXPECT_EQ(told.cycles(1).reason, Reason::slew_limited);
}

// Beyond the limits and on the way there: first the slew, then the limit.
TEST(EnvelopeReason, AClampIsTheReasonOnlyOnceItIsReached) {
  Told told({.min_ratio = 0.8});
  told.wish(0.1);
  EXPECT_EQ(told.cycles(19).reason, Reason::slew_limited);
  EXPECT_EQ(told.cycles(2).reason, Reason::clamped);
  told.wish(0.8);
  EXPECT_EQ(told.cycles(1).reason, Reason::contour_limit) << "the limit itself is no clamp";
}

// Zero comes before every cause but a fault of the input.
TEST(EnvelopeReason, ThePanelAtZeroIsNamedBeforeTheWish) {
  Told told;
  told.input.panel.panel_ratio = 0.0;
  EXPECT_EQ(told.cycles(1).reason, Reason::panel_zero);
  told.wish(0.5);
  EXPECT_EQ(told.cycles(1).reason, Reason::panel_zero);
  told.input.unfit = Reason::input_stale;
  EXPECT_EQ(told.cycles(1).reason, Reason::input_stale);
}

// Of several faults the frame's own comes before the panel's, the panel's before the wish's.
TEST(EnvelopeReason, OfSeveralFaultsTheFramesIsNamedFirst) {
  Told told;
  told.input.ratio = -1.0;
  EXPECT_EQ(told.cycles(1).reason, Reason::input_out_of_range);
  told.input.panel.panel_code_known = false;
  EXPECT_EQ(told.cycles(1).reason, Reason::unknown_override_code);
  told.input.unfit = Reason::input_stale;
  EXPECT_EQ(told.cycles(1).reason, Reason::input_stale);
}

// Without a mask the layer holds nothing in a thread: the switch acts at once, up and down, even if
// a room has a wish.
TEST(EnvelopeHold, AtThePanelTheOperatorsSwitchActsAtOnce) {
  Told told;
  told.input.hold = true;
  told.wish(0.5);
  for (const double panel : {0.4, 1.1, 0.0, 0.9}) {
    told.input.panel.panel_ratio = panel;
    EXPECT_EQ(told.cycles(1).ratio, panel);
    EXPECT_TRUE(told.cycles(1).hand_back);
  }
}

// Held at 60 %; the operator turns down exactly to it and up again. The layer's 60 % was in force
// all along, and a thread must not speed up half-way.
TEST(EnvelopeHold, APanelThatOnlyTouchesTheHeldRatioDoesNotFreeIt) {
  Told told;
  told.wish(0.6);
  told.cycles(100);
  told.input.hold = true;
  told.no_wish(Reason::withdrawn_thread);
  told.input.panel.panel_ratio = 0.6;
  EXPECT_EQ(told.cycles(5).ratio, 0.6);
  told.input.panel.panel_ratio = 1.0;
  EXPECT_EQ(told.cycles(200).ratio, 0.6);
}

// The envelope starts where the machine is: a switch at 40 % means no rise from 100 %.
TEST(EnvelopeStart, TheFirstPanelSeenIsWhereItBegins) {
  auto envelope = RatioEnvelope::make({}).value();
  RatioEnvelope::Input input{.step_s = kCycle_s, .ratio = 0.9, .reason = Reason::contour_limit};
  input.panel.panel_ratio = 1.1;
  EXPECT_EQ(envelope.update(input).ratio, 1.1) << "no time has passed for the wish";
  EXPECT_NEAR(envelope.update(input).ratio, 1.09, 1e-12);
}

// One ratio only: no request can change anything, and that is a valid config.
TEST(EnvelopeStart, ARangeOfOneRatioIsARange) {
  EXPECT_TRUE(RatioEnvelope::make({.min_ratio = 0.7, .max_ratio = 0.7}));
}

// An impossible ratio spoils the state, and so does an impossible panel.
TEST(EnvelopeStart, HalfAStateIsNone) {
  for (const bool panel : {true, false}) {
    auto envelope = RatioEnvelope::make({}).value();
    envelope.restore({.ratio = panel ? 0.5 : -1.0,
                      .panel_ratio = panel ? units::kNan : 0.5,
                      .panel_seen = true,
                      .at_panel = false});
    EXPECT_EQ(envelope.state().ratio, 1.0);
    EXPECT_EQ(envelope.state().panel_ratio, 1.0);
    EXPECT_FALSE(envelope.state().panel_seen);
  }
}

/// Two axes of 0.2 mm at 0.05 mm/s.
OffsetEnvelope two_axes() {
  OffsetEnvelope::Config config{.slew_mm_s = 0.05};
  config.max_mm[0] = config.max_mm[1] = 0.2;
  return OffsetEnvelope::make(config).value();
}

OffsetEnvelope::Input wishes_x(double x_mm, double slope_mm_s) {
  OffsetEnvelope::Input input{.step_s = 0.01};
  input.request.reason = Reason::thermal_correcting;
  input.request.offset_mm[0] = x_mm;
  input.request.slope_mm_s[0] = slope_mm_s;
  return input;
}

// A room that asks for exactly the envelope's slew gets it.
TEST(OffsetReason, ASlopeOfTheEnvelopesOwnSlewIsNotHeldUp) {
  auto envelope = two_axes();
  EXPECT_EQ(envelope.update(wishes_x(0.1, 0.05)).reason, Reason::thermal_correcting);
  EXPECT_EQ(envelope.update(wishes_x(0.1, 0.0500001)).reason, Reason::slew_limited);
}

// Any axis off zero keeps the machine from being handed back, until it is exactly at zero.
TEST(OffsetReason, AtZeroMeansEveryAxis) {
  auto envelope = two_axes();
  EXPECT_TRUE(envelope.update(wishes_x(0.0, 1.0)).at_zero);
  auto input = wishes_x(0.0, 1.0);
  input.request.offset_mm[1] = -0.01;
  for (int i = 0; i < 30; ++i) {
    EXPECT_FALSE(envelope.update(input).at_zero);
  }
  input.request.reason = Reason::none;
  input.tool_in_cut = false;
  for (int i = 0; i < 19; ++i) {
    EXPECT_FALSE(envelope.update(input).at_zero) << i;
  }
  EXPECT_TRUE((envelope.update(input), envelope.update(input)).at_zero);
}

// Without a longest step a gap in the input would give unlimited credit.
TEST(OffsetReason, AStepWithoutLimitIsRefused) {
  for (const double max_step_s : {0.0, -1.0, units::kInfinity, units::kNan}) {
    EXPECT_FALSE(OffsetEnvelope::make({.max_step_s = max_step_s})) << max_step_s;
  }
  auto envelope = two_axes();
  auto input = wishes_x(0.2, 1.0);
  input.step_s = 100.0;
  EXPECT_NEAR(envelope.update(input).offset_mm[0], 0.05 * 0.1, 1e-12) << "0.1 s of credit";
}

}  // namespace
}  // namespace steadyrest::kernel::override
