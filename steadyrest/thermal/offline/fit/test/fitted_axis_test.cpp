// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <vector>

#include <Eigen/LU>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/thermal/offline/fit/fitted_axis.hpp>
#include <steadyrest/thermal/offline/test/synthetic_log.hpp>

namespace steadyrest::thermal::offline {
namespace {

using kernel::machine::ThermalAxis;
using testing::ElementsAre;

/// A fit with the parameters 1, 2, 3, … µm and covariances that name their place.
ThermalAxis passport_of(const Structure& structure, const Log& log) {
  const FitData data = fit_data(log, 0, -1e300, 1e300);
  const Eigen::Index n = columns_of(structure, log, data.row).cols();
  LinearFit fit;
  fit.amplitude = Eigen::VectorXd::LinSpaced(n, 1.0, static_cast<double>(n));
  fit.covariance = fit.amplitude * fit.amplitude.transpose();
  return fitted_axis(structure, data, fit, {});
}

Log day_with_sensors() {
  return test::log_of({{{50.0, 6.0}}, 0.5, 0.0, 0.0, 1}, test::kDays, 2);
}

TEST(FittedAxis, APowerThatWasNotFittedIsKnownToBeZero) {
  Structure square;
  square.mode = {{1800.0, 0.0}};
  square.power = {2};
  const ThermalAxis axis = passport_of(square, day_with_sensors());
  EXPECT_THAT(axis.mode.at(0).polynomial_mm, ElementsAre(0.0, 1e-3));
  EXPECT_THAT(axis.covariance, ElementsAre(0.0, 0.0, 1.0));
}

// Two speeds and an input: levels 1 and 2 µm above 0 at rest, gain 3 µm/K.
TEST(FittedAxis, ATableBeginsWithNothingAtRest) {
  Structure table;
  table.mode = {{1800.0, 0.0}};
  table.table_rev_s = {25.0, 50.0};
  table.ambient = {{1, 600.0}};
  const ThermalAxis axis = passport_of(table, day_with_sensors());
  EXPECT_THAT(axis.mode.at(0).speed_rev_s, ElementsAre(0.0, 25.0, 50.0));
  EXPECT_THAT(axis.mode[0].level_mm, ElementsAre(0.0, 1e-3, 2e-3));
  EXPECT_EQ(axis.ambient.at(0).sensor, "t2_c");
  EXPECT_NEAR(axis.ambient[0].gain_mm_k, 3e-3, 1e-15);
  EXPECT_THAT(axis.covariance, ElementsAre(0, 0, 1, 0, 2, 4, 0, 3, 6, 9));
}

TEST(StructureOf, APassportFindsItsSensorsByNameAndItsSpeedsInAllTables) {
  Log log = day_with_sensors();
  std::swap(log.temperature[0], log.temperature[1]);
  ThermalAxis axis;
  axis.mode.resize(2);
  axis.mode[0].tau_s = 600.0;
  axis.mode[0].speed_rev_s = {0.0, 50.0};
  axis.mode[1].tau_s = 6000.0;
  axis.mode[1].rest_tau_s = 9000.0;
  axis.mode[1].speed_rev_s = {0.0, 25.0, 50.0};
  axis.ambient.resize(1);
  axis.ambient[0].sensor = "t1_c";
  axis.ambient[0].tau_s = 1200.0;
  const Structure found = structure_of(axis, log);
  EXPECT_THAT(found.table_rev_s, ElementsAre(25.0, 50.0));
  ASSERT_EQ(found.mode.size(), 2U);
  EXPECT_EQ(found.mode[1].rest_tau_s, 9000.0);
  ASSERT_EQ(found.ambient.size(), 1U);
  EXPECT_EQ(found.ambient[0].sensor, 1U);
  EXPECT_EQ(found.ambient[0].tau_s, 1200.0);
  // Two levels for each mode and a gain; three free time constants of modes and one of the input.
  EXPECT_EQ(found.linear(), 5U);
  EXPECT_EQ(found.parameters(), 9U);
}

// 10 µm known to ±2 µm, on a machine that may have changed by 15 %: ±√(2² + 1.5²) = ±2.5 µm.
TEST(KnownPrior, AddsTheDoubtOfAChangedMachineToThePassports) {
  ThermalAxis axis;
  axis.mode.resize(1);
  axis.mode[0].polynomial_mm = {10e-3};
  axis.covariance = {4.0};
  const Log log = day_with_sensors();
  const Structure structure = structure_of(axis, log);
  LinearPrior prior = wide_prior(structure, fit_data(log, 0, -1e300, 1e300));
  known_prior(axis, 0.15, structure, prior);
  EXPECT_NEAR(prior.mean[0], 10.0, 1e-12);
  EXPECT_NEAR(1.0 / prior.root(0, 0), 2.5, 1e-12);
}

}  // namespace
}  // namespace steadyrest::thermal::offline
