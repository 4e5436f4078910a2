// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/sim/heat/test/growing_axes.hpp>
#include <steadyrest/sim/heat/thermal_growth.hpp>

namespace steadyrest::sim {
namespace {

using kernel::machine::Thermal;
using kernel::machine::ThermalMode;
using test::ambient;
using test::kMinute;
using test::paper;

ThermalGrowth growth_of(const ThermalGrowth::Config& config) {
  auto made = ThermalGrowth::make(config);
  EXPECT_TRUE(made) << (made ? "" : made.error().what);
  return *std::move(made);
}

void run(ThermalGrowth& growth, double minutes, const ThermalGrowth::Input& input,
         double period_s) {
  for (int i = 0; i < static_cast<int>(std::lround(minutes * kMinute / period_s)); ++i) {
    growth.update(input);
  }
}

// Marusich's instants for shares of 10 µm: 0.0352·(1 − e^(−18/53.475)) = 0.0101 mm, and so on. The
// same at steps of 0.1 s and of a minute, since each step is exact.
TEST(ThermalGrowth, CrossesTheBordersOfThePaperAtItsInstants) {
  // 10, 20, 30 and 40 µm at the minutes 18, 45, 75 and 115, with any step.
  for (const double period_s : {0.1, 1.0, 15.0, 60.0}) {
    ThermalGrowth growth = growth_of({.passport = paper(), .period_s = period_s});
    const auto at = [&](double minutes, double rpm) {
      run(growth, minutes, {.speed_rev_s = rpm / 60.0}, period_s);
      return growth.displacement_mm(0) * 1e3;
    };
    EXPECT_NEAR(at(18, 1000), 10.0, 0.1);
    EXPECT_NEAR(at(27, 1000), 20.0, 0.1);
    EXPECT_NEAR(at(15, 1000), 23.75, 0.01);
    EXPECT_NEAR(at(15, -2000), 30.0, 0.1);  // whichever way it turns
    EXPECT_NEAR(at(40, 2000), 40.0, 0.1);
  }
}

/// The passport's law by the midpoint rule on the differential equation, ten thousand steps per
/// time constant: the oracle.
double integrate(const Thermal& thermal,
                 const std::vector<std::pair<double, ThermalGrowth::Input>>& work) {
  double sum = 0.0;
  for (const ThermalMode& m : thermal.axis[0].mode) {
    double x = 0.0;
    for (const auto& [seconds, in] : work) {
      const double n = std::abs(in.speed_rev_s) * 0.06;
      double g = m.polynomial_mm[0] * n + m.polynomial_mm[1] * n * n;
      g *= 1.0 + in.cutting * (m.cutting_ratio - 1.0);
      g = g * (in.coolant ? m.coolant_ratio : 1.0) + m.feed_s * in.feed_mm_s;
      const double tau = n == 0.0 ? m.rest_tau_s : m.tau_s;
      const int steps = static_cast<int>(seconds / tau * 1e4) + 1;
      const double h = seconds / steps;
      for (int i = 0; i < steps; ++i) {
        const double half = x + 0.5 * h * (g - x) / tau;
        x += h * (g - half) / tau;
      }
    }
    sum += x;
  }
  return sum;
}

// Three modes with everything the law contains, twenty machines, six spells of work each.
TEST(ThermalGrowth, IsTheIntegralOfTheLawForRandomMachinesAndWork) {
  std::mt19937_64 random(11);
  const auto uniform = [&](double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(random);
  };
  for (int round = 0; round < 20; ++round) {
    Thermal thermal;
    thermal.axis.resize(1);
    for (int i = 0; i < 3; ++i) {
      thermal.axis[0].mode.push_back({.tau_s = uniform(200, 9000),
                                      .rest_tau_s = uniform(200, 9000),
                                      .speed_rev_s = {},
                                      .level_mm = {},
                                      .polynomial_mm = {uniform(-0.02, 0.02), uniform(-0.01, 0.01)},
                                      .cutting_ratio = uniform(0.5, 2.0),
                                      .coolant_ratio = uniform(0.3, 1.0),
                                      .feed_s = uniform(-1e-4, 1e-4)});
    }
    std::vector<std::pair<double, ThermalGrowth::Input>> work;
    work.reserve(6);
    for (int i = 0; i < 6; ++i) {
      work.push_back({60.0 * std::round(uniform(1, 60)),
                      {.speed_rev_s = i % 3 == 2 ? 0.0 : uniform(5, 80),
                       .feed_mm_s = uniform(0, 50),
                       .cutting = uniform(0, 1),
                       .coolant = uniform(0, 1) > 0.5}});
    }
    ThermalGrowth growth = growth_of({.passport = thermal, .period_s = 1.0});
    for (const auto& [seconds, input] : work) {
      run(growth, seconds / kMinute, input, 1.0);
    }
    EXPECT_NEAR(growth.displacement_mm(0), integrate(thermal, work), 1e-7) << round;
  }
}

// The step response with τ and G times 1 + error; a list that is too short repeats its last value.
TEST(ThermalGrowth, IsWrongOnPurposeTermByTerm) {
  Thermal thermal = paper();
  thermal.axis.push_back(thermal.axis[0]);
  thermal.axis.push_back(thermal.axis[0]);
  thermal.axis[1].name = "Y";
  thermal.axis[2].name = "X";
  kernel::machine::Simulation simulation;
  simulation.thermal_tau_error_ratio = {0.2, -0.2};
  simulation.thermal_gain_error_ratio = {-0.2, 0.5};
  ThermalGrowth growth = growth_of({.passport = thermal, .simulation = simulation});
  run(growth, 30, {.speed_rev_s = 1000.0 / 60.0}, 1.0);
  const auto expected = [](double longer, double larger) {
    return 0.0352245 * larger * (1.0 - std::exp(-30.0 / (53.475 * longer)));
  };
  EXPECT_NEAR(growth.displacement_mm(0), expected(1.2, 0.8), 1e-12);
  EXPECT_NEAR(growth.displacement_mm(1), expected(0.8, 1.5), 1e-12);
  EXPECT_NEAR(growth.displacement_mm(2), expected(0.8, 1.5), 1e-12);  // the last for the rest
}

// A first-order lag answers a sine with 1/√(1 + (ωτ)²); the start is the reference, so the curve is
// relative to it.
TEST(ThermalGrowth, FollowsTheDayWithTheAnswerOfAFirstOrderLag) {
  const double tau_s = 2.0 * 3600.0;
  kernel::machine::Simulation simulation;
  simulation.room_swing_k = 4.0;
  simulation.room_start_s = 15.0 * 3600.0;
  ThermalGrowth growth =
      growth_of({.passport = ambient(0.005, tau_s), .simulation = simulation, .period_s = 10.0});
  EXPECT_NEAR(growth.room_c(), 24.0, 1e-9);
  EXPECT_EQ(growth.displacement_mm(0), 0.0);
  double most = -1.0;
  double least = 1.0;
  for (int i = 0; i < 3 * 8640; ++i) {
    growth.update({});
    if (i > 8640) {
      most = std::max(most, growth.displacement_mm(0));
      least = std::min(least, growth.displacement_mm(0));
    }
  }
  const double omega_tau = 2.0 * std::numbers::pi / 86400.0 * tau_s;
  EXPECT_NEAR(most - least, 2.0 * 0.005 * 4.0 / std::hypot(1.0, omega_tau), 1e-5);
  // It began at the warmest hour: where the lagged room is as warm as then, it is near 0.
  EXPECT_NEAR(most, 0.005 * 4.0 * (1.0 / std::hypot(1.0, omega_tau) - 1.0), 1e-5);
}

// 200 000 minutes: a correlation time of ten minutes leaves some 10 000 independent values, 1 % of
// the RMS.
TEST(ThermalGrowth, NoiseHasTheSizeOfTheMachineFile) {
  Thermal thermal = paper();
  thermal.axis[0].drift_mm = 0.009;  // what the layer believes of it
  thermal.axis[0].drift_tau_s = 600.0;
  kernel::machine::Simulation simulation;
  simulation.room_noise_k = 0.3;
  simulation.sensor_noise_k = 0.1;
  simulation.probe_noise_mm = 0.0005;
  ThermalGrowth growth = growth_of(
      {.passport = thermal, .simulation = simulation, .period_s = 60.0, .drift_mm = 0.002});
  EXPECT_EQ(growth.displacement_mm(0), 0.0);
  double room = 0.0;
  double sensor = 0.0;
  double probe = 0.0;
  double drift = 0.0;
  const int n = 200000;
  for (int i = 0; i < n; ++i) {
    growth.update({});
    room += std::pow(growth.room_c() - 20.0, 2);
    sensor += std::pow(growth.read_room_c() - growth.room_c(), 2);
    probe += std::pow(growth.read_probe_mm(0.02) - 0.02, 2);
    drift += std::pow(growth.displacement_mm(0), 2);
  }
  EXPECT_NEAR(std::sqrt(room / n), 0.3, 0.006);
  EXPECT_NEAR(std::sqrt(sensor / n), 0.1, 0.001);
  EXPECT_NEAR(std::sqrt(probe / n), 0.0005, 0.000005);
  EXPECT_NEAR(std::sqrt(drift / n), 0.002, 0.00004);
}

// Readings have their own stream: one more probe cycle must not change the weather.
TEST(ThermalGrowth, AReadingChangesNoTruthAndASeedGivesTheSameBytes) {
  kernel::machine::Simulation simulation;
  simulation.room_noise_k = 0.3;
  simulation.probe_noise_mm = 0.0005;
  const auto last = [&](std::uint64_t seed, bool reads) {
    simulation.seed = seed;
    ThermalGrowth growth = growth_of({.passport = ambient(0.005, 600.0), .simulation = simulation});
    for (int i = 0; i < 1000; ++i) {
      growth.update({});
      if (reads) {
        (void)growth.read_probe_mm(0.0);
      }
    }
    return growth.displacement_mm(0);
  };
  EXPECT_EQ(last(5, false), last(5, true));
  EXPECT_NE(last(5, false), last(6, false));
}

// One fault each; the first line proves that the unspoiled machine is accepted.
TEST(ThermalGrowth, RefusesWhatCannotBeAMachine) {
  const auto refused = [](auto change) {
    ThermalGrowth::Config config{.passport = ambient(0.005, 600.0), .simulation = {}};
    change(config);
    return !ThermalGrowth::make(config);
  };
  EXPECT_FALSE(refused([](auto&) {}));
  EXPECT_TRUE(refused([](auto& c) { c.period_s = 0.0; }));
  EXPECT_TRUE(refused([](auto& c) { c.passport.axis[0].mode[0].tau_s = 0.0; }));
  EXPECT_TRUE(refused([](auto& c) { c.passport.axis[0].mode[0].level_mm.pop_back(); }));
  EXPECT_TRUE(refused([](auto& c) { c.passport.axis[0].mode[0].speed_rev_s[1] = 0.0; }));
  EXPECT_TRUE(refused([](auto& c) { c.passport.axis[0].mode[0].polynomial_mm = {1.0}; }));
  EXPECT_TRUE(refused([](auto& c) { c.passport.axis[0].ambient[0].tau_s = -1.0; }));
  EXPECT_TRUE(refused([](auto& c) { c.passport.axis[0].drift_tau_s = 0.0; }));
  EXPECT_TRUE(refused([](auto& c) { c.simulation.thermal_tau_error_ratio = {-1.0}; }));
  EXPECT_TRUE(refused([](auto& c) {
    c.simulation.thermal_gain_error_ratio = {std::numeric_limits<double>::quiet_NaN()};
  }));
  EXPECT_TRUE(refused([](auto& c) { c.simulation.probe_noise_mm = -1.0; }));
}

}  // namespace
}  // namespace steadyrest::sim
