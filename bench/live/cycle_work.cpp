// SPDX-License-Identifier: Apache-2.0
// The work of a cycle of the running loop with every room on (tests/rig), paced by the clock, and
// where its long cycles come from: by wall clock, by the thread's own processor time, and by what
// the operating system did meanwhile.
#include <algorithm>
#include <cstdint>
#include <ctime>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/core.h>
#include <sys/resource.h>
#include <tests/rig/everything_on.hpp>

#include <steadyrest/live/loop.hpp>
#include <steadyrest/live/realtime.hpp>

namespace {

using namespace steadyrest;

constexpr double kUs_s = 1e6;

double seconds(clockid_t clock) noexcept {
  timespec now{};
  clock_gettime(clock, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

struct Moment {
  double wall_s = 0.0;
  double own_s = 0.0;  ///< processor time of this thread
  long switched = 0;   ///< taken off the processor against its will
  long faults = 0;     ///< pages
};

Moment moment() noexcept {
  rusage used{};
  ::getrusage(RUSAGE_THREAD, &used);
  return {.wall_s = seconds(CLOCK_MONOTONIC),
          .own_s = seconds(CLOCK_THREAD_CPUTIME_ID),
          .switched = used.ru_nivcsw,
          .faults = used.ru_minflt};
}

struct Cycle {
  double wall_us = 0.0;
  double own_us = 0.0;
  bool switched = false;
  bool faulted = false;
  bool decided = false;  ///< the feed governor searched in it
  bool sees = false;     ///< a path ahead: a step is looked at while somebody watches
};

/// Notes at each look at the clock what the loop's thread has used: the last two before a wait are
/// the frame's arrival and the end of the cycle.
class WatchingPace final : public live::Pace {
 public:
  WatchingPace(double period_s, const supervisor::Supervisor& layer, std::size_t cycles)
      : pace_(period_s), layer_(layer) {
    cycles_.reserve(cycles + 10'000);
  }
  Wake wait() noexcept override {
    if (looks_ >= 3 && cycles_.size() < cycles_.capacity()) {
      const auto& contour = layer_.estimates().contour;
      cycles_.push_back({.wall_us = kUs_s * (last_.wall_s - before_.wall_s),
                         .own_us = kUs_s * (last_.own_s - before_.own_s),
                         .switched = last_.switched != before_.switched,
                         .faulted = last_.faults != before_.faults,
                         .decided = contour && contour->decided,
                         .sees = layer_.previews()});
    }
    return pace_.wait();
  }
  [[nodiscard]] double now_s() const noexcept override {
    ++looks_;
    before_ = last_;
    last_ = moment();
    return last_.wall_s;
  }
  [[nodiscard]] const std::vector<Cycle>& cycles() const noexcept { return cycles_; }

 private:
  live::MonotonicPace pace_;
  const supervisor::Supervisor& layer_;
  std::vector<Cycle> cycles_;
  mutable std::uint64_t looks_ = 0;
  mutable Moment before_;
  mutable Moment last_;
};

template <class Value>
void print_quantiles(const char* name, const std::vector<Cycle>& cycles, Value value) {
  std::vector<double> all;
  for (const Cycle& cycle : cycles) {
    all.push_back(value(cycle));
  }
  std::ranges::sort(all);
  const auto at = [&all](double share) {
    return all[static_cast<std::size_t>(share * static_cast<double>(all.size() - 1))];
  };
  fmt::print("{:<28} p50 {:7.1f}   p99 {:7.1f}   p99.9 {:7.1f}   worst {:7.1f} µs\n", name, at(0.5),
             at(0.99), at(0.999), all.back());
}

template <class Which>
void print_some(const char* name, const std::vector<Cycle>& cycles, Which which) {
  std::vector<Cycle> some;
  std::ranges::copy_if(cycles, std::back_inserter(some), which);
  if (!some.empty()) {
    print_quantiles(name, some, [](const Cycle& c) { return c.own_us; });
  }
}

void print_long(const std::vector<Cycle>& cycles, double limit_us) {
  std::size_t over = 0;
  std::size_t switched = 0;
  std::size_t faulted = 0;
  std::size_t own = 0;
  std::size_t decided = 0;
  for (const Cycle& cycle : cycles) {
    if (cycle.wall_us > limit_us) {
      ++over;
      switched += cycle.switched ? 1 : 0;
      faulted += cycle.faulted ? 1 : 0;
      own += cycle.own_us > limit_us ? 1 : 0;
      decided += cycle.decided ? 1 : 0;
    }
  }
  fmt::print(
      "above {:.0f} µs: {} of {} cycles; {} taken off the processor, {} with a page fault, {} by "
      "their own work alone; {} with a decision\n",
      limit_us, over, cycles.size(), switched, faulted, own, decided);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"The work of a cycle of the running loop with every room on"};
  std::string name = "linuxcnc-mill";
  std::size_t cycles = 30'000;
  double period_s = 0.001;
  bool deaf = false;
  bool watched = false;
  double path_offset_mm = 0.0;
  app.add_option("--machine", name, "of examples/machines")->capture_default_str();
  app.add_option("--cycles", cycles)->capture_default_str();
  app.add_option("--period-s", period_s)->capture_default_str();
  app.add_option("--path-offset-mm", path_offset_mm, "offsets against the contour error, up to");
  app.add_flag("--deaf", deaf, "without the chatter detector, as steadyrest run has it");
  app.add_flag("--watched", watched, "somebody looks at the page");
  CLI11_PARSE(app, argc, argv)
  auto machine = rig::everything_on(name);
  machine.envelope.max_path_offset_mm = path_offset_mm;
  const auto port = rig::chattering(machine, rig::busy_path(machine, 400));
  auto layer = deaf ? supervisor::Supervisor::make(machine, port->capability()).value()
                    : rig::listening(machine, port->capability());
  WatchingPace pace(period_s, layer, cycles);
  live::Tap tap;
  tap.watch(watched);
  live::Loop loop(*port, layer, pace,
                  {.period_s = period_s,
                   .contour_limit_mm = machine.contour.limit_mm,
                   .mode = kernel::machine::Mode::act,
                   .most_cycles = cycles,
                   .tap = &tap});
  const auto real_time = live::ask_for_real_time();
  const live::LoopFigures& figures = loop.run();
  fmt::print("{}, {} cycles of {:g} ms, real-time priority: {}\n", machine.name, figures.cycles,
             1000.0 * period_s, real_time.priority);
  print_quantiles("work by the wall clock", pace.cycles(),
                  [](const Cycle& c) { return c.wall_us; });
  print_quantiles("its own processor time", pace.cycles(), [](const Cycle& c) { return c.own_us; });
  print_some("… in cycles that decide", pace.cycles(), [](const Cycle& c) { return c.decided; });
  print_some("… that see a path, and do not", pace.cycles(),
             [](const Cycle& c) { return c.sees && !c.decided; });
  print_long(pace.cycles(), 60.0);
  fmt::print("lateness of the wake-up      p50 {:7.1f}   p99.9 {:7.1f} µs; {} overruns\n",
             kUs_s * figures.lateness.quantile_s(0.5), kUs_s * figures.lateness.quantile_s(0.999),
             figures.overruns);
  return 0;
}
