// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <steadyrest/thermal/online/test/governed.hpp>

namespace steadyrest::thermal::online {
namespace {

using kernel::outcome::Reason;
using kernel::signal::AxisValues;
using kernel::signal::Frame;
using kernel::signal::Motion;
using test::kX;
using test::kZ;
using test::mill;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

double any_double() {
  return *rc::gen::weightedOneOf<double>(
      {{6, rc::gen::map(rc::gen::inRange(-2000, 2000), [](int n) { return n / 10.0; })},
       {1, rc::gen::elementOf(std::vector<double>{kNaN, 1e300, -1e300, 0.0,
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

RC_GTEST_PROP(OffsetGovernorSafety, NoInputLeavesTheClampOrTheSlope, ()) {
  auto machine = mill();
  machine.thermal.retract_slope_mm_s = *rc::gen::elementOf(std::vector<double>{0.0, 0.002, 1.0});
  OffsetGovernor governor = OffsetGovernor::make(machine).value();
  const double retract =
      std::min(std::max(machine.thermal.slope_mm_s, machine.thermal.retract_slope_mm_s),
               machine.envelope.offset_slew_mm_s);
  const double most = machine.envelope.stale_after_s;
  double time_s = 0.0;
  double last_fit_s = 0.0;
  AxisValues before{};
  for (int k = 0; k < 200; ++k) {
    const double gap_s = *rc::gen::elementOf(std::vector<double>{0.0, 0.001, 0.05, 0.5, 30.0, 1e5});
    time_s += gap_s;
    spoil(governor);
    const AxisValues restored = governor.output().request.offset_mm;
    RC_ASSERT(std::abs(restored[kZ] - before[kZ]) == 0.0);
    const bool in_cut = *rc::gen::arbitrary<bool>();
    const Reason unfit =
        *rc::gen::weightedElement<Reason>({{5, Reason::none}, {1, Reason::input_stale}});
    const Frame frame = any_frame(time_s);
    const auto& request = governor.update(frame, unfit, in_cut).request;
    const double slope =
        in_cut || frame.motion == Motion::feed ? machine.thermal.slope_mm_s : retract;
    for (std::size_t i = 0; i < request.offset_mm.size(); ++i) {
      const double offset = request.offset_mm[i];
      RC_ASSERT(std::isfinite(offset));
      RC_ASSERT(std::abs(offset) <= machine.thermal.max_offset_mm);
      RC_ASSERT(std::abs(offset - before[i]) <=
                slope * std::min(time_s - last_fit_s, most) + 1e-15);
      const bool still = unfit != Reason::none || frame.motion == Motion::thread ||
                         frame.motion == Motion::tap || frame.motion == Motion::probe;
      RC_ASSERT(!still || offset == before[i]);
    }
    const bool lost = unfit == Reason::none && !std::isfinite(frame.temperature_c[0]);
    RC_ASSERT(!lost || !in_cut || request.offset_mm[kX] == before[kX]);
    RC_ASSERT(!lost || std::abs(request.offset_mm[kX]) <= std::abs(before[kX]));
    before = request.offset_mm;
    last_fit_s = unfit == Reason::none ? time_s : last_fit_s;
    if (*rc::gen::inRange(0, 20) == 0) {
      const double stands = any_double() * 1e-4;
      AxisValues standing{};
      standing.fill(stands);
      governor.yield_to(standing);
      const double left = governor.output().request.offset_mm[kZ];
      RC_ASSERT(std::abs(left) <= std::abs(before[kZ]));
      before = governor.output().request.offset_mm;
    }
  }
}

TEST(OffsetGovernorSafety, ARestoredOffsetBeyondTheClampIsCutToIt) {
  OffsetGovernor governor = OffsetGovernor::make(mill()).value();
  auto state = governor.state();
  state.axis[kZ].offset_mm = -5.0;
  state.axis[kX].offset_mm = kNaN;
  governor.restore(state);
  EXPECT_EQ(governor.output().request.offset_mm[kZ], -0.030);
  EXPECT_EQ(governor.output().request.offset_mm[kX], 0.0);
}

TEST(OffsetGovernorSafety, WhatGoesOnAfterARestartIsWhatWouldHaveGoneOn) {
  test::Governed on;
  on.seconds(777.7);
  test::Governed restarted;
  restarted.governor.restore(on.governor.state());
  restarted.frame = on.frame;
  for (int i = 0; i < 500; ++i) {
    EXPECT_EQ(on.cycle().request.offset_mm, restarted.cycle().request.offset_mm);
  }
}

}  // namespace
}  // namespace steadyrest::thermal::online
