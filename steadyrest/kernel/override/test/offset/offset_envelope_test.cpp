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

// 0.05 mm/s · 0.1 s = 0.005 mm on both axes, whatever they ask for; then the limit of 0.2 mm.
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

// The room that asked for slope 0 has withdrawn; its slope must not hold the offset forever.
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

// Room and machine both report whether the tool is in the cut; both must say no.
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

// 0.05 mm/s: 0.2 mm from 0.3 takes 2 s, and the axis that takes no offset is at 0 after 2 s as
// well; in the cut, frozen, under a wish that holds, none of them jumps.
TEST(OffsetEnvelope, ARestoredOffsetBeyondTheLimitReturnsByTheSlew) {
  for (const bool wished : {false, true}) {
    auto envelope = OffsetEnvelope::make(OffsetBench::config()).value();
    OffsetEnvelope::State state;
    state.offset_mm[0] = 0.3;
    state.offset_mm[1] = -0.1;
    ASSERT_TRUE(envelope.restore(state));
    OffsetEnvelope::Input input{.step_s = kCycle_s, .tool_in_cut = true};
    input.request.reason = wished ? Reason::contour_limit : Reason::none;
    input.request.offset_mm = state.offset_mm;
    input.request.slope_mm_s.fill(0.0);
    for (int i = 1; i <= 2000; ++i) {
      const auto offset_mm = envelope.update(input).offset_mm;
      ASSERT_NEAR(offset_mm[0], 0.3 - 0.05 * kCycle_s * i, 1e-9);
      ASSERT_NEAR(offset_mm[1], -0.1 + 0.05 * kCycle_s * i, 1e-9);
    }
    envelope.update(input);
    EXPECT_EQ(envelope.update(input).offset_mm[0], 0.2);
    EXPECT_EQ(envelope.update(input).offset_mm[1], 0.0);
  }
}

// No machine file allows more than 10 mm: a state that says so is no state.
TEST(OffsetEnvelope, AnImpossibleStateIsRefused) {
  for (const double impossible_mm : {kNan, kInfinity, -kInfinity, 10.1, -1e300}) {
    auto envelope = OffsetEnvelope::make(OffsetBench::config()).value();
    OffsetEnvelope::State state;
    state.offset_mm[0] = 0.1;
    state.offset_mm[2] = impossible_mm;
    EXPECT_FALSE(envelope.restore(state)) << impossible_mm;
    EXPECT_TRUE(envelope.update({}).at_zero);
  }
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
