// SPDX-License-Identifier: Apache-2.0
// Cost of the contour room in the control cycle: foot point and governor, over varied paths.
//
// Each benchmark replays recorded cycles and times every call. Counters: mean (of processor time,
// including the clock's two calls), median, p99.9 and worst in ns; `worst_cycle`, the most
// expensive cycle by the least of its repetitions: the algorithm's own worst case without the
// operating system's share; and `real_time`, the control's time over the time of the calls. The
// baseline of the same run is `EmptyCall`, the cost of the clock itself.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <vector>

#include <benchmark/benchmark.h>

#include <steadyrest/contour/online/contour_error.hpp>
#include <steadyrest/contour/online/feed_governor.hpp>
#include <steadyrest/contour/online/test/closed_loop.hpp>
#include <steadyrest/contour/online/test/paths.hpp>

// Frames are recorded first and replayed, so that only the calls are timed.
namespace steadyrest::contour::online {
namespace {

using test::ClosedLoop;
using test::kTurn;
using test::Machine;
using test::PathMaker;
using test::PathSegment;

enum PathKind { kArcs, kCamChords, kHelices, kSpirals, kCorners, kPocket, kPathKinds };
constexpr const char* kNames[] = {"arcs", "cam_10um", "helices", "spirals", "corners", "pocket"};

/// A rounded rectangle: the arcs force decisions, the lines let the governor recover.
void rounded(PathMaker& path, double a, double b, double r) {
  path.line_to({a - r, -b, 0}).arc({a - r, -b + r, 0}, kTurn / 4);
  path.line_to({a, b - r, 0}).arc({a - r, b - r, 0}, kTurn / 4);
  path.line_to({-a + r, b, 0}).arc({-a + r, b - r, 0}, kTurn / 4);
  path.line_to({-a, -b + r, 0}).arc({-a + r, -b + r, 0}, kTurn / 4);
  path.line_to({0, -b, 0});
}

std::vector<PathSegment> make_path(int kind) {
  PathMaker path({10, 0, 0}, 60.0);
  switch (kind) {
    case kArcs:
      path.arc({0, 0, 0}, 6 * kTurn);
      break;
    case kCamChords:
      path.chords({0, 0, 0}, 5 * kTurn, 0.01);
      break;
    case kHelices:
      path.arc({0, 0, 0}, 6 * kTurn, {0, 0, 1}, 6.0).arc({5, 0, 6}, 10 * kTurn, {0, 0, -1}, 3.0);
      break;
    case kSpirals:
      path.arc({0, 0, 0}, 6 * kTurn, {0, 0, 1}, 2.0, 8.0);
      break;
    case kCorners:
      for (int i = 0; i < 100; ++i) {
        const double x = 10.0 + 1.5 * i;
        path.line_to({x + 1.5, (i % 2) * 2.0, 0.0});
      }
      break;
    default:
      path = PathMaker({0, -30, 0}, 60.0);
      for (const double r : {2.0, 4.0, 8.0, 12.0}) {
        rounded(path, 50, 30, r);
      }
      path.arc({0, -10, 0}, 3 * kTurn, {0, 0, 1}, 0.0, -15.0);
  }
  return path.limited(2000.0, 5.0);
}

/// Frames with the envelope's output at the time of recording: the governor decides by both.
struct Recording {
  Machine machine;
  std::vector<PathSegment> path;
  std::vector<kernel::signal::Frame> frame;
  std::vector<kernel::signal::InForce> in_force;  ///< what came down with each
};

Recording record(int kind, double period_s) {
  Recording out;
  out.machine = test::mill(50.0);
  out.machine.control.interpolator_period_s = period_s;
  out.path = make_path(kind);
  ClosedLoop loop(out.machine, out.path);
  loop.disturb = [&](kernel::signal::Frame& frame) {
    out.frame.push_back(frame);
    out.in_force.push_back(loop.in_force());
  };
  loop.run(0.01, 0.0, 30.0);
  return out;
}

using Clock = std::chrono::steady_clock;

/// `least` is each frame's best time over the iterations. A cycle is deterministic, so its best
/// time is the algorithm's; the rest is the operating system's.
template <class Call>
void time_calls(benchmark::State& state, const Recording& recording, Call&& call) {
  std::vector<double> ns;
  ns.reserve(recording.frame.size() * 8);
  const std::clock_t begin = std::clock();
  std::vector<double> least(recording.frame.size(), 1e18);
  for (auto _ : state) {
    for (std::size_t i = 0; i < recording.frame.size(); ++i) {
      const auto before = Clock::now();
      call(recording.frame[i]);
      ns.push_back(std::chrono::duration<double, std::nano>(Clock::now() - before).count());
      least[i] = std::min(least[i], ns.back());
    }
  }
  // The mean is of the processor's time: a shared machine takes the core away now and then.
  const double sum = 1e9 * static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  std::ranges::sort(ns);
  const auto at = [&](double share) {
    return ns[static_cast<std::size_t>(share * static_cast<double>(ns.size() - 1))];
  };
  state.counters["mean_ns"] = sum / static_cast<double>(ns.size());
  state.counters["median_ns"] = at(0.5);
  state.counters["p99.9_ns"] = at(0.999);
  state.counters["worst_ns"] = ns.back();
  state.counters["worst_cycle_ns"] = *std::ranges::max_element(least);
  state.counters["real_time"] =
      recording.machine.control.interpolator_period_s * 1e9 * static_cast<double>(ns.size()) / sum;
  state.SetLabel(kNames[state.range(0)]);
}

void EmptyCall(benchmark::State& state) {
  const Recording recording = record(kArcs, 0.001);
  time_calls(state, recording,
             [](const kernel::signal::Frame& frame) { benchmark::DoNotOptimize(&frame); });
}
BENCHMARK(EmptyCall)->Arg(kArcs);

void FootPoint(benchmark::State& state) {
  const Recording recording = record(static_cast<int>(state.range(0)), 0.001);
  ContourError error = ContourError::make({}).value();
  time_calls(state, recording, [&](const kernel::signal::Frame& frame) {
    benchmark::DoNotOptimize(error.update(frame));
  });
}
BENCHMARK(FootPoint)->DenseRange(0, kPathKinds - 1)->Iterations(8);

/// Without the path the error comes only from following errors and the estimated curvature, as with
/// controls that show no path.
void FootPointWithoutPath(benchmark::State& state) {
  const Recording recording = record(static_cast<int>(state.range(0)), 0.001);
  ContourError error = ContourError::make({}).value();
  time_calls(state, recording, [&](kernel::signal::Frame frame) {
    frame.path = {};
    benchmark::DoNotOptimize(error.update(frame));
  });
}
BENCHMARK(FootPointWithoutPath)->DenseRange(0, kPathKinds - 1)->Iterations(8);

void Governor(benchmark::State& state) {
  Recording recording =
      record(static_cast<int>(state.range(0)), 1e-3 * static_cast<double>(state.range(1)));
  recording.machine.contour.strategy =
      static_cast<kernel::machine::ContourStrategy>(state.range(2));
  FeedGovernor governor = FeedGovernor::make(recording.machine).value();
  std::size_t next = 0;
  time_calls(state, recording, [&](const kernel::signal::Frame& frame) {
    benchmark::DoNotOptimize(governor.update(frame, recording.in_force[next]));
    next = (next + 1) % recording.in_force.size();
  });
}
// Feed priority on all paths; all strategies on the pocket, at 1 and 4 ms.
BENCHMARK(Governor)
    ->ArgsProduct({benchmark::CreateDenseRange(0, kPathKinds - 1, 1), {1}, {1}})
    ->Iterations(5);
BENCHMARK(Governor)->ArgsProduct({{kPocket}, {1, 4}, {0, 1, 2}})->Iterations(5);

}  // namespace
}  // namespace steadyrest::contour::online

BENCHMARK_MAIN();
