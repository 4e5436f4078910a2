// SPDX-License-Identifier: Apache-2.0
// Cost of MotionEstimator for each edge and each tick: steadyrest_estimator_cost [RUNS]
// [ESTIMATES]. Each record is run RUNS times and each call counts with the median of its runs, so
// that the figures are the estimator's, not the system's. The baseline, reading the clock, is
// subtracted. The mean of the edges is from runs that read the clock once per cycle. ESTIMATES, a
// file, gets every estimate as doubles, to compare two builds bit for bit.
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <numeric>
#include <vector>

#include <fmt/core.h>

#include <steadyrest/motion/offline/scene/scene.hpp>
#include <steadyrest/motion/online/bounded/motion_estimator.hpp>

// The baseline of every call is the clock itself, taken as a median and subtracted.
namespace {

namespace offline = steadyrest::motion::offline;
namespace online = steadyrest::motion::online;
using Clock = std::chrono::steady_clock;

double ns_since(Clock::time_point from) {
  return std::chrono::duration<double, std::nano>(Clock::now() - from).count();
}

double at(std::vector<double>& values, double share) {
  const auto nth =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::ranges::nth_element(values, nth);
  return *nth;
}

double clock_ns() {
  std::vector<double> out;
  for (int i = 0; i < 10'001; ++i) {
    const auto from = Clock::now();
    out.push_back(ns_since(from));
  }
  return at(out, 0.5);
}

/// Times of the calls of a record, several runs of each.
/// Median over the runs of the same call: interruptions hit different calls in each run.
class Calls {
 public:
  void add(std::size_t call, double ns) {
    runs_.resize(std::max(runs_.size(), call + 1));
    runs_[call].push_back(ns);
  }
  [[nodiscard]] std::vector<double> medians() {
    std::vector<double> out;
    out.reserve(runs_.size());
    for (auto& runs : runs_) {
      out.push_back(runs.empty() ? 0.0 : at(runs, 0.5));
    }
    return out;
  }

 private:
  std::vector<std::vector<double>> runs_;
};

double sum(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

/// With limits the axis's own bounds narrow the estimate; the line error is the largest that the
/// record can contain: phases, and four standard deviations of single lines.
online::MotionEstimator estimator(const offline::Record& record, bool limits) {
  online::MotionEstimator::Config config{.count_mm = record.how.count_mm,
                                         .cycle_s = 1.0 / record.how.cycle_hz,
                                         .clock_s = record.how.clock_s};
  if (limits) {
    config.line_error_mm =
        record.how.count_mm * (record.how.phase_error_counts + 4.0 * record.how.line_error_counts);
    config.max_speed_mm_s = record.max_speed_mm_s;
    config.max_acceleration_mm_s2 = std::max(1.0, record.max_acceleration_mm_s2);
    config.max_jerk_mm_s3 = std::max(100.0, record.max_jerk_mm_s3);
  }
  return online::MotionEstimator::make(config).value();
}

/// The edges of each cycle together.
/// Reading the clock costs as much as an edge; once per cycle it is negligible in the mean.
void time_cycles(const offline::Record& record, bool limits, double reading_ns, Calls& cycles) {
  auto ours = estimator(record, limits);
  auto edge = record.edges.begin();
  for (std::size_t k = 0; k < record.ticks.size(); ++k) {
    const auto from = Clock::now();
    const auto first = edge;
    for (; edge != record.edges.end() && edge->t_s <= record.ticks[k].t_s; ++edge) {
      ours.edge(*edge);
    }
    if (edge != first) {
      cycles.add(k, ns_since(from) - reading_ns);
    }
    ours.tick(record.ticks[k]);
  }
}

/// Each edge and each tick separately.
std::vector<online::Estimate> time_calls(const offline::Record& record, bool limits,
                                         double reading_ns, Calls& edges, Calls& ticks) {
  auto ours = estimator(record, limits);
  std::vector<online::Estimate> out(record.ticks.size());
  std::size_t edge = 0;
  for (std::size_t k = 0; k < record.ticks.size(); ++k) {
    for (; edge < record.edges.size() && record.edges[edge].t_s <= record.ticks[k].t_s; ++edge) {
      const auto from = Clock::now();
      ours.edge(record.edges[edge]);
      edges.add(edge, ns_since(from) - reading_ns);
    }
    const auto from = Clock::now();
    out[k] = ours.tick(record.ticks[k]);
    ticks.add(k, ns_since(from) - reading_ns);
  }
  return out;
}

/// Runs of both kinds alternate, so that a slow spell of the computer hits both.
void measure(const offline::Record& record, bool limits, int runs, double reading_ns,
             std::FILE* estimates) {
  Calls cycles;
  Calls edges;
  Calls ticks;
  std::vector<online::Estimate> given;
  for (int run = 0; run < runs; ++run) {
    time_cycles(record, limits, reading_ns, cycles);
    given = time_calls(record, limits, reading_ns, edges, ticks);
  }
  if (estimates != nullptr) {
    std::fwrite(given.data(), sizeof given[0], given.size(), estimates);
  }
  std::vector<double> edge = edges.medians();
  std::vector<double> tick = ticks.medians();
  fmt::print("{:<20}{:<9}{:>7.0f}{:>7.0f}{:>7.0f}  {:>7.0f}{:>7.0f}{:>7.0f}\n", record.name,
             limits ? "limits" : "", sum(cycles.medians()) / static_cast<double>(edge.size()),
             at(edge, 0.999), at(edge, 1.0), sum(tick) / static_cast<double>(tick.size()),
             at(tick, 0.999), at(tick, 1.0));
}

/// From reversals at a crawl to half a million edges a second, and control cycles of 250 Hz to 10
/// kHz.
std::vector<offline::Record> records() {
  std::vector<offline::Record> out;
  const auto add = [&](const char* name, const offline::Profile& profile,
                       const offline::Recording& how) {
    out.push_back(offline::record(profile, how));
    out.back().name = name;
  };
  add("sine", offline::sine(1.0, 2.0, 1.0), {});
  add("sine, line errors", offline::sine(1.0, 2.0, 1.0),
      {.phase_error_counts = 0.05, .line_error_counts = 0.02});
  add("s-curve", offline::s_curve(), {});
  add("flywheel", offline::flywheel(6.0, -0.006), {.clock_s = 1e-6});
  add("dither", offline::dither(2e-4, 30.0, 1.0), {});
  add("slow, 0.3 mm/s", offline::constant_speed(0.3, 1.0), {});
  add("16 000 edges/s", offline::constant_speed(15.9, 1.0), {});
  add("100 000 edges/s", offline::constant_speed(100.0, 0.5), {});
  add("500 000 edges/s", offline::constant_speed(500.0, 0.2), {});
  add("sine, 10 kHz", offline::sine(1.0, 2.0, 0.5), {.cycle_hz = 10000.0});
  add("sine, 250 Hz", offline::sine(1.0, 2.0, 1.0), {.cycle_hz = 250.0});
  return out;
}

}  // namespace

int main(int argc, char** argv) {
  const int runs = argc > 1 ? std::max(1, std::atoi(argv[1])) : 11;
  std::FILE* estimates = argc > 2 ? std::fopen(argv[2], "wb") : nullptr;
  const double reading_ns = clock_ns();
  fmt::print("ns, clock {:.0f}{:<17}{:>7}{:>7}{:>7}  {:>7}{:>7}{:>7}\n", reading_ns, "", "edge",
             "99.9 %", "worst", "tick", "99.9 %", "worst");
  for (const offline::Record& record : records()) {
    measure(record, false, runs, reading_ns, estimates);
    measure(record, true, runs, reading_ns, estimates);
  }
  if (estimates != nullptr) {
    std::fclose(estimates);
  }
  return 0;
}
