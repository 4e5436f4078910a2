// SPDX-License-Identifier: Apache-2.0
// Cost of a decision of the feed governor on linuxcnc-mill, whose feed override has 201 steps: the
// actual, bounded search against the exhaustive one in the same run.
//
// The rib pocket (and the path that `doctor` measures on) is cut on the simulated machine with the
// layer acting. Each frame goes to two more governors, and their calls are timed in the cycles in
// which they decide. The cut is the same in every round, so each decision counts with its least
// time: the governor's own. Counters: p50, p99.9 and worst in µs; `forecasts` of a decision at
// p99.9; `ratio` of the exhaustive search to the bounded one at p99.9.
#include <algorithm>
#include <chrono>
#include <cstddef>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>

#include <steadyrest/contour/online/feed_governor.hpp>
#include <steadyrest/nc/interpret/program.hpp>
#include <steadyrest/nc/plan/path/path_builder.hpp>
#include <steadyrest/passport/file/machine_file.hpp>
#include <steadyrest/sim/simulated_machine.hpp>
#include <steadyrest/supervisor/supervisor.hpp>
#include <steadyrest/trial/timing/demanding_path.hpp>
#include <steadyrest/trial/timing/quantiles.hpp>

namespace steadyrest {
namespace {

using contour::online::FeedGovernor;
using kernel::machine::Machine;
using trial::timing::Quantiles;
using Path = std::shared_ptr<const nc::plan::PlannedPath>;
using Clock = std::chrono::steady_clock;

const std::string kExamples = std::string(STEADYREST_SOURCE_DIR) + "/examples/";
constexpr int kRounds = 3;
constexpr double kDemanding_s = 60.0;

/// A real program: the rib pocket as LinuxCNC's control would plan it.
Path rib_pocket(const Machine& machine) {
  nc::plan::PathBuilder builder(machine);
  benchmark::DoNotOptimize(
      nc::interpret::run_file(kExamples + "programs/rib-pocket.ngc", {}, builder).value());
  return std::make_shared<const nc::plan::PlannedPath>(builder.take().value());
}

/// One governor and the least time of each of its decisions.
class Timed {
 public:
  explicit Timed(FeedGovernor::Config config) : config_(std::move(config)) { begin(); }

  void begin() {
    governor_ = std::make_unique<FeedGovernor>(FeedGovernor::make(config_).value());
    next_ = 0;
  }
  void update(const kernel::signal::Frame& frame, const kernel::signal::InForce& in_force) {
    const auto before = Clock::now();
    const FeedGovernor::Output output = governor_->update(frame, in_force);
    const double took_s = std::chrono::duration<double>(Clock::now() - before).count();
    // Cycles without a decision are cheap and many; they would hide the cost of one with.
    if (!output.decided) {
      return;
    }
    if (next_ == least_s_.size()) {
      least_s_.push_back(took_s);
      forecasts_.push_back(output.forecasts);
    }
    least_s_[next_] = std::min(least_s_[next_], took_s);
    ++next_;
  }
  [[nodiscard]] Quantiles times_s() const { return trial::timing::quantiles(least_s_); }
  [[nodiscard]] Quantiles forecasts() const { return trial::timing::quantiles(forecasts_); }

 private:
  FeedGovernor::Config config_;
  std::unique_ptr<FeedGovernor> governor_;
  std::size_t next_ = 0;
  std::vector<double> least_s_;
  std::vector<double> forecasts_;
};

/// The layer that acts is a third governor inside the supervisor, so the two that are timed see the
/// same frames and neither changes the cut.
void cut(const Machine& machine, const Path& path, Timed& bounded, Timed& exhaustive) {
  bounded.begin();
  exhaustive.begin();
  auto port = sim::SimulatedMachine::make({.machine = machine, .path = path}).value();
  auto layer = supervisor::Supervisor::make(machine, port->capability()).value();
  layer.set_mode(kernel::machine::Mode::act);
  while (!port->finished()) {
    const auto frame = port->read().value();
    bounded.update(frame, layer.in_force());
    exhaustive.update(frame, layer.in_force());
    port->write(layer.update(frame)).value();
  }
}

void Decision201Steps(benchmark::State& state) {
  const Machine machine = passport::read(kExamples + "machines/linuxcnc-mill.toml").value();
  const bool pocket = state.range(0) == 0;
  const Path path =
      pocket ? rib_pocket(machine) : trial::timing::demanding_path(machine, kDemanding_s).value();
  FeedGovernor::Config config = FeedGovernor::Config::of(machine);
  // Defaults: the search bounded in steps and work.
  Timed bounded(config);
  config.work_share = 1.0;
  config.exhaustive_steps = std::numeric_limits<std::size_t>::max();
  // The same governor with every bound lifted.
  Timed exhaustive(config);
  for (auto _ : state) {
    for (int round = 0; round < kRounds; ++round) {
      cut(machine, path, bounded, exhaustive);
    }
  }
  const Quantiles us = bounded.times_s();
  const Quantiles all = exhaustive.times_s();
  state.counters["p50_us"] = 1e6 * us.p50;
  state.counters["p99.9_us"] = 1e6 * us.p999;
  state.counters["worst_us"] = 1e6 * us.worst;
  state.counters["forecasts"] = bounded.forecasts().p999;
  state.counters["all_p50_us"] = 1e6 * all.p50;
  state.counters["all_p99.9_us"] = 1e6 * all.p999;
  state.counters["all_worst_us"] = 1e6 * all.worst;
  state.counters["all_forecasts"] = exhaustive.forecasts().p999;
  state.counters["ratio"] = all.p999 / us.p999;
  state.SetLabel(pocket ? "rib pocket" : "demanding path");
}
BENCHMARK(Decision201Steps)->Arg(0)->Arg(1)->Iterations(1)->Unit(benchmark::kSecond);

}  // namespace
}  // namespace steadyrest
