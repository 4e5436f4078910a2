// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/thermal/offline/fit/shared_tau.hpp>
#include <steadyrest/thermal/offline/test/synthetic_log.hpp>

namespace steadyrest::thermal::offline {
namespace {

using testing::ElementsAre;

using test::kDays;

/// One body moves X and Z, another one Y.
Log three_axes() {
  Log log = test::log_of({{{50.0, 6.0}}, 1.5, 0.0, 0.0, 1}, kDays);
  log.displacement[0].name = "x_um";
  unsigned seed = 2;
  for (const auto& [name, mode] : {std::pair{"y_um", test::KnownMode{90.0, 5.0}},
                                   std::pair{"z_um", test::KnownMode{50.0, -3.0}}}) {
    Log other = test::log_of({{mode}, 1.5, 0.0, 0.0, seed++}, kDays);
    log.displacement.push_back({name, std::move(other.displacement[0].value)});
  }
  return log;
}

// Both mistakes are possible: sharing what is alike by chance, and not sharing what is one body.
TEST(SharedTau, DisplacementsOfOneBodyShareAndOthersDoNot) {
  const Log log = three_axes();
  std::vector<AxisFit> fit;
  fit.reserve(3);
  for (std::size_t c = 0; c < 3; ++c) {
    fit.push_back(identify(log, c, log.displacement[c].name, {}).value());
  }
  // X and Z truly have 50 min, Y 90; Z moves half as much as X and so knows its own less well.
  const std::vector<AxisFit> own = fit;
  const auto groups = share_tau(log, {0, 1, 2}, {}, fit);
  EXPECT_THAT(groups, ElementsAre(ElementsAre(0U, 2U)));
  EXPECT_EQ(fit[0].axis.mode[0].tau_s, fit[2].axis.mode[0].tau_s);
  EXPECT_EQ(fit[1].axis.mode[0].tau_s, own[1].axis.mode[0].tau_s);
  const auto off = [](const AxisFit& f) {
    return std::abs(std::log(f.axis.mode[0].tau_s / (50.0 * 60.0)));
  };
  EXPECT_LT(off(fit[2]), off(own[2])) << "the weaker one learns from the stronger one";
  EXPECT_LT(fit[2].ln_tau_sd[0], own[2].ln_tau_sd[0]);
  EXPECT_LT(off(fit[2]), 3.0 * fit[2].ln_tau_sd[0]) << "and its stated doubt holds";
  EXPECT_NEAR(fit[2].axis.mode[0].polynomial_mm[0], -3e-3, 1e-4) << "levels are each one's own";
  EXPECT_NEAR(fit[0].axis.mode[0].polynomial_mm[0], 6e-3, 1e-4);
}

TEST(SharedTau, OneDisplacementSharesWithNobody) {
  const Log log = three_axes();
  std::vector<AxisFit> fit = {identify(log, 0, "X", {}).value()};
  EXPECT_TRUE(share_tau(log, {0}, {}, fit).empty());
}

}  // namespace
}  // namespace steadyrest::thermal::offline
