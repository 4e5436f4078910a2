// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <random>
#include <string>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include <steadyrest/kernel/file/testing/recorded.hpp>
#include <steadyrest/kernel/testing/cases.hpp>
#include <steadyrest/thermal/offline/fit/identify.hpp>
#include <steadyrest/thermal/offline/fit/structure_fit.hpp>
#include <steadyrest/thermal/offline/plan/replay.hpp>
#include <steadyrest/thermal/offline/test/synthetic_log.hpp>

namespace steadyrest::thermal::offline {
namespace {

namespace fs = std::filesystem;
using kernel::testing::cases;

using test::kDays;

/// A machine with one mode whose six temperatures, all wandering, displace it with lags of 50 min.
Log six_sensors() {
  Log log = test::log_of({{{40.0, 4.0}}, 0.3}, kDays);
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  for (int s = 0; s < 6; ++s) {
    LogChannel sensor{"t" + std::to_string(s + 1) + "_c", {}};
    const double gain_mm_k = 1e-3 * (s % 2 == 0 ? 2.0 : -2.5);
    double t = 0.0;
    double lagged = 0.0;
    for (double& displacement : log.displacement[0].value) {
      sensor.value.push_back(20.0 + t);
      displacement += gain_mm_k * lagged;
      lagged = t + (lagged - t) * std::exp(-1.0 / 50.0);
      // A random walk pulled back to 20 °C within hours, like a shop's air.
      t += 0.05 * normal(random) - 0.002 * t;
    }
    log.temperature.push_back(std::move(sensor));
  }
  return log;
}

ReplayScore ahead(const Log& log, const AxisFit& fit, std::size_t channel, double rezero_s = 0.0) {
  ReplayRequest request;
  request.channel = channel;
  request.state_s = fit.end_s;
  request.rezero_s = rezero_s;
  const auto points = replay(fit.axis, log, request);
  EXPECT_TRUE(points.has_value());
  return points ? score(*points, fit.axis.noise_mm) : ReplayScore{};
}

// The readings of a linear model with a normal prior, drift and noise are one normal vector; its
// density, written out.
TEST(DenseFit, EvidenceIsTheDensityOfTheReadings) {
  const Log log = test::log_of({{{40.0, 4.0}}, 0.5, 3.0, 30.0}, {{60, 3000}, {60, 0}}, 2);
  const FitData data = fit_data(log, 0, -1e300, 1e300);
  Structure structure;
  structure.mode = {{2400.0, 0.0}};
  structure.ambient = {{0, 1800.0}, {1, 0.0}};
  structure.usual = {20.0, 3.0, 10.0};
  const ErrorModel error{1.5, 3600.0, 0.4};
  const Eigen::MatrixXd columns = columns_of(structure, log, data.row);
  const LinearPrior prior = wide_prior(structure, data);
  const auto n = static_cast<Eigen::Index>(data.rows());
  const Eigen::MatrixXd precision = prior.root.transpose() * prior.root;
  Eigen::MatrixXd covariance =
      columns * precision.ldlt().solve(Eigen::MatrixXd(columns.transpose()));
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) {
      const double apart_s = std::abs(data.time_s[static_cast<std::size_t>(i)] -
                                      data.time_s[static_cast<std::size_t>(j)]);
      // Covariance of a first-order drift: d²·e^(−|t|/τ).
      covariance(i, j) += error.drift_um * error.drift_um * std::exp(-apart_s / error.tau_s);
    }
    covariance(i, i) += error.noise_um * error.noise_um;
  }
  const Eigen::LLT<Eigen::MatrixXd> root(covariance);
  const Eigen::VectorXd white = root.matrixL().solve(data.reading_um);
  const double log_det = 2.0 * root.matrixLLT().diagonal().array().log().sum();
  EXPECT_NEAR(log_evidence(fit_linear(columns, data, error, prior), prior),
              -0.5 * (white.squaredNorm() + log_det), 1e-3)
      << "the free constant costs the written-out matrix ten digits";
}

// Six equal causes: a choice of two must omit two thirds of them, and its forecast shows it.
TEST(DenseFit, ManyTemperaturesThatEachTellALittleAreAllTaken) {
  const Log log = six_sensors();
  FitRequest request;
  request.to_s = 1440.0 * 60.0;  // three of four days
  const auto all = identify(log, 0, "Z", request);
  ASSERT_TRUE(all.has_value());
  EXPECT_EQ(all->axis.ambient.size(), 18U) << "six, with three lags each";
  request.sensors = {"t1_c", "t2_c"};
  const auto two = identify(log, 0, "Z", request);
  ASSERT_TRUE(two.has_value());
  const ReplayScore by_all = ahead(log, *all, 0);
  EXPECT_LT(2.0 * by_all.rms_mm, ahead(log, *two, 0).rms_mm);
  EXPECT_GT(by_all.coverage, 0.85);
}

// The targets for hours kept back, on the last of the recorded pairs: fitted to the first
// 32 h, free and with an hourly probe; and from the first hour of each run to its fourth.
TEST(DenseFit, RecordedHoursThatChoseNothingAreForecast) {
  const fs::path path = kernel::file::testing::shared_data() / "thermal/spindle_unit.csv.gz";
  const auto log = read_log(path.string());
  if (!log) {
    GTEST_SKIP() << "no recorded data";
  }
  struct Target {
    std::size_t channel;
    double free_um;
    double probed_um;
    double fourth_hour_um;
  };
  for (const Target target :
       cases({Target{0, 3.2, 0.9, 1.6}, Target{2, 6.5, 2.8, 5.0}, Target{4, 4.0, 1.4, 8.0}})) {
    SCOPED_TRACE(target.channel);
    FitRequest request;
    constexpr double kLastPair_s = 1927.75 * 60.0;
    request.to_s = kLastPair_s;
    const auto fit = identify(*log, target.channel, "Z", request);
    ASSERT_TRUE(fit.has_value());
    const ReplayScore free = ahead(*log, *fit, target.channel);
    EXPECT_LT(1e3 * free.rms_mm, target.free_um);
    EXPECT_GT(free.coverage, 0.85);
    const ReplayScore probed = ahead(*log, *fit, target.channel, 3600.0);
    EXPECT_LT(1e3 * probed.rms_mm, target.probed_um);
    EXPECT_GT(probed.coverage, 0.90);
    for (const double start_s : {kLastPair_s, kLastPair_s + 14400.0}) {
      FitRequest hour;
      hour.known = &fit->axis;
      hour.from_s = start_s;
      hour.to_s = start_s + 3600.0;
      const auto renewed = identify(*log, target.channel, "Z", hour);
      ASSERT_TRUE(renewed.has_value());
      ReplayRequest on;
      on.channel = target.channel;
      // The hour's own passport forecasts the other three of the run.
      on.state_s = renewed->end_s;
      const auto points = replay(renewed->axis, *log, on);
      ASSERT_TRUE(points.has_value());
      for (const ReplayPoint& p : *points) {
        if (std::abs(p.time_s - start_s - 239.0 * 60.0) < 8.0) {
          const double off_mm = std::abs(p.measured_mm - p.displacement_mm);
          EXPECT_LT(1e3 * off_mm, target.fourth_hour_um);
          EXPECT_LT(off_mm, 1.96 * p.sd_mm + 1e-4) << "and the band says so";
        }
      }
    }
  }
}

}  // namespace
}  // namespace steadyrest::thermal::offline
