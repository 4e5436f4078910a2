// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <steadyrest/kernel/units/constants.hpp>
#include <steadyrest/thermal/online/test/governed.hpp>

namespace steadyrest::thermal::online {
namespace {

using kernel::outcome::Reason;
using kernel::signal::AxisValues;
using kernel::signal::Frame;
using kernel::signal::Motion;
using kernel::units::kNan;
using test::kX;
using test::kZ;
using test::mill;

// Mostly plausible values, or the governor would only refuse; now and then infinity and 1e300.
double any_double() {
  return *rc::gen::weightedOneOf<double>(
      {{6, rc::gen::map(rc::gen::inRange(-2000, 2000), [](int n) { return n / 10.0; })},
       {1, rc::gen::elementOf(std::vector<double>{kNan, 1e300, -1e300, 0.0,
                                                  std::numeric_limits<double>::infinity()})}});
}

Frame any_frame(double time_s) {
  Frame frame;
  frame.time_s = time_s;
  frame.motion = static_cast<Motion>(*rc::gen::inRange(0, 9));
  frame.spindle_actual_rev_s = any_double();
  frame.path_speed_mm_s = any_double();
  frame.coolant = *rc::gen::arbitrary<bool>();
  frame.temperature_c[0] = any_double();
  frame.probe = {.number = *rc::gen::inRange<std::uint64_t>(0, 4),
                 .axis = *rc::gen::arbitrary<std::uint8_t>(),
                 .displacement_mm = any_double() * 1e-4,
                 .sd_mm = any_double() * 1e-5};
  return frame;
}

void spoil(OffsetGovernor& governor) {
  const StateFilter::Reading reading{.displacement_mm = any_double() * 1e-3,
                                     .sd_mm = std::abs(any_double()) * 1e-4};
  // Rare, so that long stretches of ordinary work separate the shocks.
  switch (*rc::gen::inRange(0, 40)) {
    case 0:
      governor.measure(kZ, reading);
      break;
    case 1:
      governor.rezero(kZ, reading);
      break;
    case 2:
      governor.zero_here();
      break;
    case 3: {
      OffsetGovernor::State state = governor.state();
      state.axis[kZ].filter.bias_mm = any_double();
      state.axis[kX].reference_mm = any_double();
      state.turned_rev = any_double();
      governor.restore(state);
      break;
    }
    default:
      break;
  }
}

/// The machine's offset differs from the layer's: a lost link, another room.
void stand_elsewhere(kernel::override::OffsetEnvelope& envelope) {
  kernel::override::OffsetEnvelope::State state;
  state.offset_mm.fill(*rc::gen::inRange(-30, 31) * 1e-3);
  envelope.restore(state);
}

// Three statements of the room's README as bounds: no wish beyond the clamp, no step beyond the
// present slope, and no movement in a thread, a tap or a probing move.
RC_GTEST_PROP(OffsetGovernorSafety, NoInputLeavesTheClampOrTheSlope, ()) {
  auto machine = mill();
  machine.thermal.retract_slope_mm_s = *rc::gen::elementOf(std::vector<double>{0.0, 0.002, 1.0});
  test::Governed on(machine);
  const double slew = machine.envelope.offset_slew_mm_s;
  const double retract =
      std::min(std::max(machine.thermal.slope_mm_s, machine.thermal.retract_slope_mm_s), slew);
  const double most = machine.envelope.stale_after_s;
  double time_s = 0.0;
  for (int k = 0; k < 200; ++k) {
    const double gap_s = *rc::gen::elementOf(std::vector<double>{0.0, 0.001, 0.05, 0.5, 30.0, 1e5});
    spoil(on.governor);
    if (*rc::gen::inRange(0, 20) == 0) {
      stand_elsewhere(on.envelope);
    }
    const AxisValues before = on.offset_mm();
    on.tool_in_cut = *rc::gen::arbitrary<bool>();
    on.unfit = *rc::gen::weightedElement<Reason>({{5, Reason::none}, {1, Reason::input_stale}});
    on.frame = any_frame(time_s);
    time_s += gap_s;
    const auto out = on.cycle(gap_s);
    const bool unfit = on.unfit != Reason::none;
    const bool feeds = on.frame.motion == Motion::feed;
    // A fade for unfit input follows the envelope's slew, everything else the room's slope.
    const double slope = unfit                     ? slew
                         : on.tool_in_cut || feeds ? machine.thermal.slope_mm_s
                                                   : retract;
    const bool still = (unfit && on.tool_in_cut) || (!unfit && (on.frame.motion == Motion::thread ||
                                                                on.frame.motion == Motion::tap ||
                                                                on.frame.motion == Motion::probe));
    for (const std::size_t i : {kX, kZ}) {
      const double offset = out.offset_mm[i];
      RC_ASSERT(std::isfinite(offset));
      RC_ASSERT(std::abs(out.request.offset_mm[i]) <= machine.thermal.max_offset_mm);
      RC_ASSERT(std::abs(offset) <= std::max(machine.thermal.max_offset_mm, std::abs(before[i])));
      RC_ASSERT(std::abs(offset - before[i]) <= slope * std::min(gap_s, most) + 1e-15);
      RC_ASSERT(!still || offset == before[i]);
      RC_ASSERT(!unfit || std::abs(offset) <= std::abs(before[i]));
    }
    const bool lost = !unfit && !std::isfinite(on.frame.temperature_c[0]);
    RC_ASSERT(!lost || !on.tool_in_cut || out.offset_mm[kX] == before[kX]);
    RC_ASSERT(!lost || std::abs(out.offset_mm[kX]) <= std::abs(before[kX]));
  }
}

TEST(OffsetGovernorSafety, ARestoredWishBeyondTheClampIsCutToIt) {
  OffsetGovernor governor = OffsetGovernor::make(mill()).value();
  auto state = governor.state();
  state.last.request.offset_mm[kZ] = -5.0;
  state.last.request.offset_mm[kX] = kNan;
  governor.restore(state);
  EXPECT_EQ(governor.output().request.offset_mm[kZ], -0.030);
  EXPECT_EQ(governor.output().request.offset_mm[kX], 0.0);
}

// Bit for bit: any state that State forgets shows up here.
TEST(OffsetGovernorSafety, WhatGoesOnAfterARestartIsWhatWouldHaveGoneOn) {
  test::Governed on;
  on.seconds(777.7);
  test::Governed restarted;
  restarted.governor.restore(on.governor.state());
  restarted.envelope.restore(on.envelope.state());
  restarted.frame = on.frame;
  for (int i = 0; i < 500; ++i) {
    on.frame.temperature_c[0] = restarted.frame.temperature_c[0] = 20.0 + 0.01 * i;
    on.frame.motion = restarted.frame.motion = i % 100 < 50 ? Motion::feed : Motion::probe;
    const auto a = on.cycle();
    const auto b = restarted.cycle();
    EXPECT_EQ(a.offset_mm, b.offset_mm);
    EXPECT_EQ(a.request.offset_mm, b.request.offset_mm);
    EXPECT_EQ(a.request.slope_mm_s, b.request.slope_mm_s);
    EXPECT_EQ(a.request.reason, b.request.reason);
    EXPECT_EQ(a.displacement_mm, b.displacement_mm);
    EXPECT_EQ(a.sd_mm, b.sd_mm);
  }
}

}  // namespace
}  // namespace steadyrest::thermal::online
