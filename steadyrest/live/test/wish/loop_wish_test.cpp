// SPDX-License-Identifier: Apache-2.0
#include <atomic>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/kernel/rt/testing/allocation_guard.hpp>
#include <steadyrest/live/loop.hpp>
#include <steadyrest/live/test/wish/rooms_desk.hpp>

namespace steadyrest::live {
namespace {

using chatter::online::Law;
using chatter::online::Modulation;
using kernel::machine::Mode;
using supervisor::Measured;
using supervisor::ShortText;
using supervisor::Wish;
using supervisor::WishOutcome;

constexpr Modulation kSine{
    .law = Law::sine, .amplitude_ratio = 0.07, .period_s = 1.5, .mean_ratio = 0.93};

Wish modulate(const Modulation& modulation) {
  return {.what = modulation, .author = ShortText<64>("otto")};
}

Wish measure(std::size_t axis, double displacement_mm) {
  return {.what = Measured{.axis = axis,
                           .name = ShortText<16>("Z"),
                           .displacement_mm = displacement_mm,
                           .sd_mm = 0.001},
          .author = ShortText<64>("otto")};
}

/// Passes time at each wait, so that a test's own threads see a loop that goes on.
class PatientPace final : public Pace {
 public:
  Wake wait() noexcept override {
    std::this_thread::yield();
    return {};
  }
  [[nodiscard]] double now_s() const noexcept override { return 0.0; }
};

/// A loop that runs until it is told to stop, in its own thread.
struct Running {
  explicit Running(Mode mode, bool rooms = true) {
    if (!rooms) {
      desk.machine.chatter.enabled = desk.machine.thermal.enabled = false;
      desk.layer.emplace(
          supervisor::Supervisor::make(desk.machine, desk.port->capability()).value());
    }
    loop.emplace(*desk.port, *desk.layer, pace,
                 Loop::Config{.period_s = 0.004,
                              .mode = mode,
                              .on_command = [this](const auto&) { ++commands; },
                              .on_wish =
                                  [this](const Wish& wish, WishOutcome outcome) {
                                    told.emplace_back(wish, outcome);
                                    told_before.push_back(commands);
                                  }});
    thread = std::thread([this] { loop->run(); });
  }
  void stop() {
    loop->ask_stop();
    if (thread.joinable()) {
      thread.join();
    }
  }
  ~Running() { stop(); }

  test::RoomsDesk desk;
  PatientPace pace;
  std::optional<Loop> loop;
  std::uint64_t commands = 0;
  std::vector<std::pair<Wish, WishOutcome>> told;  ///< in the loop's thread
  std::vector<std::uint64_t> told_before;          ///< after so many commands
  std::thread thread;
};

TEST(LoopWish, IsGrantedBetweenTwoCyclesInEveryMode) {
  for (const Mode mode : {Mode::observe, Mode::advise, Mode::act}) {
    Running run(mode);
    EXPECT_EQ(run.loop->ask(modulate(kSine), 10.0), WishOutcome::taken);
    EXPECT_EQ(run.loop->ask(measure(2, 0.0002), 10.0), WishOutcome::taken);
    const std::uint64_t beats = run.loop->beats();
    while (run.loop->beats() < beats + 2) {
      std::this_thread::yield();
    }
    EXPECT_EQ(run.loop->status().modulation, kSine);
    run.stop();
    ASSERT_EQ(run.told.size(), 2U);
    EXPECT_EQ(std::get<Modulation>(run.told[0].first.what), kSine);
    EXPECT_EQ(run.told[0].first.author.view(), "otto");
    EXPECT_EQ(run.told[0].second, WishOutcome::taken);
    EXPECT_EQ(std::get<Measured>(run.told[1].first.what).displacement_mm, 0.0002);
    EXPECT_LT(run.told_before[0], run.told_before[1]) << "one a cycle";
    EXPECT_EQ(run.desk.layer->thermal()->state().axis[2].filter.readings, 1U);
  }
}

// The record needs the outliers and the refused ones too: the replay must meet them.
TEST(LoopWish, SaysWhyItWasNotGranted) {
  Running run(Mode::observe);
  EXPECT_EQ(run.loop->ask(modulate({.period_s = 0.0}), 10.0), WishOutcome::out_of_range);
  EXPECT_EQ(run.loop->ask(measure(0, 0.001), 10.0), WishOutcome::no_model);
  EXPECT_EQ(run.loop->ask(measure(2, 5.0), 10.0), WishOutcome::rejected);
  run.stop();
  ASSERT_EQ(run.told.size(), 3U);
  EXPECT_EQ(run.told[2].second, WishOutcome::rejected);
  Running off(Mode::observe, false);
  EXPECT_EQ(off.loop->ask(modulate(kSine), 10.0), WishOutcome::room_off);
  EXPECT_EQ(off.loop->ask(measure(2, 0.001), 10.0), WishOutcome::room_off);
}

TEST(LoopWish, WhoAsksALoopThatHasEndedWaitsNoLongerThanItsPatience) {
  Running run(Mode::observe);
  run.stop();
  const Modulation before = *run.desk.layer->modulation();
  const auto began = std::chrono::steady_clock::now();
  EXPECT_FALSE(run.loop->ask(modulate(kSine), 0.05));
  const auto waited = std::chrono::steady_clock::now() - began;
  EXPECT_GE(waited, std::chrono::milliseconds(50));
  EXPECT_LT(waited, std::chrono::seconds(5));
  EXPECT_EQ(*run.desk.layer->modulation(), before);
}

TEST(LoopWish, OneThatWasGivenUpIsNotGrantedLater) {
  test::RoomsDesk desk;
  int told = 0;
  Loop loop(*desk.port, *desk.layer, desk.pace,
            {.period_s = 0.004, .most_cycles = 20, .on_wish = [&](const auto&, auto) { ++told; }});
  EXPECT_FALSE(loop.ask(modulate(kSine), 0.01));
  loop.run();
  EXPECT_EQ(told, 0);
  EXPECT_NE(*desk.layer->modulation(), kSine);
}

TEST(LoopWish, SeveralMayAskAtOnceAndEachGetsItsOwnAnswer) {
  Running run(Mode::observe);
  std::atomic<int> wrong{0};
  std::vector<std::thread> askers;
  askers.reserve(3);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    askers.emplace_back([&, axis] {
      for (int i = 0; i < 20; ++i) {
        const auto got = run.loop->ask(measure(axis, 0.0), 60.0);
        const bool right = axis == 2 ? got == WishOutcome::taken : got == WishOutcome::no_model;
        wrong += right ? 0 : 1;
      }
    });
  }
  for (auto& asker : askers) {
    asker.join();
  }
  EXPECT_EQ(wrong.load(), 0);
  run.stop();
  EXPECT_EQ(run.told.size(), 60U);
}

TEST(LoopWish, AllocatesNothingInTheCycle) {
  test::RoomsDesk desk;
  Loop loop(*desk.port, *desk.layer, desk.pace,
            {.period_s = 0.004, .mode = Mode::act, .most_cycles = 100'000});
  std::thread asker([&] {
    EXPECT_EQ(loop.ask(modulate(kSine), 60.0), WishOutcome::taken);
    loop.ask_stop();
  });
  {
    const kernel::rt::testing::AllocationGuard guard;
    loop.run();
    EXPECT_EQ(guard.allocations(), 0U);
  }
  asker.join();
}

}  // namespace
}  // namespace steadyrest::live
