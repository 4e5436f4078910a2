// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/kernel/rt/testing/allocation_guard.hpp>
#include <steadyrest/kernel/testing/warm_axis.hpp>
#include <steadyrest/kernel/units/constants.hpp>
#include <steadyrest/supervisor/succession.hpp>
#include <steadyrest/supervisor/test/bench.hpp>
#include <steadyrest/supervisor/wish.hpp>

namespace steadyrest::supervisor {
namespace {

using chatter::online::Law;
using chatter::online::Modulation;
using kernel::machine::Machine;
using kernel::units::kNan;
using test::Bench;
using test::kAll;
using test::Mode;

constexpr std::size_t kPlain = 0;
constexpr std::size_t kModelled = 2;
constexpr std::size_t kRotary = 3;
constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// Modulates always, by a constant 100 %; Z has a thermal model.
Machine both_rooms() {
  auto machine = test::mill(Mode::act);
  machine.chatter.enabled = true;
  machine.chatter.law = Law::constant;
  machine.chatter.mean_ratio = 1.0;
  machine.chatter.m_code_on = machine.chatter.m_code_off = 0;
  const char* const names[] = {"X", "Y", "Z", "A"};
  for (std::size_t i = 0; i < machine.axes.size(); ++i) {
    machine.axes[i].name = names[i];
  }
  machine.thermal.enabled = true;
  machine.thermal.max_offset_mm = 0.05;
  machine.thermal.slope_mm_s = 1.0;
  machine.thermal.axis = {kernel::testing::warm_z()};
  return machine;
}

struct Rooms : Bench {
  explicit Rooms(const Machine& machine = both_rooms()) : Bench(machine) {
    frame.programmed_feed_mm_s = 10.0;
    frame.spindle_programmed_rev_s = frame.spindle_actual_rev_s = 50.0;
    frame.temperature_c[0] = 20.0;
  }
  WishOutcome modulate(const Modulation& modulation) {
    return grant(supervisor, {.what = modulation, .author = {}});
  }
  WishOutcome measure(std::size_t axis, double displacement_mm, double sd_mm = 0.001) {
    return grant(
        supervisor,
        {.what =
             Measured{.axis = axis, .name = {}, .displacement_mm = displacement_mm, .sd_mm = sd_mm},
         .author = {}});
  }
};

constexpr Modulation kNinety{.law = Law::constant, .mean_ratio = 0.9};

TEST(Wish, AModulationGoesOntoTheMachineStepByStep) {
  Rooms bench;
  double before = bench.cycles(2000).spindle_ratio;
  EXPECT_EQ(before, 1.0);
  EXPECT_EQ(bench.modulate(kNinety), WishOutcome::taken);
  EXPECT_EQ(*bench.supervisor.modulation(), kNinety);
  for (int i = 0; i < 2000; ++i) {
    const double now = bench.cycle().spindle_ratio;
    ASSERT_LE(now, before);
    ASSERT_GE(now, before - 0.05 - 1e-9) << "a step of the table at most";
    before = now;
  }
  EXPECT_EQ(before, 0.9);
}

TEST(Wish, AModulationOutOfRangeChangesNothing) {
  Rooms bench;
  const Modulation good = *bench.supervisor.modulation();
  std::vector<Modulation> bad;
  for (const double value : {kNan, kInfinite, -kInfinite, -0.1, 1e308}) {
    bad.insert(bad.end(), 4, good);
    auto* const last = &bad.back();
    last[-3].amplitude_ratio = value;
    last[-2].amplitude_rev_s = value;
    last[-1].period_s = value;
    last[0].mean_ratio = value;
  }
  bad.push_back(good);
  bad.back().law = static_cast<Law>(200);
  for (const Modulation& modulation : bad) {
    EXPECT_EQ(bench.modulate(modulation), WishOutcome::out_of_range);
    EXPECT_EQ(*bench.supervisor.modulation(), good);
  }
}

TEST(Wish, AModulationTakesTheChatterRoom) {
  Machine machine = both_rooms();
  machine.chatter.enabled = false;
  Rooms bench(machine);
  EXPECT_EQ(bench.modulate(kNinety), WishOutcome::room_off);
}

// The listener would set its own constant speed in the next cycle.
TEST(Wish, ALayerThatListensTakesNoModulation) {
  Rooms bench;
  chatter::online::BetterSpeed::Config better;
  better.table.step_ratio = {0.8, 0.9, 1.0};
  better.table.max_ratio = 1.0;
  better.table.speed_rev_s = {60.0, 100.0};
  better.table.limit_depth_mm = {0.1, 0.1};
  better.detector.sample_rate_hz = 10e3;
  ASSERT_TRUE(
      bench.supervisor.listen(ListeningStage::make({.better = better, .depth_mm = 1.0}).value()));
  EXPECT_EQ(bench.modulate(kNinety), WishOutcome::listening);
  ASSERT_TRUE(bench.supervisor.listen(
      ListeningStage::make({.better = better, .depth_mm = 1.0, .acts = false}).value()));
  EXPECT_EQ(bench.modulate(kNinety), WishOutcome::taken);
}

// δ is nearly 0 and surely so, with the bias's variance that the start gives; 0.3 µm of a reading
// is within three standard deviations, 1 mm is not.
TEST(Wish, AReadingIsTakenOrRejectedByItsPlausibility) {
  Rooms bench;
  bench.cycles(2000);
  EXPECT_EQ(bench.measure(kModelled, 0.0003), WishOutcome::taken);
  EXPECT_EQ(bench.measure(kModelled, 1.0), WishOutcome::rejected);
  EXPECT_EQ(bench.supervisor.thermal()->state().axis[kModelled].filter.readings, 2U)
      << "outliers count too";
}

TEST(Wish, AReadingTakesAnAxisWithAModelAndFiniteValues) {
  Rooms bench;
  bench.cycles(10);
  EXPECT_EQ(bench.measure(kPlain, 0.001), WishOutcome::no_model);
  EXPECT_EQ(bench.measure(kRotary, 0.001), WishOutcome::no_model);
  EXPECT_EQ(bench.measure(std::numeric_limits<std::size_t>::max(), 0.001), WishOutcome::no_model);
  for (const double value : {kNan, kInfinite, -kInfinite}) {
    EXPECT_EQ(bench.measure(kModelled, value), WishOutcome::out_of_range);
    EXPECT_EQ(bench.measure(kModelled, 0.0, value), WishOutcome::out_of_range);
  }
  EXPECT_EQ(bench.measure(kModelled, 0.0, -0.001), WishOutcome::out_of_range);
  EXPECT_EQ(bench.supervisor.thermal()->state().axis[kModelled].filter.readings, 0U);
  Machine cold = both_rooms();
  cold.thermal.enabled = false;
  EXPECT_EQ(Rooms(cold).measure(kModelled, 0.001), WishOutcome::room_off);
}

TEST(Wish, ItsGrantAllocatesNothing) {
  Rooms bench;
  bench.cycles(10);
  const kernel::rt::testing::AllocationGuard guard;
  bench.modulate({.law = Law::random, .seed = 7});
  bench.measure(kModelled, 0.0001);
  EXPECT_EQ(guard.allocations(), 0U);
}

TEST(Wish, TextsAreCutAtACharacter) {
  EXPECT_EQ(ShortText<4>("abc").view(), "abc");
  EXPECT_EQ(ShortText<4>("abcde").view(), "abcd");
  EXPECT_EQ(ShortText<4>("abc\xc3\xa9").view(), "abc");
  EXPECT_EQ(ShortText<4>("a\xe2\x80\xa6z").view(), "a\xe2\x80\xa6");
  EXPECT_EQ(ShortText<4>("\x80\x80\x80\x80\x80\x80").view(), "") << "no character at all";
}

/// Another file takes over.
void follow(Rooms& bench, const Machine& running, const Machine& wanted) {
  auto next = Supervisor::make(wanted, kAll).value();
  next.take_over(bench.supervisor, kept(running, wanted));
  std::swap(bench.supervisor, next);
}

// The room itself starts over with other limits, and goes on with other rooms' settings.
TEST(Wish, AModulationOutlivesAFileThatDoesNotChangeIt) {
  const Machine running = both_rooms();
  Machine limits = running;
  limits.envelope.max_spindle_ratio = 1.1;
  limits.chatter.max_feed_per_tooth_ratio = 1.3;
  Machine contour = running;
  contour.contour.limit_mm = 0.02;
  for (const Machine& wanted : {running, limits, contour}) {
    Rooms bench;
    bench.cycles(100);
    ASSERT_EQ(bench.modulate(kNinety), WishOutcome::taken);
    follow(bench, running, wanted);
    EXPECT_EQ(*bench.supervisor.modulation(), kNinety);
    EXPECT_EQ(bench.cycles(2000).spindle_ratio, 0.9);
  }
}

TEST(Wish, TheFilesOwnModulationReplacesIt) {
  const Machine running = both_rooms();
  std::vector<Machine> all(6, running);
  all[0].chatter.law = Law::sine;
  all[1].chatter.amplitude_ratio = 0.05;
  all[2].chatter.amplitude_rev_s = 1.0;
  all[3].chatter.period_s = 3.0;
  all[4].chatter.mean_ratio = 0.95;
  all[5].chatter.seed = 5;
  for (const Machine& wanted : all) {
    Rooms bench;
    bench.cycles(100);
    ASSERT_EQ(bench.modulate(kNinety), WishOutcome::taken);
    follow(bench, running, wanted);
    const Modulation& now = *bench.supervisor.modulation();
    EXPECT_EQ(now.law, wanted.chatter.law);
    EXPECT_EQ(now.mean_ratio, wanted.chatter.mean_ratio);
    EXPECT_EQ(now.seed, wanted.chatter.seed);
  }
}

TEST(Wish, ARoomThatWasOffBeginsWithTheFiles) {
  const Machine running = both_rooms();
  Machine off = running;
  off.chatter.enabled = false;
  Rooms bench;
  ASSERT_EQ(bench.modulate(kNinety), WishOutcome::taken);
  follow(bench, running, off);
  EXPECT_EQ(bench.supervisor.modulation(), nullptr);
  follow(bench, off, running);
  EXPECT_EQ(bench.supervisor.modulation()->mean_ratio, 1.0);
}

}  // namespace
}  // namespace steadyrest::supervisor
