// SPDX-License-Identifier: Apache-2.0
// Interpolator: nanoseconds per update, with the same work on one long line as the baseline.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>
#include <vector>

#include <steadyrest/nc/plan/path/path_builder.hpp>
#include <steadyrest/nc/plan/time/interpolator.hpp>

namespace {

using steadyrest::kernel::machine::Machine;
using namespace steadyrest::nc;

Machine mill(double jerk_mm_s3) {
  Machine m;
  for (const char* name : {"X", "Y", "Z"}) {
    steadyrest::kernel::machine::Axis axis;
    axis.name = name;
    axis.max_jerk_au_s3 = jerk_mm_s3;
    m.axes.push_back(axis);
  }
  return m;
}

/// A polygon as a spiral: z rises, so that no two corners are alike.
plan::PlannedPath polygon(const Machine& m, int corners, double radius_mm, int turns) {
  plan::PathBuilder builder(m);
  interpret::Axes at{radius_mm};
  for (int i = 1; i <= corners * turns; ++i) {
    interpret::Move move;
    move.kind = interpret::MoveKind::linear;
    move.start = at;
    const double t = 2.0 * std::numbers::pi * i / corners;
    at = {radius_mm * std::cos(t), radius_mm * std::sin(t), 0.001 * i};
    move.end = at;
    move.feed_mm_s = 80.0;
    builder.on_move(move);
  }
  return builder.take().value();
}

void measure(const std::string& name, const Machine& m, const plan::PlannedPath& path,
             bool wobble) {
  using Clock = std::chrono::steady_clock;
  // A hundred updates between two readings of the clock, which costs as much as one update.
  constexpr std::size_t kBatch = 100;
  std::vector<double> batches;
  double worst = 0.0;
  std::size_t cycles = 0;
  double total = 0.0;
  auto interpolator = plan::Interpolator::make(m, plan::whole(path)).value();
  while (!interpolator.finished()) {
    const auto start = Clock::now();
    for (std::size_t i = 0; i < kBatch; ++i) {
      plan::Overrides o;
      // An override that moves every ten cycles makes the interpolator plan again and again.
      o.feed_ratio = wobble && (cycles / 10) % 2 == 0 ? 0.9 : 1.0;
      interpolator.update(o);
      ++cycles;
    }
    const double ns = std::chrono::duration<double, std::nano>(Clock::now() - start).count();
    batches.push_back(ns / kBatch);
    total += ns;
    worst = std::max(worst, ns / kBatch);
  }
  std::sort(batches.begin(), batches.end());
  std::printf("%-34s mean %6.0f  median %6.0f  p99.9 %6.0f  worst of %zu: %6.0f ns\n", name.c_str(),
              total / static_cast<double>(cycles), batches[batches.size() / 2],
              // The 99.9 % quantile of the batches.
              batches[batches.size() - 1 - batches.size() / 1000], kBatch, worst);
}

}  // namespace

int main() {
  for (const double jerk : {steadyrest::kernel::machine::kUnlimited, 50000.0}) {
    const auto m = mill(jerk);
    const std::string tag = std::isfinite(jerk) ? ", jerk limit" : "";
    measure("long lines" + tag, m, polygon(m, 4, 1000.0, 20), false);
    measure("0.1 mm segments" + tag, m, polygon(m, 628, 10.0, 60), false);
    measure("0.1 mm segments, override" + tag, m, polygon(m, 628, 10.0, 60), true);
  }
  return 0;
}
