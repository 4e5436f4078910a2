// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <random>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include <steadyrest/thermal/offline/plan/curve.hpp>
#include <steadyrest/thermal/offline/plan/forecast.hpp>

namespace steadyrest::thermal::offline {
namespace {

using kernel::machine::ThermalAxis;

ThermalAxis machine() {
  ThermalAxis axis;
  axis.mode.resize(2);
  axis.mode[0].tau_s = 1200.0;
  axis.mode[0].speed_rev_s = {0.0, 20.0, 60.0};
  axis.mode[0].level_mm = {0.0, 0.010, 0.018};
  axis.mode[1].tau_s = 8000.0;
  axis.mode[1].polynomial_mm = {-0.006, 0.001};
  axis.ambient.push_back({.sensor = "room",
                          .tau_s = 3000.0,
                          .gain_mm_k = 0.002,
                          .reference_c = 20.0,
                          .state_c = 20.0});
  return axis;
}

Cyclogram cyclogram() {
  return *parse_cyclogram(
      "[[transition]]\nminutes = 50\nspeed_rpm = 2000\n[[transition]]\nminutes = 20\nspeed_rpm = "
      "0\n[[transition]]\nminutes = 90\nspeed_rpm = 3300\n",
      "c.toml");
}

online::ThermalModel made(const ThermalAxis& axis) {
  auto model = online::ThermalModel::make(axis);
  EXPECT_TRUE(model);
  online::Drive room;
  room.ambient_c[0] = 20.0;
  model->update(0.0, room);
  return *model;
}

TEST(Forecast, IsTheCurveInClosedForm) {
  const Curve curve = curve_of(made(machine()), cyclogram(), {24.0});
  const auto points = forecast(made(machine()), cyclogram(), 47.0, {24.0});
  for (const ForecastPoint& p : points) {
    ASSERT_NEAR(p.displacement_mm, curve.at(p.time_s), 1e-13) << p.time_s;
    EXPECT_EQ(p.sd_mm, 0.0) << "all is taken as known";
  }
  EXPECT_DOUBLE_EQ(points.back().time_s, 9600.0);
}

/// The spread of many machines drawn from the passport's own covariance.
TEST(Forecast, UncertaintyIsTheSpreadOfMachinesDrawnFromTheCovariance) {
  ThermalAxis axis = machine();
  Eigen::MatrixXd root = Eigen::MatrixXd::Zero(6, 6);
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j <= i; ++j) {
      // A Cholesky root with correlations, so that a covariance taken as diagonal would show.
      root(i, j) = (i == j ? 0.8 : 0.2 * normal(random)) * (i == 5 ? 0.1 : 1.0);
    }
  }
  const Eigen::MatrixXd covariance = root * root.transpose();
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j <= i; ++j) {
      axis.covariance.push_back(covariance(i, j));
    }
  }
  axis.mode[0].tau_sd_ratio = 0.03;
  axis.mode[1].tau_sd_ratio = 0.04;
  const auto points = forecast(made(axis), cyclogram(), 600.0, {24.0});
  std::vector<double> sum(points.size(), 0.0);
  std::vector<double> squares(points.size(), 0.0);
  constexpr int kMachines = 4000;
  for (int run = 0; run < kMachines; ++run) {
    Eigen::VectorXd draw(6);
    for (int i = 0; i < 6; ++i) {
      draw(i) = normal(random);
    }
    const Eigen::VectorXd by = root * draw * 1e-3;
    ThermalAxis other = axis;
    for (std::size_t k = 0; k < 3; ++k) {
      other.mode[0].level_mm[k] += by(static_cast<Eigen::Index>(k));
    }
    other.mode[1].polynomial_mm[0] += by(3);
    other.mode[1].polynomial_mm[1] += by(4);
    other.ambient[0].gain_mm_k += by(5);
    other.mode[0].tau_s *= std::exp(0.03 * normal(random));
    other.mode[1].tau_s *= std::exp(0.04 * normal(random));
    const auto drawn = forecast(made(other), cyclogram(), 600.0, {24.0});
    for (std::size_t i = 0; i < points.size(); ++i) {
      sum[i] += drawn[i].displacement_mm;
      squares[i] += drawn[i].displacement_mm * drawn[i].displacement_mm;
    }
  }
  for (std::size_t i = 1; i < points.size(); ++i) {
    const double mean = sum[i] / kMachines;
    const double sd = std::sqrt(squares[i] / kMachines - mean * mean);
    // A spread of 4000 draws is known to 1.1 %; the rest is for the second order in τ.
    EXPECT_NEAR(points[i].sd_mm, sd, 0.05 * sd) << points[i].time_s;
  }
}

TEST(Forecast, DriftGrowsToItsOwnSpread) {
  ThermalAxis axis = machine();
  axis.drift_mm = 0.002;
  axis.drift_tau_s = 1800.0;
  const auto points = forecast(made(axis), cyclogram(), 60.0, {20.0});
  // After 1800 s, one time constant.
  EXPECT_NEAR(points[30].sd_mm, 0.002 * std::sqrt(1.0 - std::exp(-2.0)), 1e-9);
  EXPECT_NEAR(points.back().sd_mm, 0.002, 1e-6);
}

}  // namespace
}  // namespace steadyrest::thermal::offline
