// SPDX-License-Identifier: Apache-2.0
// The spindle's speed modulated through the override switch's wires, the feed with it.
#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>

#include <gtest/gtest.h>
#include <tests/lines/line_chain.hpp>

#include <steadyrest/kernel/machine/chatter.hpp>
#include <steadyrest/sim/simulated_machine.hpp>

namespace steadyrest::test::lines {
namespace {

using kernel::machine::Machine;
using kernel::machine::SpeedLaw;

constexpr double kSpeed_rev_s = 50.0;
constexpr double kFeed_mm_s = 2000.0 / 60.0;

struct Seen {
  double slowest = 10.0;  ///< of the spindle, measured, as a ratio of the programmed speed
  double fastest = 0.0;
  double largest_feed_per_tooth = 0.0;  ///< as a ratio of the programmed one
  int cycles = 0;
  int over = 0;  ///< of them with more than the band permits
};

Machine machine_with(SpeedLaw law) {
  Machine machine = wired_840d(0.040);
  machine.contour.enabled = false;
  machine.lines.programmed_rev_s = kSpeed_rev_s;
  machine.chatter.enabled = true;
  machine.chatter.law = law;
  machine.chatter.amplitude_ratio = 0.15;
  machine.chatter.period_s = 2.0;
  machine.chatter.mean_ratio = law == SpeedLaw::constant ? 0.8 : 0.95;
  machine.chatter.min_feed_per_tooth_ratio = 0.7;
  machine.chatter.max_feed_per_tooth_ratio = 1.05;
  machine.chatter.m_code_on = 0;
  machine.chatter.m_code_off = 0;
  return machine;
}

/// Through the wires, or with the layer directly on the simulated machine.
Seen modulated(SpeedLaw law, bool by_wires) {
  const Machine machine = machine_with(law);
  Machine real = machine;
  real.port = kernel::machine::PortKind::sim;
  const auto path = path_of(real,
                            "G17 G90 G94 G71\nS3000 M3\nG0 X10 Y0\nG3 X10 Y0 I-10 J0 TURN=20 "
                            "F2000\nM30\n");
  const auto sim = sim::SimulatedMachine::make(
                       {.machine = real, .path = path, .operator_actions = {}, .cutting = {}})
                       .value();
  LineChain chain(machine, path, std::make_unique<BareLink>());
  auto direct = supervisor::Supervisor::make(real, sim->capability()).value();
  Seen seen;
  for (double time_s = 0.0; time_s < 15.0;) {
    const auto frame = sim->read().value();
    time_s = frame.time_s;
    const auto command = by_wires ? chain.cycle(frame) : direct.update(frame, {});
    if (command.write) {
      EXPECT_TRUE(sim->write(command));
    }
    if (time_s < 5.0) {
      continue;  // run-up and the swing's growth
    }
    const double speed = frame.spindle_actual_rev_s / kSpeed_rev_s;
    const double per_tooth = frame.path_speed_mm_s / kFeed_mm_s / std::max(speed, 1e-3);
    seen.slowest = std::min(seen.slowest, speed);
    seen.fastest = std::max(seen.fastest, speed);
    seen.largest_feed_per_tooth = std::max(seen.largest_feed_per_tooth, per_tooth);
    ++seen.cycles;
    seen.over += per_tooth > 1.05 + 1e-6 ? 1 : 0;
  }
  EXPECT_EQ(chain.faults(), 0U) << chain.last_fault();
  return seen;
}

class Modulation : public testing::TestWithParam<SpeedLaw> {};

TEST_P(Modulation, ReachesTheSpindleThroughTheWiresWithTheFeedInItsBand) {
  const Seen seen = modulated(GetParam(), true);
  const Seen direct = modulated(GetParam(), false);
  std::printf(
      "%.2f … %.2f (directly %.2f … %.2f), feed per tooth up to %.3f, %.2f %% over its band\n",
      seen.slowest, seen.fastest, direct.slowest, direct.fastest, seen.largest_feed_per_tooth,
      100.0 * seen.over / seen.cycles);
  // The same swing as without wires between; a word walks for some scans.
  EXPECT_NEAR(seen.slowest, direct.slowest, 0.021);
  EXPECT_NEAR(seen.fastest, direct.fastest, 0.021);
  if (GetParam() == SpeedLaw::constant) {
    EXPECT_NEAR(seen.slowest, 0.8, 0.001);
    EXPECT_NEAR(seen.fastest, 0.8, 0.001);
  } else {
    EXPECT_GT(seen.fastest - seen.slowest, 0.14);
  }
  EXPECT_LT(seen.largest_feed_per_tooth, 1.12);
  EXPECT_LT(seen.over, 0.02 * seen.cycles);
}

INSTANTIATE_TEST_SUITE_P(Laws, Modulation,
                         testing::Values(SpeedLaw::constant, SpeedLaw::square, SpeedLaw::pulse,
                                         SpeedLaw::triangle, SpeedLaw::sine, SpeedLaw::random,
                                         SpeedLaw::stop),
                         [](const auto& law) {
                           return std::string(kernel::machine::kSpeedLawNames.at(
                               static_cast<std::size_t>(law.param)));
                         });

}  // namespace
}  // namespace steadyrest::test::lines
