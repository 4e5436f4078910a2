// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <steadyrest/kernel/override/envelope.hpp>
#include <steadyrest/kernel/override/test/cycle.hpp>
#include <steadyrest/kernel/units/constants.hpp>

namespace steadyrest::kernel::override {
namespace {

using outcome::Reason;
using test::kCycle_s;
using units::kInfinity;
using units::kNan;

/// One envelope; each call is one cycle of 1 ms.
class RatioBench {
 public:
  explicit RatioBench(const RatioEnvelope::Config& config = {})
      : envelope_(RatioEnvelope::make(config).value()) {}

  RatioEnvelope::Input input{.step_s = kCycle_s};

  RatioEnvelope::Output cycle() { return envelope_.update(input); }
  RatioEnvelope::Output cycles(int count) {
    auto output = cycle();
    for (int i = 1; i < count; ++i) {
      output = cycle();
    }
    return output;
  }
  void wish(double ratio) {
    input.ratio = ratio;
    input.reason = Reason::contour_limit;
  }
  void panel(double ratio) { input.panel.panel_ratio = ratio; }
  RatioEnvelope& envelope() { return envelope_; }

 private:
  RatioEnvelope envelope_;
};

// Without a wish the layer must not be felt: whatever the panel does takes effect in the same
// cycle, with no slew and no mask.
TEST(RatioEnvelope, NeutralIsTransparentToTheOperator) {
  RatioBench bench;
  for (const double panel : {1.0, 0.3, 1.2, 0.0, 0.7}) {
    bench.panel(panel);
    const auto output = bench.cycle();
    EXPECT_EQ(output.ratio, panel);
    EXPECT_TRUE(output.hand_back);
  }
}

// Falling 10 1/s, rising 2 1/s: 1.0 − 40 ms · 10 = 0.6, and 0.2 + 100 ms · 2 = 0.4.
TEST(RatioEnvelope, FallsAndRisesAtTheirOwnRates) {
  RatioBench bench;
  bench.cycle();
  bench.wish(0.2);
  EXPECT_NEAR(bench.cycles(40).ratio, 0.6, 1e-9) << "10 1/s for 40 ms";
  EXPECT_EQ(bench.cycles(40).ratio, 0.2);
  EXPECT_EQ(bench.cycle().reason, Reason::contour_limit);
  bench.wish(0.8);
  EXPECT_NEAR(bench.cycles(100).ratio, 0.4, 1e-9) << "2 1/s for 100 ms";
  EXPECT_EQ(bench.cycle().reason, Reason::slew_limited);
  EXPECT_EQ(bench.cycles(200).ratio, 0.8);
}

// The limits clamp only the wish; the panel's 120 % stays the operator's.
TEST(RatioEnvelope, ClampsTheWish) {
  RatioBench bench({.min_ratio = 0.3, .max_ratio = 1.1});
  bench.panel(1.2);
  bench.cycle();
  bench.wish(0.05);
  auto output = bench.cycles(1000);
  EXPECT_EQ(output.ratio, 0.3);
  EXPECT_EQ(output.reason, Reason::clamped);
  bench.wish(9.0);
  output = bench.cycles(1000);
  EXPECT_EQ(output.ratio, 1.1);
  EXPECT_EQ(output.reason, Reason::clamped);
}

// No slew downwards against the operator.
TEST(RatioEnvelope, PanelBelowTheWishIsInForceAtOnce) {
  RatioBench bench;
  bench.cycle();
  bench.wish(0.8);
  bench.cycles(100);
  bench.panel(0.5);
  const auto output = bench.cycle();
  EXPECT_EQ(output.ratio, 0.5);
  EXPECT_TRUE(output.hand_back);
  EXPECT_EQ(output.reason, Reason::panel_lower);
}

// From 0.5 a rise of 2 1/s is 0.002 in a cycle of 1 ms.
TEST(RatioEnvelope, UnderAWishEvenTheOperatorsRaiseGoesThroughTheSlew) {
  RatioBench bench;
  bench.panel(0.5);
  bench.cycle();
  bench.wish(0.8);
  bench.cycles(100);
  bench.panel(1.0);
  EXPECT_NEAR(bench.cycle().ratio, 0.502, 1e-9);
  EXPECT_EQ(bench.cycles(200).ratio, 0.8);
}

// From 0.4 back to the panel by the slew: 0.402 after one cycle, 1.0 after 0.3 s, then handed
// back.
TEST(RatioEnvelope, UnfitInputIsNeutralThroughTheSlewWithItsReason) {
  const auto spoilt = [](auto&& spoil, Reason reason) {
    RatioBench bench;
    bench.cycle();
    bench.wish(0.4);
    bench.cycles(100);
    spoil(bench.input);
    const auto output = bench.cycle();
    EXPECT_NEAR(output.ratio, 0.402, 1e-9);
    EXPECT_EQ(output.reason, reason);
    EXPECT_EQ(bench.cycles(400).ratio, 1.0);
    EXPECT_TRUE(bench.cycle().hand_back);
  };
  spoilt([](auto& input) { input.ratio = kNan; }, Reason::input_not_finite);
  spoilt([](auto& input) { input.ratio = -kInfinity; }, Reason::input_not_finite);
  spoilt([](auto& input) { input.ratio = -0.1; }, Reason::input_out_of_range);
  spoilt([](auto& input) { input.unfit = Reason::input_stale; }, Reason::input_stale);
  spoilt([](auto& input) { input.panel.panel_code_known = false; }, Reason::unknown_override_code);
  spoilt([](auto& input) { input.panel.panel_ratio = kNan; }, Reason::input_not_finite);
  spoilt([](auto& input) { input.panel.panel_ratio = -1.0; }, Reason::input_out_of_range);
}

// A step of NaN or infinity would otherwise give unlimited credit.
TEST(RatioEnvelope, TimeThatIsNotFiniteMovesNothing) {
  RatioBench bench;
  bench.cycle();
  bench.wish(0.4);
  bench.cycles(100);
  auto input = bench.input;
  for (const double no_time_s : {kNan, kInfinity, -kInfinity}) {
    input.step_s = no_time_s;
    const auto output = bench.envelope().update(input);
    EXPECT_EQ(output.ratio, 0.4);
    EXPECT_EQ(output.reason, Reason::input_not_finite);
  }
  EXPECT_EQ(bench.cycle().ratio, 0.4);
}

// At most 0.1 s of a step counts: 0.2 + 0.1 · 2 = 0.4.
TEST(RatioEnvelope, AGapInTheInputIsNoLicenceToJump) {
  RatioBench bench({.max_step_s = 0.1});
  bench.cycle();
  bench.wish(0.2);
  bench.cycles(200);
  bench.wish(1.0);
  bench.input.step_s = 60.0;
  EXPECT_NEAR(bench.cycle().ratio, 0.4, 1e-9) << "0.1 s of credit at 2 1/s";
  bench.input.step_s = -30.0;
  EXPECT_NEAR(bench.cycle().ratio, 0.4, 1e-9) << "time that runs backwards gives none";
}

// Held against the wish and against unfit input, not against the operator.
TEST(RatioEnvelope, HoldKeepsTheRatioButNotAgainstTheOperator) {
  RatioBench bench;
  bench.cycle();
  bench.wish(0.6);
  bench.cycles(100);
  bench.input.hold = true;
  bench.input.ratio = 1.0;
  bench.input.reason = Reason::withdrawn_thread;
  EXPECT_EQ(bench.cycles(500).ratio, 0.6);
  EXPECT_EQ(bench.cycle().reason, Reason::withdrawn_thread);
  bench.input.unfit = Reason::input_stale;
  EXPECT_EQ(bench.cycles(500).ratio, 0.6) << "unfit input does not move it";
  EXPECT_EQ(bench.cycle().reason, Reason::input_stale);
  bench.panel(0.2);
  EXPECT_EQ(bench.cycle().ratio, 0.2);
  bench.panel(0.0);
  EXPECT_EQ(bench.cycle().ratio, 0.0);
}

// The layer may exceed the panel, but a neutral 1.0 is not a wish for 100 %, and 0 stays 0.
TEST(RatioEnvelope, ExceedsThePanelOnlyWhenAllowedAndOnlyForAWish) {
  RatioBench bench({.may_exceed_panel = true});
  bench.panel(0.5);
  bench.cycle();
  EXPECT_EQ(bench.cycles(500).ratio, 0.5) << "a neutral request of 1.0 is no wish";
  bench.wish(0.8);
  EXPECT_NEAR(bench.cycle().ratio, 0.502, 1e-9);
  EXPECT_EQ(bench.cycles(500).ratio, 0.8);
  bench.panel(0.0);
  EXPECT_EQ(bench.cycle().ratio, 0.0) << "panel 0 always stops";
  EXPECT_EQ(bench.cycle().reason, Reason::panel_zero);
  bench.panel(0.5);
  EXPECT_NEAR(bench.cycle().ratio, 0.002, 1e-9) << "and from there up by the slew";
}

// Each of these values would make a slew or a clamp infinite, or none.
TEST(RatioEnvelope, RefusesAConfigThatWouldSwitchItOff) {
  EXPECT_FALSE(RatioEnvelope::make({.min_ratio = -0.1}));
  EXPECT_FALSE(RatioEnvelope::make({.min_ratio = kNan}));
  EXPECT_FALSE(RatioEnvelope::make({.min_ratio = 1.3}));
  EXPECT_FALSE(RatioEnvelope::make({.max_ratio = kInfinity}));
  EXPECT_FALSE(RatioEnvelope::make({.fall_1_s = 0.0}));
  EXPECT_FALSE(RatioEnvelope::make({.fall_1_s = kInfinity}));
  EXPECT_FALSE(RatioEnvelope::make({.rise_1_s = kInfinity}));
  EXPECT_FALSE(RatioEnvelope::make({.rise_1_s = kNan}));
  EXPECT_FALSE(RatioEnvelope::make({.max_step_s = kInfinity}));
  const auto refused = RatioEnvelope::make({.rise_1_s = -2.0});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().what, "envelope: rise_1_s is -2; allowed: finite and > 0");
}

// State from a file: NaN must end at the panel, never in force.
TEST(RatioEnvelope, AStateThatIsNotFiniteIsNotRestored) {
  RatioBench bench;
  bench.cycle();
  bench.envelope().restore({.ratio = kNan, .panel_seen = true});
  EXPECT_EQ(bench.cycle().ratio, 1.0);
}

}  // namespace
}  // namespace steadyrest::kernel::override
