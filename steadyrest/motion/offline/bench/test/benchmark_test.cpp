// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/motion/offline/bench/benchmark.hpp>
#include <steadyrest/motion/offline/bench/requirement.hpp>
#include <steadyrest/motion/offline/log/recorded_axis.hpp>

namespace steadyrest::motion::offline {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

Benchmark bench(std::vector<std::string> scenes, std::vector<std::string> estimators) {
  BenchConfig config;
  config.scenes = std::move(scenes);
  config.estimators = std::move(estimators);
  config.phases = 1;
  config.repetitions = 1;
  return run_benchmark(config).value();
}

const BenchRow& row(const Benchmark& benchmark, std::string_view scene, std::string_view estimator,
                    bool limits = false) {
  return *std::ranges::find_if(benchmark.rows, [&](const BenchRow& r) {
    return r.scene == scene && r.estimator == estimator && r.limits == limits;
  });
}

TEST(Benchmark, TheDifferenceErrsByTheClosedForm) {
  // RMS 0.408·q/T and 0.707·q/T² where all phases and speeds occur: q = 1 µm, T = 1 ms.
  const Benchmark sine = bench({"sine"}, {"difference"});
  const BenchRow& difference = row(sine, "sine", "difference");
  EXPECT_NEAR(difference.velocity.rms, 1.0 / std::sqrt(6.0), 0.03);
  EXPECT_NEAR(difference.acceleration.rms, 1000.0 / std::sqrt(2.0), 50.0);
  EXPECT_EQ(difference.velocity_gain, 1.0);
  // At a constant speed of n + f counts/tick: √(f·(1 − f)).
  const Benchmark constant = bench({"constant-5"}, {"difference"});
  EXPECT_NEAR(row(constant, "constant-5", "difference").velocity.rms, std::sqrt(0.382 * 0.618),
              0.005);
}

TEST(Benchmark, OursIsFinerThanTheDifferenceByTheTargetsFactor) {
  const Benchmark all = bench({"sine", "sine-line"}, {"kalman", "difference"});
  EXPECT_GT(row(all, "sine", "kalman", true).velocity_gain, 0.43 / 0.0015);
  EXPECT_GT(row(all, "sine", "kalman", true).acceleration_gain, 707.0 / 2.0);
  EXPECT_GT(row(all, "sine-line", "kalman").velocity_gain, 0.43 / 0.010);
  EXPECT_EQ(row(all, "sine", "kalman", true).velocity.coverage, 1.0);
  EXPECT_EQ(row(all, "sine", "kalman", true).contradictions, 0U);
  EXPECT_GT(row(all, "sine", "kalman", true).velocity_efficiency, 0.6);
  EXPECT_LT(row(all, "sine", "kalman", true).velocity_efficiency, 1.0);
  EXPECT_TRUE(std::isnan(row(all, "sine-line", "kalman", true).velocity_efficiency));
}

TEST(Benchmark, AShiftShowsTheLagOfTheDifference) {
  // Over m = 1 tick the difference is the velocity half a tick ago.
  const Benchmark sine = bench({"sine"}, {"difference", "pll"});
  EXPECT_NEAR(row(sine, "sine", "difference").velocity.own_lag_s, 0.5e-3, 0.26e-3);
  // 2/b − T/2 for b = 300 rad/s.
  EXPECT_NEAR(row(sine, "sine", "pll").velocity.own_lag_s, 2.0 / 300.0 - 0.5e-3, 0.26e-3);
  EXPECT_LE(row(sine, "sine", "pll").velocity.rms_at_own_lag,
            row(sine, "sine", "pll").velocity.rms);
}

TEST(Benchmark, JitterHurtsDifferencesAndNotEvents) {
  // √2·σ_t·v/T on top of the quantisation: v RMS = 2π·2·√½ mm/s, σ_t = 100 µs.
  const Benchmark all = bench({"sine", "jitter-100us"}, {"kalman", "difference"});
  const double v_rms = 4.0 * 3.14159265 / std::sqrt(2.0);
  const double law = std::hypot(1.0 / std::sqrt(6.0), std::sqrt(2.0) * 0.1 * v_rms);
  EXPECT_NEAR(row(all, "jitter-100us", "difference").velocity.rms, law, 0.1 * law);
  EXPECT_LT(row(all, "jitter-100us", "kalman").velocity.rms,
            1.2 * row(all, "sine", "kalman").velocity.rms);
}

TEST(Benchmark, CalibrationHelps) {
  const Benchmark all = bench({"sine-line", "sine-line-calibrated"}, {"kalman"});
  EXPECT_LT(row(all, "sine-line-calibrated", "kalman", true).velocity.rms,
            0.8 * row(all, "sine-line", "kalman", true).velocity.rms);
}

TEST(Benchmark, CsvHasAFieldForEachColumn) {
  const std::string csv = to_csv(bench({"dither"}, {"kalman", "difference"}));
  std::istringstream lines(csv);
  std::string line;
  std::vector<std::ptrdiff_t> commas;
  while (std::getline(lines, line)) {
    commas.push_back(std::ranges::count(line, ','));
  }
  ASSERT_EQ(commas.size(), 4U);
  EXPECT_THAT(commas, testing::Each(24));
  EXPECT_THAT(csv, testing::StartsWith("scene,estimator,limits,ticks,velocity_rms_mm_s,"));
  EXPECT_THAT(csv, HasSubstr("\ndither,kalman,1,"));
}

TEST(Benchmark, RefusesWhatItDoesNotKnow) {
  BenchConfig config;
  config.scenes = {"sine", "no-scene"};
  EXPECT_THAT(run_benchmark(config).error().what, HasSubstr("no-scene"));
  config.scenes = {"recorded"};
  EXPECT_THAT(run_benchmark(config).error().to_do, HasSubstr("--recorded"));
  config.scenes = {"sine"};
  config.estimators = {"no-estimator"};
  EXPECT_THAT(run_benchmark(config).error().what, HasSubstr("no-estimator"));
  config.estimators = {};
  config.phases = 0;
  EXPECT_FALSE(run_benchmark(config).has_value());
  config.phases = 1;
  config.scenes = {"recorded"};
  config.recorded_folder = "/nowhere";
  EXPECT_THAT(run_benchmark(config).error().file, HasSubstr("/nowhere"));
}

TEST(Benchmark, SaysWhyThePeerIsLeftOut) {
  BenchConfig config;
  config.scenes = {"sine"};
  config.estimators = {"difference"};
  config.repetitions = 1;
  config.peer = "/nowhere/peer";
  const Benchmark benchmark = run_benchmark(config).value();
  EXPECT_EQ(benchmark.rows.size(), 1U);
  ASSERT_EQ(benchmark.notes.size(), 1U);
  EXPECT_EQ(benchmark.scenes.size(), 1U);
  EXPECT_THAT(benchmark.notes.front(), HasSubstr("linuxcnc-encoder on sine: left out"));
}

TEST(Requirement, VerdictsFollowFromTheirNumbers) {
  RequirementConfig config;
  config.speeds_mm_s = {5.0};
  config.clocks_s = {1e-7};
  config.line_errors_counts = {0.0, 0.02};
  config.jerks_mm_s3 = {5000.0};
  config.cycles_hz = {1000.0};
  const auto rows = requirement_table(config).value();
  ASSERT_EQ(rows.size(), 8U);
  for (const RequirementRow& r : rows) {
    EXPECT_EQ(r.guaranteed == Verdict::met, r.bound <= r.required);
    EXPECT_EQ(r.typical == Verdict::met, r.rms <= r.required);
    EXPECT_EQ(r.guaranteed == Verdict::forbidden,
              r.bound > r.required && r.guaranteed_floor > r.required);
    EXPECT_LE(r.rms, r.bound);
  }
  EXPECT_DOUBLE_EQ(rows[0].required, 0.01);
  EXPECT_DOUBLE_EQ(rows[1].required, 0.003);
  EXPECT_DOUBLE_EQ(rows[2].required, 10.0);
  EXPECT_DOUBLE_EQ(rows[3].required, 1.0);
  EXPECT_EQ(rows[0].guaranteed, Verdict::met);
  EXPECT_EQ(rows[3].guaranteed, Verdict::forbidden);
}

/// 600 counts/s up and down again in fine counts, one row per millisecond.
EdgeLog triangle() {
  EdgeLog log;
  log.file = "triangle.csv";
  for (int i = 0; i < 1000; ++i) {
    const int up = i < 500 ? i : 1000 - i;
    log.rows.push_back({i * 1e-3, static_cast<std::int64_t>(std::floor(38.4 * up))});
  }
  return log;
}

TEST(RecordedAxis, EdgesAgreeWithTheTicks) {
  const RecordedAxis axis = recorded_axis(triangle());
  const Record& record = axis.record;
  auto edge = record.edges.begin();
  std::int64_t count = record.ticks.front().count;
  for (const online::Tick& tick : record.ticks) {
    for (; edge != record.edges.end() && edge->t_s <= tick.t_s; ++edge) {
      ASSERT_EQ(edge->direction > 0 ? edge->line - 1 : edge->line, count);
      count = edge->direction > 0 ? edge->line : edge->line - 1;
    }
    ASSERT_EQ(count, tick.count);
  }
  EXPECT_EQ(edge, record.edges.end());
  EXPECT_NEAR(record.truth[250].velocity_mm_s, 0.6, 0.01);
  EXPECT_NEAR(record.truth[750].velocity_mm_s, -0.6, 0.01);
}

TEST(RecordedAxis, GapsAndGlitchesAreNotScored) {
  EdgeLog log = triangle();
  for (std::size_t i = 200; i < log.rows.size(); ++i) {
    log.rows[i].t_s += 5.0;
  }
  log.rows[700].count += 2000;  // one counter error
  const RecordedAxis axis = recorded_axis(log);
  for (std::size_t i = 185; i <= 215; ++i) {
    EXPECT_EQ(axis.scored[i], 0) << i;
  }
  for (std::size_t i = 687; i <= 713; ++i) {
    EXPECT_EQ(axis.scored[i], 0) << i;
  }
  EXPECT_NE(axis.scored[300], 0);
  EXPECT_TRUE(std::ranges::any_of(axis.record.edges, [](const auto& e) { return e.lost != 0; }));
}

}  // namespace
}  // namespace steadyrest::motion::offline
