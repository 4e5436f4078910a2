// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/thermal/offline/forecast.hpp>
#include <steadyrest/thermal/offline/identify.hpp>
#include <steadyrest/thermal/offline/replay.hpp>

// A machine that is known: the bed (90 min behind the room) moves it by 3 µm/K; the room is noisy,
// and the third sensor has nothing to do with it.
namespace steadyrest::thermal::offline {
namespace {

constexpr double kMinute_s = 60.0;

/// Runs of 3 h, each with 2 h of rest.
Log shop(unsigned seed, const std::vector<double>& runs_rpm) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  Log log;
  log.file = "shop.csv";
  log.displacement.push_back({"z_um", {}});
  for (const char* name : {"room_c", "bed_c", "other_c"}) {
    log.temperature.push_back({name, {}});
  }
  double fast_um = 0.0;
  double slow_um = 0.0;
  double draught_k = 0.0;
  double bed_k = 0.0;
  double other_k = 2.0;
  for (const double run_rpm : runs_rpm) {
    for (int minute = 0; minute < 300; ++minute) {
      const double t_s = kMinute_s * static_cast<double>(log.rows());
      const double krpm = minute < 180 ? run_rpm / 1000.0 : 0.0;
      draught_k += 0.05 * normal(random) - 0.01 * draught_k;
      const double room_k = 2.0 * std::sin(2.0 * std::numbers::pi * t_s / 86400.0) + draught_k;
      bed_k += (room_k - bed_k) / 90.0;
      other_k += 0.02 * normal(random) - 0.002 * (other_k - 2.0);
      fast_um += (2.7 * krpm - fast_um) / 20.0;
      slow_um += (4.7 * krpm - slow_um) / 110.0;
      log.time_s.push_back(t_s);
      log.speed_rev_s.push_back(1000.0 * krpm / 60.0);
      log.displacement[0].value.push_back(1e-3 *
                                          (fast_um + slow_um + 3.0 * bed_k + 0.3 * normal(random)));
      log.temperature[0].value.push_back(20.0 + room_k + 0.15 * normal(random));
      log.temperature[1].value.push_back(20.0 + bed_k + 0.02 * normal(random));
      log.temperature[2].value.push_back(20.0 + other_k + 0.02 * normal(random));
    }
  }
  return log;
}

const std::vector<double> kDays_rpm = {1500, 3000, 4500, 2000, 4000, 2500, 3500, 1000};

AxisFit fitted(const Log& log, double to_s, const std::vector<std::string>& sensors = {}) {
  FitRequest request;
  request.sensors = sensors;
  request.to_s = to_s;
  request.horizon_s = 3.0 * 3600.0;
  auto fit = identify(log, 0, "Z", request);
  EXPECT_TRUE(fit.has_value()) << fit.error().what;
  return fit ? *fit : AxisFit{};
}

/// Fitted to so many runs, forecasting the others.
ReplayScore kept_back(const Log& log, const AxisFit& fit, double from_s, double rezero_s) {
  ReplayRequest request;
  request.channel = 0;
  request.state_s = fit.end_s;
  request.from_s = from_s;
  request.rezero_s = rezero_s;
  const auto points = replay(fit.axis, log, request);
  EXPECT_TRUE(points.has_value()) << points.error().what;
  return points ? score(*points, fit.axis.noise_mm) : ReplayScore{};
}

/// What the choice is made by: running free and set right every hour count alike.
double measure_um(const AxisFit& fit) {
  return std::sqrt(fit.left_out_um * fit.left_out_probed_um);
}

TEST(SensorChoice, IsAsGoodAsTheBestOfTheSensorsAlone) {
  for (const unsigned seed : {1U, 2U}) {
    for (const std::size_t runs : {4U, 5U}) {
      const Log log = shop(seed, {kDays_rpm.begin(), kDays_rpm.begin() + static_cast<int>(runs)});
      const AxisFit all = fitted(log, 1e300);
      double best_um = 1e9;
      for (const char* sensor : {"room_c", "bed_c"}) {
        best_um = std::min(best_um, measure_um(fitted(log, 1e300, {sensor})));
      }
      EXPECT_LT(measure_um(all), 1.4 * best_um) << seed << " " << runs;
      EXPECT_GT(all.coverage, 0.9) << seed << " " << runs;
    }
  }
}

TEST(SensorChoice, TheBandHoldsOnHoursKeptBack) {
  for (const std::size_t runs : {4U, 6U}) {
    double free = 0.0;
    double probed = 0.0;
    constexpr std::array kSeeds = {1U, 2U, 3U};
    for (const unsigned seed : kSeeds) {
      const Log log = shop(seed, kDays_rpm);
      const double to_s = 300.0 * kMinute_s * static_cast<double>(runs);
      const AxisFit fit = fitted(log, to_s);
      free += kept_back(log, fit, to_s, 0.0).coverage / kSeeds.size();
      probed += kept_back(log, fit, to_s, 3600.0).coverage / kSeeds.size();
    }
    EXPECT_GT(free, 0.9) << runs;
    EXPECT_GT(probed, 0.9) << runs;
  }
}

}  // namespace
}  // namespace steadyrest::thermal::offline
