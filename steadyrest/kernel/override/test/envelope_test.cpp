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

// Without a wish the layer must not be felt: whatever the panel does is in force in the same
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

// The limits clamp the wish alone; the panel's 120 % stays the operator's.
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

// A step of NaN or infinity would otherwise be credit without end.
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

// The longest step that counts is 0.1 s: 0.2 + 0.1 · 2 = 0.4.
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

// May exceed, but a neutral 1.0 is not a wish for 100 %, and 0 stays 0.
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

// State from a file: NaN must end at the panel, not in force.
TEST(RatioEnvelope, AStateThatIsNotFiniteIsNotRestored) {
  RatioBench bench;
  bench.cycle();
  bench.envelope().restore({.ratio = kNan, .panel_seen = true});
  EXPECT_EQ(bench.cycle().ratio, 1.0);
}

class OffsetBench {
 public:
  OffsetBench() : envelope_(OffsetEnvelope::make(config()).value()) {
    input.request.tool_in_cut = true;
    input.request.reason = Reason::contour_limit;
  }
  static OffsetEnvelope::Config config() {
    OffsetEnvelope::Config config{.slew_mm_s = 0.05};
    config.max_mm[0] = config.max_mm[2] = 0.2;
    return config;
  }

  OffsetEnvelope::Input input{.step_s = kCycle_s};

  OffsetEnvelope::Output cycles(int count) {
    OffsetEnvelope::Output output;
    for (int i = 0; i < count; ++i) {
      output = envelope_.update(input);
    }
    return output;
  }

 private:
  OffsetEnvelope envelope_;
};

// 0.05 mm/s · 0.1 s = 0.005 mm on both axes, whatever they want; then the limit of 0.2 mm.
TEST(OffsetEnvelope, SlewsAndClampsEachAxis) {
  OffsetBench bench;
  bench.input.request.offset_mm[0] = 0.01;
  bench.input.request.offset_mm[2] = -5.0;
  auto output = bench.cycles(100);
  EXPECT_NEAR(output.offset_mm[0], 0.005, 1e-12);
  EXPECT_NEAR(output.offset_mm[2], -0.005, 1e-12);
  EXPECT_EQ(output.reason, Reason::slew_limited);
  output = bench.cycles(10'000);
  EXPECT_EQ(output.offset_mm[0], 0.01);
  EXPECT_EQ(output.offset_mm[2], -0.2);
  EXPECT_EQ(output.reason, Reason::clamped);
}

// X asks for 0.01 mm/s (slower than the slew of 0.05), Z for 1 mm/s (faster): 0.001 and 0.005 mm
// after 0.1 s.
TEST(OffsetEnvelope, KeepsTheSlowerOfItsSlewAndOfTheSlopeThatIsAskedFor) {
  OffsetBench bench;
  bench.input.request.offset_mm[0] = bench.input.request.offset_mm[2] = 0.1;
  bench.input.request.slope_mm_s[0] = 0.01;
  bench.input.request.slope_mm_s[2] = 1.0;
  auto output = bench.cycles(100);
  EXPECT_NEAR(output.offset_mm[0], 0.001, 1e-12);
  EXPECT_NEAR(output.offset_mm[2], 0.005, 1e-12);
  EXPECT_EQ(output.reason, Reason::slew_limited);
  output = bench.cycles(2000);
  EXPECT_LT(output.offset_mm[0], 0.1);
  EXPECT_EQ(output.reason, Reason::contour_limit) << "only the room's own slope holds it";
  bench.input.request.slope_mm_s[0] = 0.0;
  EXPECT_EQ(bench.cycles(100).offset_mm[0], output.offset_mm[0]) << "held";
}

TEST(OffsetEnvelope, ASlopeThatIsNoneMovesNothing) {
  for (const double slope_mm_s : {kNan, -1.0, -kInfinity}) {
    OffsetBench bench;
    bench.input.request.offset_mm[0] = 0.1;
    bench.input.request.slope_mm_s[0] = slope_mm_s;
    EXPECT_EQ(bench.cycles(100).offset_mm[0], 0.0);
  }
}

// The room that asked for slope 0 has withdrawn; its slope must not hold the offset for ever.
TEST(OffsetEnvelope, RampsOutByItsOwnSlewWhateverSlopeWasAskedFor) {
  OffsetBench bench;
  bench.input.request.offset_mm[0] = 0.1;
  bench.cycles(3000);
  bench.input.request.slope_mm_s[0] = 0.0;
  bench.input.request.reason = Reason::none;
  bench.input.request.tool_in_cut = bench.input.tool_in_cut = false;
  EXPECT_NEAR(bench.cycles(100).offset_mm[0], 0.095, 1e-9);
}

TEST(OffsetEnvelope, AnAxisWithoutALimitTakesNoOffset) {
  OffsetBench bench;
  bench.input.request.offset_mm[1] = 0.1;
  EXPECT_EQ(bench.cycles(1000).offset_mm[1], 0.0);
}

// Two say whether the tool is in the cut, the room and the machine; both must say no.
TEST(OffsetEnvelope, FreezesInTheCutThenRampsOut) {
  const auto spoilt = [](auto&& spoil, Reason reason) {
    OffsetBench bench;
    bench.input.request.offset_mm[0] = 0.1;
    EXPECT_EQ(bench.cycles(3000).offset_mm[0], 0.1);
    spoil(bench.input);
    auto output = bench.cycles(5000);
    EXPECT_EQ(output.offset_mm[0], 0.1) << "frozen";
    EXPECT_EQ(output.reason, reason);
    bench.input.request.tool_in_cut = false;
    EXPECT_EQ(bench.cycles(5000).offset_mm[0], 0.1) << "the machine still says: in the cut";
    bench.input.tool_in_cut = false;
    EXPECT_NEAR(bench.cycles(100).offset_mm[0], 0.095, 1e-9) << "ramps out by the slew";
    output = bench.cycles(3000);
    EXPECT_EQ(output.offset_mm[0], 0.0);
    EXPECT_TRUE(output.at_zero);
  };
  spoilt([](auto& input) { input.request.offset_mm[2] = kNan; }, Reason::input_not_finite);
  spoilt([](auto& input) { input.unfit = Reason::input_stale; }, Reason::input_stale);
  spoilt([](auto& input) { input.request.reason = Reason::input_out_of_range; },
         Reason::input_out_of_range);
  spoilt([](auto& input) { input.request.reason = Reason::none; }, Reason::none);
}

// 5 mm were never allowed; the axis without a limit must come back to 0.
TEST(OffsetEnvelope, ARestoredOffsetIsCutToTheLimitAndNoNumberIsNotTaken) {
  auto envelope = OffsetEnvelope::make(OffsetBench::config());
  ASSERT_TRUE(envelope);
  OffsetEnvelope::State state;
  state.offset_mm[0] = 5.0;
  state.offset_mm[1] = 0.1;
  envelope->restore(state);
  EXPECT_EQ(envelope->update({}).offset_mm[0], 0.2);
  EXPECT_EQ(envelope->update({}).offset_mm[1], 0.0) << "this axis takes none";
  state.offset_mm[2] = kNan;
  envelope->restore(state);
  EXPECT_TRUE(envelope->update({}).at_zero);
}

TEST(OffsetEnvelope, RefusesLimitsThatAreNone) {
  auto config = OffsetBench::config();
  config.max_mm[3] = kInfinity;
  EXPECT_FALSE(OffsetEnvelope::make(config));
  config = OffsetBench::config();
  config.slew_mm_s = 0.0;
  EXPECT_FALSE(OffsetEnvelope::make(config));
}

}  // namespace
}  // namespace steadyrest::kernel::override
