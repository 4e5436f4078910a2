// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <steadyrest/kernel/override/envelope.hpp>
#include <steadyrest/kernel/override/test/cycle.hpp>
#include <steadyrest/kernel/units/constants.hpp>

// The envelope of offsets that go with the motion: they fade, and give way to those against heat.
namespace steadyrest::kernel::override {
namespace {

using outcome::Reason;
using test::kCycle_s;

OffsetEnvelope::Config fading() {
  OffsetEnvelope::Config config{.slew_mm_s = 50.0, .fade_mm_s = 2.0};
  config.max_mm[0] = config.max_mm[1] = 0.4;
  return config;
}

OffsetEnvelope::Input wish(double x_mm) {
  OffsetEnvelope::Input input{.step_s = kCycle_s};
  input.request.offset_mm[0] = x_mm;
  input.request.reason = Reason::contour_cancelled;
  input.request.tool_in_cut = true;
  return input;
}

// 50 mm/s · 1 ms = 0.05 mm a cycle up to the limit.
TEST(FadingOffset, MovesAtItsSlewWithinItsLimit) {
  auto envelope = OffsetEnvelope::make(fading()).value();
  EXPECT_NEAR(envelope.update(wish(0.3)).offset_mm[0], 0.05, 1e-12);
  for (int i = 0; i < 20; ++i) {
    envelope.update(wish(-3.0));
  }
  const auto output = envelope.update(wish(-3.0));
  EXPECT_EQ(output.offset_mm[0], -0.4);
  EXPECT_EQ(output.reason, Reason::clamped);
}

// 2 mm/s: 0.2 mm are gone after 100 cycles and not after 99, wherever the tool is.
TEST(FadingOffset, FadesInTheCutWithoutAWish) {
  for (const Reason unfit : {Reason::none, Reason::input_stale}) {
    auto envelope = OffsetEnvelope::make(fading()).value();
    for (int i = 0; i < 4; ++i) {
      envelope.update(wish(0.2));
    }
    auto without = wish(0.2);
    without.unfit = unfit;
    without.request.reason = unfit == Reason::none ? Reason::none : without.request.reason;
    OffsetEnvelope::Output output;
    for (int i = 0; i < 99; ++i) {
      output = envelope.update(without);
    }
    EXPECT_NEAR(output.offset_mm[0], 0.002, 1e-9);
    EXPECT_FALSE(output.at_zero);
    envelope.update(without);
    EXPECT_TRUE(envelope.update(without).at_zero);
  }
}

TEST(FadingOffset, RefusesAFadeThatIsNone) {
  for (const double fade : {-1.0, units::kNan, units::kInfinity}) {
    auto config = fading();
    config.fade_mm_s = fade;
    EXPECT_FALSE(OffsetEnvelope::make(config)) << fade;
  }
}

// Heat first: the sum of both stays within the limit, and the wish gets what is left.
RC_GTEST_PROP(FadingOffset, GivesWayToTheOffsetBesideIt, ()) {
  auto envelope = OffsetEnvelope::make(fading()).value();
  const auto um = rc::gen::inRange(-600, 600);
  for (int change = 0; change < 10; ++change) {
    auto input = wish(1e-3 * *um);
    input.beside_mm[0] = 1e-3 * *rc::gen::inRange(-400, 400);
    OffsetEnvelope::Output output;
    for (int i = 0; i < 20; ++i) {  // 50 mm/s · 20 ms = 1 mm: wherever it was
      output = envelope.update(input);
    }
    const double offset = output.offset_mm[0];
    RC_ASSERT(std::abs(offset) <= 0.4 + 1e-12);
    RC_ASSERT(std::abs(offset + input.beside_mm[0]) <= 0.4 + 1e-12);
    const double asked = input.request.offset_mm[0];
    const bool fits = std::abs(asked) <= 0.4 && std::abs(asked + input.beside_mm[0]) <= 0.4;
    RC_ASSERT(!fits || std::abs(offset - asked) < 1e-12);
  }
}

// In every cycle, not only in the end: whatever slope the room asks for, whether it asks at all,
// and however slowly it fades. The other offset moves by at most the same slew.
RC_GTEST_PROP(FadingOffset, KeepsTheSumInsideItsLimitInEveryCycle, ()) {
  const double limit_mm = 1e-3 * *rc::gen::inRange(1, 600);
  const double slew_mm_s = *rc::gen::element(0.01, 0.5, 5.0, 50.0);
  OffsetEnvelope::Config config{.slew_mm_s = slew_mm_s,
                                .fade_mm_s = *rc::gen::element(0.0, 0.001, 2.0)};
  config.max_mm[0] = limit_mm;
  auto envelope = OffsetEnvelope::make(config).value();
  double beside_mm = 0.0;
  double before_mm = 0.0;
  for (int change = 0; change < 30; ++change) {
    auto input = wish(1e-3 * *rc::gen::inRange(-900, 900));
    input.request.slope_mm_s[0] = *rc::gen::element(0.0, 0.001, 1.0, 100.0, units::kNan);
    input.request.reason = *rc::gen::element(Reason::contour_cancelled, Reason::none);
    input.unfit = *rc::gen::element(Reason::none, Reason::none, Reason::input_stale);
    input.tool_in_cut = *rc::gen::arbitrary<bool>();
    input.step_s = *rc::gen::element(0.001, 0.004, 0.02);
    const double towards_mm = 1e-3 * *rc::gen::inRange(-700, 700);
    for (int i = 0; i < 20; ++i) {
      const double most_mm = slew_mm_s * input.step_s;
      beside_mm = std::clamp(towards_mm, beside_mm - most_mm, beside_mm + most_mm);
      input.beside_mm[0] = beside_mm;
      const double now_mm = envelope.update(input).offset_mm[0];
      RC_ASSERT(std::abs(now_mm) <= limit_mm + 1e-12);
      RC_ASSERT(std::abs(now_mm + beside_mm) <= std::max(limit_mm, std::abs(beside_mm)) + 1e-12);
      RC_ASSERT(std::abs(now_mm - before_mm) <= most_mm + 1e-12);
      before_mm = now_mm;
    }
  }
}

// What is beside it may be unknown for a cycle: then it is taken for nothing, and no NaN comes out.
TEST(FadingOffset, AnUnknownOffsetBesideItSpoilsNothing) {
  auto envelope = OffsetEnvelope::make(fading()).value();
  auto input = wish(0.3);
  input.beside_mm[0] = units::kNan;
  for (int i = 0; i < 10; ++i) {
    envelope.update(input);
  }
  EXPECT_NEAR(envelope.update(input).offset_mm[0], 0.3, 1e-12);
}

}  // namespace
}  // namespace steadyrest::kernel::override
