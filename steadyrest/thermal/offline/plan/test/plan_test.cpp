// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numeric>
#include <random>

#include <gtest/gtest.h>

#include <steadyrest/thermal/offline/plan/plan.hpp>
#include <steadyrest/thermal/offline/plan/test/paper_plan.hpp>

namespace steadyrest::thermal::offline {
namespace {

using kernel::machine::ThermalAxis;
using kernel::machine::ThermalMode;
using List = std::vector<double>;
using test::paper;
using test::planned;
using test::stages;
using test::whole_minutes;

// Marusich 2012, eq. (1), line by line.
TEST(Plan, IsThePapersSystemR) {
  const auto cyclogram = stages({{60, 10}, {60, 20}, {60, 30}, {60, 20}, {60, 30}});
  const auto plan = planned(paper(), cyclogram, {});
  ASSERT_EQ(plan.transition.size(), 5U);
  EXPECT_EQ(whole_minutes(plan.transition[0].interval_s), (List{18, 27, 15}));
  EXPECT_EQ(plan.transition[0].delta_mm, (List{0.0, 0.010, 0.010}));
  EXPECT_EQ(whole_minutes(plan.transition[1].interval_s), (List{15, 40, 5}));
  EXPECT_EQ(plan.transition[1].delta_mm, (List{0.0, 0.010, 0.010}));
  for (int i = 2; i < 5; ++i) {
    EXPECT_EQ(whole_minutes(plan.transition[static_cast<std::size_t>(i)].interval_s), (List{60}));
    EXPECT_EQ(plan.transition[static_cast<std::size_t>(i)].delta_mm, (List{0.0}));
  }
  EXPECT_EQ(plan.corrections, 4U);
  EXPECT_NEAR(plan.largest_offset_mm, 0.040, 1e-12);
  EXPECT_LE(plan.largest_residual_mm, 0.010 + 1e-9);
}

// The paper has only growth; a plan without a negative border would leave 40 µm on a cold machine.
TEST(Plan, MirrorsForCoolingWhatItDidForHeating) {
  const auto cyclogram = stages({{240, 20}, {600, 0}});
  const auto plan = planned(paper(), cyclogram, {});
  const double sum =
      std::accumulate(plan.transition[1].delta_mm.begin(), plan.transition[1].delta_mm.end(), 0.0);
  EXPECT_LT(sum, -0.029) << "what was put on while it was heating is taken off";
  for (const double delta : plan.transition[1].delta_mm) {
    EXPECT_LE(delta, 0.0);
  }
  EXPECT_LE(plan.largest_residual_mm, 0.010 + 1e-9);
  // −10 µm is reached first: from δ = 48.5, corrected by 40, the residual falls from 8.5 to −10.
  const double start = 0.0490785 * (1.0 - std::exp(-240.0 / 53.475));
  EXPECT_NEAR(plan.transition[1].interval_s[0] / 60.0, 53.475 * std::log(start / 0.030), 1e-6);
}

TEST(Plan, TheWholeBandNeedsHalfAsManyPlaces) {
  const auto cyclogram = stages({{600, 20}});
  PlanRequest request;
  request.tolerance_mm = 0.004;
  const auto single = planned(paper(), cyclogram, request);
  // From border to border: 4 µm first, then 8 at a time.
  request.whole_band = true;
  const auto twice = planned(paper(), cyclogram, request);
  EXPECT_EQ(single.corrections, 12U) << "floor(49.07 / 4)";
  EXPECT_EQ(twice.corrections, 6U) << "at 4, 12, 20 … 44 µm";
  EXPECT_LE(twice.largest_residual_mm, 0.004 + 1e-9);
}

TEST(Plan, ShareAndTolerancePerTransitionNarrowTheBand) {
  auto cyclogram = stages({{60, 20}, {60, 20}});
  cyclogram.transition[1].tolerance_mm = 0.004;
  PlanRequest request;
  request.tolerance_mm = 0.020;
  request.share = 0.5;
  const auto plan = planned(paper(), cyclogram, request);
  EXPECT_EQ(plan.transition[0].delta_mm[1], 0.010);
  EXPECT_NE(plan.transition[1].delta_mm[0], 0.0) << "what the wide band left is beyond the narrow";
  EXPECT_DOUBLE_EQ(plan.transition[1].tolerance_mm, 0.004);
  for (std::size_t i = 1; i < plan.transition[1].delta_mm.size(); ++i) {
    EXPECT_NEAR(plan.transition[1].delta_mm[i], 0.002, 1e-15);
  }
}

// Whatever the modes do, the residual stays in the band and the intervals fill their transitions.
TEST(Plan, HoldsTheBandForRandomMachinesAndCyclograms) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (int run = 0; run < 200; ++run) {
    ThermalAxis axis;
    for (int i = 0; i < 3; ++i) {
      ThermalMode mode;
      mode.tau_s = 60.0 * std::pow(10.0, 0.5 + 2.0 * unit(random));
      mode.rest_tau_s = mode.tau_s * (0.5 + unit(random));
      mode.polynomial_mm = {0.02 * (unit(random) - 0.5), 0.01 * (unit(random) - 0.5)};
      axis.mode.push_back(mode);
    }
    Cyclogram cyclogram;
    for (int i = 0; i < 8; ++i) {
      Transition t;
      t.seconds = 7200.0 * unit(random);
      t.speed_rev_s = unit(random) < 0.3 ? 0.0 : 80.0 * unit(random);
      t.tolerance_mm = 0.004 + 0.006 * unit(random);
      cyclogram.transition.push_back(t);
    }
    const auto model = online::ThermalModel::make(axis);
    ASSERT_TRUE(model);
    const Curve curve = curve_of(*model, cyclogram);
    PlanRequest request;
    request.max_offset_mm = 1.0;
    // No refusal may hide a plan that does not hold.
    request.min_interval_s = 0.0;
    request.whole_band = run % 2 == 1;
    const auto plan = plan_corrections("X", curve, cyclogram, request);
    ASSERT_TRUE(plan) << kernel::outcome::text(plan.error());
    double corrected = 0.0;
    for (std::size_t i = 0; i < plan->transition.size(); ++i) {
      const auto& row = plan->transition[i];
      ASSERT_EQ(row.interval_s.size(), row.delta_mm.size());
      EXPECT_NEAR(std::accumulate(row.interval_s.begin(), row.interval_s.end(), 0.0),
                  cyclogram.transition[i].seconds, 1e-6);
      double at = curve.piece[i].start_s;
      for (std::size_t j = 0; j < row.interval_s.size(); ++j) {
        corrected += row.delta_mm[j];
        for (double share = 1e-6; share < 1.0; share += 0.05) {
          const double t = at + share * row.interval_s[j];
          ASSERT_LE(std::abs(curve.at(t) - corrected), row.tolerance_mm + 1e-8)
              << "run " << run << " transition " << i << " at " << t;
        }
        at += row.interval_s[j];
      }
    }
  }
}

// The excess over the band is at most half a minute of the steepest slope, 35.2 µm / 53.5 min.
TEST(Plan, EveryToleranceOfTheSweepHasItsPlan) {
  const auto cyclogram = stages({{60, 10}, {60, 20}, {60, 20}, {60, 20}, {60, 20}});
  const double half_minute_mm = 0.5 * 0.0352245 / 53.475;
  for (int i = 0; i <= 360; ++i) {
    PlanRequest request;
    request.tolerance_mm = 1e-3 * (2.0 + 0.05 * i);
    for (const double resolution_s : {0.0, 60.0}) {
      request.resolution_s = resolution_s;
      const auto plan = planned(paper(), cyclogram, request);
      EXPECT_LE(plan.largest_residual_mm,
                request.tolerance_mm + 1e-8 + (resolution_s > 0.0 ? half_minute_mm : 0.0))
          << request.tolerance_mm;
      EXPECT_EQ(plan.corrections,
                static_cast<std::size_t>(std::floor(plan.largest_mm / request.tolerance_mm)));
    }
  }
}

// 49 µm of growth need four corrections of 10; the machine allows three and a half.
TEST(Plan, BeyondTheMachinesClampIsRefused) {
  PlanRequest request;
  request.max_offset_mm = 0.035;
  const auto cyclogram = stages({{600, 20}});
  const auto plan = plan_corrections("Z", curve_of(paper(), cyclogram), cyclogram, request);
  ASSERT_FALSE(plan);
  const std::string text = kernel::outcome::text(plan.error());
  EXPECT_NE(text.find("40.0 µm, more than the 35.0 µm"), std::string::npos) << text;
}

// 1 nm of tolerance needs 49 000 corrections, and 0 needs infinitely many.
TEST(Plan, CorrectionsWithoutEndAreRefused) {
  PlanRequest request;
  request.tolerance_mm = 1e-6;
  const auto cyclogram = stages({{600, 20}});
  EXPECT_FALSE(plan_corrections("Z", curve_of(paper(), cyclogram), cyclogram, request));
  request.tolerance_mm = 0.0;
  EXPECT_FALSE(plan_corrections("Z", curve_of(paper(), cyclogram), cyclogram, request));
}

TEST(Plan, InstantsCanBeWholeMinutes) {
  PlanRequest request;
  request.resolution_s = 60.0;
  const auto plan = planned(paper(), stages({{60, 10}, {60, 20}}), request);
  EXPECT_EQ(plan.transition[0].interval_s, (List{18.0 * 60.0, 27.0 * 60.0, 15.0 * 60.0}));
  EXPECT_EQ(plan.transition[1].interval_s, (List{15.0 * 60.0, 40.0 * 60.0, 5.0 * 60.0}));
  EXPECT_GT(plan.largest_residual_mm, 0.010) << "said as it is";
  EXPECT_LT(plan.largest_residual_mm, 0.0105);
}

}  // namespace
}  // namespace steadyrest::thermal::offline
