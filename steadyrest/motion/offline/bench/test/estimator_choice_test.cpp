// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/motion/offline/bench/estimator_choice.hpp>
#include <steadyrest/motion/offline/scene/score.hpp>

namespace steadyrest::motion::offline {
namespace {

using testing::HasSubstr;

EstimatorSetup full_setup() {
  EstimatorSetup setup;
  setup.clock_s = 1e-7;
  setup.max_speed_mm_s = 100.0;
  setup.max_acceleration_mm_s2 = 200.0;
  setup.max_jerk_mm_s3 = 5000.0;
  return setup;
}

TEST(EstimatorChoice, EveryNameFollowsAConstantSpeed) {
  const Record record = offline::record(constant_speed(10.0, 0.5), Recording{});
  for (const std::string_view name : estimator_names()) {
    const auto estimator = make_estimator(name, full_setup());
    ASSERT_TRUE(estimator.has_value()) << name << kernel::outcome::text(estimator.error());
    const auto estimates = run(**estimator, record);
    // 10 counts per tick; the coarsest estimator is off by less than one.
    EXPECT_LT(score(estimates, record, 0.0, 0.2).velocity_max_mm_s, 1.0) << name;
  }
}

TEST(EstimatorChoice, AnUnknownNameIsRefusedWithTheList) {
  const auto refused = make_estimator("oracle", full_setup());
  ASSERT_FALSE(refused.has_value());
  for (const std::string_view name : estimator_names()) {
    EXPECT_THAT(refused.error().to_do, HasSubstr(std::string(name)));
  }
}

TEST(EstimatorChoice, RefusesWhatNoAxisHas) {
  for (const double bad : {0.0, -1.0, std::nan("")}) {
    for (double EstimatorSetup::* member :
         {&EstimatorSetup::count_mm, &EstimatorSetup::cycle_hz, &EstimatorSetup::max_speed_mm_s,
          &EstimatorSetup::max_acceleration_mm_s2, &EstimatorSetup::max_jerk_mm_s3}) {
      EstimatorSetup setup = full_setup();
      setup.*member = bad;
      EXPECT_FALSE(make_estimator("difference", setup)) << bad;
    }
  }
  for (const double bad : {-1.0, std::nan(""), HUGE_VAL}) {
    for (double EstimatorSetup::* member : {&EstimatorSetup::lag_s, &EstimatorSetup::clock_s}) {
      EstimatorSetup setup = full_setup();
      setup.*member = bad;
      EXPECT_FALSE(make_estimator("difference", setup)) << bad;
    }
    EstimatorSetup lines = full_setup();
    lines.line_error_mm = bad;
    EXPECT_FALSE(make_estimator("difference", lines)) << bad;
  }
}

TEST(EstimatorChoice, SaysWhatAnEstimatorLacks) {
  EstimatorSetup ticks = full_setup();
  ticks.has_edges = false;
  EXPECT_THAT(make_estimator("mt", ticks).error().what, HasSubstr("needs edges"));
  EXPECT_TRUE(make_estimator("difference", ticks).has_value());
  EstimatorSetup late = full_setup();
  late.lag_s = 0.001;
  EXPECT_THAT(make_estimator("pll", late).error().what, HasSubstr("takes no lag"));
  EstimatorSetup free = full_setup();
  free.max_acceleration_mm_s2 = online::kNoBound;
  EXPECT_THAT(make_estimator("worst-case", free).error().what, HasSubstr("largest acceleration"));
}

}  // namespace
}  // namespace steadyrest::motion::offline
