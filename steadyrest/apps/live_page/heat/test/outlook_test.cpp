// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/apps/live_page/heat/outlook.hpp>
#include <steadyrest/thermal/online/test/governed.hpp>

namespace steadyrest::apps::live_page {
namespace {

using steadyrest::live::HeatNow;
using thermal::online::test::Governed;
using thermal::online::test::kTau_s;
using thermal::online::test::kZ;

constexpr double kFinal_mm = 0.020;  ///< Z's level at 50 rev/s

kernel::machine::Machine mill() {
  kernel::machine::Machine machine = thermal::online::test::mill();
  machine.envelope.max_offset_mm = 0.1;
  return machine;
}

HeatNow now_of(const Governed& governed) {
  return {.on = true,
          .time_s = governed.frame.time_s,
          .state = governed.governor.state(),
          .offset_mm = governed.offset_mm()};
}

/// By the closed form of one mode, from cold.
double grown_mm(double time_s) {
  return kFinal_mm * (1.0 - std::exp(-time_s / kTau_s));
}

const Outlook::Axis& z_of(const Outlook& outlook) {
  return *std::find_if(outlook.axis.begin(), outlook.axis.end(),
                       [](const auto& axis) { return axis.index == kZ; });
}

const std::vector<Stretch> kTurning = {
    {.seconds = 10.0, .speed_rev_s = 50.0, .feed_mm_s = 0.0, .cut_share = 1.0}};

TEST(Outlook, IsTheClosedFormAndWhatThenComes) {
  const auto machine = mill();
  Governed governed(machine);
  governed.seconds(300.0);
  const auto ahead = outlook(machine, now_of(governed), kTurning, true, {}, 3600.0);
  ASSERT_TRUE(ahead.has_value());
  ASSERT_EQ(ahead->in_s.size(), 61U);
  EXPECT_EQ(ahead->again_s, 10.0);
  const Outlook::Axis& z = z_of(*ahead);
  for (std::size_t minute = 0; minute <= 60; ++minute) {
    if (minute > 0) {
      governed.seconds(60.0);
    }
    const double time_s = 300.0 + 60.0 * static_cast<double>(minute);
    EXPECT_NEAR(z.displacement_mm[minute], grown_mm(time_s), 5e-5) << minute;
    const auto& seen = governed.governor.output();
    EXPECT_NEAR(z.displacement_mm[minute], seen.displacement_mm[kZ], 5e-5) << minute;
    EXPECT_NEAR(z.sd_mm[minute], seen.sd_mm[kZ], 2e-5) << minute;
    EXPECT_NEAR(z.offset_mm[minute], governed.offset_mm()[kZ], 1e-4) << minute;
  }
}

// From 300 s on the offset follows −δ: it passes whole micrometres when δ does.
TEST(Outlook, TellsWhenTheNextMicrometreIsDue) {
  const auto machine = mill();
  Governed governed(machine);
  Corrections done;
  for (int n = 0; n < 300; ++n) {
    governed.seconds(1.0);
    done.see(n, governed.offset_mm(), 3);
  }
  const auto ahead = outlook(machine, now_of(governed), kTurning, true, done, 3600.0);
  ASSERT_TRUE(ahead.has_value());
  ASSERT_GE(ahead->to_come.size(), 10U);
  double listed_mm = done.list().back().to_mm;
  for (const Correction& move : ahead->to_come) {
    EXPECT_EQ(move.axis, kZ);
    EXPECT_NEAR(move.from_mm, listed_mm, 1e-12);
    const double at_s = -kTau_s * std::log(1.0 - (0.001 - listed_mm) / kFinal_mm);
    EXPECT_NEAR(300.0 + move.from_s, at_s, 4.0 + 0.02 * at_s) << move.to_mm;
    listed_mm = move.to_mm;
  }
  const auto idle = outlook(machine, now_of(governed), kTurning, false, done, 3600.0);
  EXPECT_TRUE(idle->to_come.empty()) << "nothing is asked for in observe";
  EXPECT_EQ(z_of(*idle).offset_mm.back(), governed.offset_mm()[kZ]);
}

// Half of the time at 50 rev/s, half at rest: a mean of half the level, since τ is far longer.
TEST(Outlook, RepeatsWhatTheMachineDid) {
  const auto machine = mill();
  Governed governed(machine);
  governed.seconds(1.0);
  const std::vector<Stretch> again = {{.seconds = 10.0, .speed_rev_s = 50.0, .cut_share = 1.0},
                                      {.seconds = 10.0}};
  const auto ahead = outlook(machine, now_of(governed), again, true, {}, 3600.0);
  ASSERT_TRUE(ahead.has_value());
  EXPECT_EQ(ahead->again_s, 20.0);
  EXPECT_NEAR(z_of(*ahead).displacement_mm.back(), 0.5 * grown_mm(3600.0), 3e-4);
  EXPECT_GT(z_of(*ahead).sd_mm.back(), z_of(*ahead).sd_mm.front());
  const auto as_now = outlook(machine, now_of(governed), {}, true, {}, 3600.0);
  EXPECT_NEAR(z_of(*as_now).displacement_mm.back(), grown_mm(3601.0), 1e-4);
}

TEST(Outlook, IsEmptyWhereTheRoomIsOff) {
  EXPECT_FALSE(outlook(mill(), {}, kTurning, true, {}, 3600.0).has_value());
}

}  // namespace
}  // namespace steadyrest::apps::live_page
