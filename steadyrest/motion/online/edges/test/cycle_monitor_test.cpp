// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/kernel/file/testing/recorded.hpp>
#include <steadyrest/kernel/rt/testing/allocation_guard.hpp>
#include <steadyrest/motion/online/edges/cycle_monitor.hpp>

namespace steadyrest::motion::online {
namespace {

CycleMonitor::Report report_of(const std::vector<double>& stamps, double nominal_s = 0.0) {
  auto monitor = CycleMonitor::make({.nominal_period_s = nominal_s}).value();
  const kernel::rt::testing::AllocationGuard guard;
  for (const double t : stamps) {
    monitor.update(t);
  }
  return monitor.report();
}

// Ticks at kT + j: a period is the difference of two, σ_p = √2·σ_t, and neighbours share a tick
// with opposite signs: correlation −½.
TEST(CycleMonitor, FindsTheSpreadOfTicksThatWanderAboutTheirGrid) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> jitter(0.0, 2e-6);
  std::vector<double> stamps;
  for (int k = 0; k < 400'000; ++k) {
    stamps.push_back(k * 1e-3 + jitter(random));
  }
  const auto r = report_of(stamps, 1e-3);
  const double sigma = std::numbers::sqrt2 * 2e-6;
  EXPECT_EQ(r.periods, stamps.size() - 1);
  EXPECT_NEAR(r.mean_period_s, 1e-3, 1e-10);
  EXPECT_NEAR(r.period_rms_s, sigma, 0.005 * sigma);
  EXPECT_NEAR(r.tick_rms_s, 2e-6, 1e-8);
  EXPECT_NEAR(r.period_correlation, -0.5, 0.005);
  // |N(0, σ)| stays below 3.2905·σ in 99.9 % of cases; bins are 3.2 % wide and rounded up.
  EXPECT_GT(r.deviation_p999_s, 0.985 * 3.2905 * sigma);
  EXPECT_LT(r.deviation_p999_s, 1.047 * 3.2905 * sigma);
}

// Even in ± 10 %: σ = 10⁻⁴/√3, no tick shared, correlation 0.
TEST(CycleMonitor, TellsPeriodsThatAddUpFromTicksOnAGrid) {
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> period(0.9e-3, 1.1e-3);
  std::vector<double> stamps{0.0};
  for (int k = 0; k < 200'000; ++k) {
    stamps.push_back(stamps.back() + period(random));
  }
  const auto r = report_of(stamps, 1e-3);
  EXPECT_NEAR(r.period_correlation, 0.0, 0.01);
  EXPECT_NEAR(r.period_rms_s, 1e-4 / std::sqrt(3.0), 2e-7);
  EXPECT_NEAR(r.shortest_s, 0.9e-3, 1e-8);
  EXPECT_NEAR(r.longest_s, 1.1e-3, 1e-8);
  EXPECT_GT(r.deviation_p999_s, 0.998e-4);
  EXPECT_LT(r.deviation_p999_s, 1.001e-4);
}

// 3 ms miss two cycles, 1.999 ms one, 20 ms are a gap; 999 − 3 periods remain.
TEST(CycleMonitor, CountsMissedCyclesAndGapsAndKeepsThemOutOfTheSpread) {
  std::vector<double> stamps;
  double t = 5.0;
  for (int k = 0; k < 1000; ++k) {
    stamps.push_back(t);
    t += k == 200 ? 3e-3 : (k == 500 ? 0.02 : (k == 700 ? 1.999e-3 : 1e-3));
  }
  const auto r = report_of(stamps);
  EXPECT_NEAR(r.nominal_period_s, 1e-3, 1e-12);
  EXPECT_EQ(r.missed_cycles, 3U);
  EXPECT_EQ(r.gaps, 1U);
  EXPECT_NEAR(r.longest_gap_s, 0.02, 1e-12);
  EXPECT_EQ(r.periods, 996U);
  EXPECT_LT(r.period_rms_s, 1e-12);
  EXPECT_LT(r.longest_s, 1.0001e-3);
}

TEST(CycleMonitor, TimeThatRunsBackOrIsNoNumberIsCountedAndNotUsed) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInf = std::numeric_limits<double>::infinity();
  std::vector<double> stamps;
  for (int k = 0; k < 100; ++k) {
    stamps.push_back(k * 1e-3);
    if (k % 10 == 5) {
      stamps.insert(stamps.end(), {kNan, (k - 3) * 1e-3, kInf, k * 1e-3, -kInf});
    }
  }
  const auto r = report_of(stamps);
  EXPECT_EQ(r.not_finite, 30U);
  EXPECT_EQ(r.backwards, 20U);
  EXPECT_EQ(r.periods, 99U);
  EXPECT_EQ(r.missed_cycles, 0U);
  EXPECT_LT(r.period_rms_s, 1e-15);
}

// Three stamps in the past mean that the clock was set; one or two are bad stamps.
TEST(CycleMonitor, GoesOnAfterTheClockWasSetBack) {
  std::vector<double> stamps;
  for (int k = 0; k < 100; ++k) {
    stamps.push_back(1000.0 + k * 1e-3);
  }
  for (int k = 0; k < 100; ++k) {
    stamps.push_back(k * 1e-3);
  }
  const auto r = report_of(stamps, 1e-3);
  EXPECT_EQ(r.backwards, 3U);
  EXPECT_EQ(r.periods, 99U + 97U);
  EXPECT_EQ(r.gaps, 0U);
}

TEST(CycleMonitor, RefusesWhatIsNoPeriod) {
  EXPECT_FALSE(CycleMonitor::make({.nominal_period_s = -1e-3}));
  EXPECT_FALSE(CycleMonitor::make({.nominal_period_s = std::nan("")}));
  EXPECT_FALSE(CycleMonitor::make({.gap_cycles = 1.5}));
}

/// Time stamps of a recorded log; empty where it is absent.
std::vector<double> stamps_of(const std::filesystem::path& file) {
  std::vector<double> out;
  if (!std::filesystem::exists(file)) {
    return out;
  }
  FILE* pipe = popen(("zcat '" + file.string() + "'").c_str(), "r");
  std::array<char, 128> row{};
  while (pipe != nullptr && std::fgets(row.data(), row.size(), pipe) != nullptr) {
    char* end = nullptr;
    const double t = std::strtod(row.data(), &end);
    if (end != row.data()) {
      out.push_back(t);
    }
  }
  if (pipe != nullptr) {
    pclose(pipe);
  }
  return out;
}

TEST(CycleMonitor, AgreesWithAnotherProgramOnTheRecordedServoAxis) {
  struct Known {
    const char* name;
    std::uint64_t periods;
    double rms_us, shortest_us, longest_us, p999_us;
    std::uint64_t gaps;
  };
  // From the logs by Python's statistics module; of the excerpts, tests/recorded/make_excerpts.py
  // --figures.
  constexpr std::array kKnown{Known{"k0m0.06", 8126, 3.2351, 900.0, 1100.0, 70.881, 0},
                              Known{"k12m", 21398, 11.3933, 895.81, 1104.19, 100.238, 1},
                              Known{"k3m0.07", 12223, 14.3829, 895.774, 1104.226, 100.262, 0},
                              Known{"k50m", 6873, 0.63058, 947.952, 1001.19, 0.262, 0},
                              Known{"torque_oscillation", 14894, 2.32150, 900.0, 1100.0, 0.238, 0},
                              Known{"servo-gap", 1998, 10.2157, 899.762, 1100.238, 100.238, 1},
                              Known{"servo-slow", 1999, 14.1846, 899.738, 1100.262, 100.262, 0}};
  std::size_t seen = 0;
  for (const Known& known : kKnown) {
    const auto whole =
        kernel::file::testing::shared_data() / "encoder" / (std::string(known.name) + ".csv.gz");
    const bool is_whole = std::filesystem::exists(whole);
    const std::vector<double> stamps =
        stamps_of(is_whole ? whole : kernel::file::testing::excerpt(known.name));
    if (stamps.empty()) {
      continue;  // a complete log that is not here
    }
    ++seen;
    const auto r = report_of(stamps);
    EXPECT_NEAR(r.nominal_period_s * 1e6, 1000.0, 0.3) << known.name;
    EXPECT_EQ(r.periods, known.periods) << known.name;
    EXPECT_NEAR(r.period_rms_s * 1e6, known.rms_us, 1e-3 * known.rms_us) << known.name;
    EXPECT_NEAR(r.shortest_s * 1e6, known.shortest_us, 1e-3) << known.name;
    EXPECT_NEAR(r.longest_s * 1e6, known.longest_us, 1e-3) << known.name;
    EXPECT_GE(r.deviation_p999_s * 1e6, 0.99 * known.p999_us) << known.name;
    EXPECT_LE(r.deviation_p999_s * 1e6, 1.04 * known.p999_us) << known.name;
    EXPECT_EQ(r.gaps, known.gaps) << known.name;
    EXPECT_EQ(r.backwards, 0U) << known.name;
    if (known.gaps == 1) {
      EXPECT_NEAR(r.longest_gap_s, 6.152254411, 1e-9);
    }
  }
  EXPECT_GE(seen, 2U) << "the excerpts are always here";
}

}  // namespace
}  // namespace steadyrest::motion::online
