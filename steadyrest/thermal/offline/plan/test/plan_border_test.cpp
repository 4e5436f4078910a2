// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <utility>

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

// 10 µm of 40 are reached at τ·ln(4/3): the first transition ends there, and the rise continues in
// the second.
TEST(Plan, ABorderReachedAtATransitionsEndIsCorrectedAtTheNextOnesStart) {
  ThermalAxis axis;
  ThermalMode mode;
  mode.tau_s = 1800.0;
  mode.speed_rev_s = {0.0, 10.0};
  mode.level_mm = {0.0, 0.040};
  axis.mode = {mode};
  const auto model = *online::ThermalModel::make(axis);
  const double reached_min = 30.0 * std::log(4.0 / 3.0);
  for (const double later_min : {-1e-12, 0.0, 1e-12, 1e-9, 1e-6}) {
    for (const bool whole_band : {false, true}) {
      PlanRequest request;
      request.whole_band = whole_band;
      const auto plan = planned(model, stages({{reached_min + later_min, 10}, {4, 10}}), request);
      ASSERT_EQ(plan.transition.size(), 2U);
      EXPECT_EQ(plan.corrections, 1U) << later_min;
      EXPECT_EQ(plan.transition[1].delta_mm, (List{whole_band ? 0.020 : 0.010})) << later_min;
      EXPECT_LE(plan.largest_residual_mm, 0.010 + 1e-8);
      // Where it falls again there is nothing to correct.
      EXPECT_EQ(planned(model, stages({{reached_min, 10}, {4, 0}}), request).corrections, 0U);
    }
  }
}

// 0.4 s after the start, on the narrow band that already took a correction there.
TEST(Plan, ACrossingJustBehindACorrectedStartBelongsToIt) {
  auto cyclogram = stages({{30, 20}, {60, 20}});
  const auto curve = curve_of(paper(), cyclogram);
  PlanRequest request;
  request.tolerance_mm = 0.5 * curve.at(1800.0 + 0.4);
  cyclogram.transition[0].tolerance_mm = 0.1;
  const auto plan = planned(paper(), cyclogram, request);
  ASSERT_EQ(plan.transition.size(), 2U);
  ASSERT_EQ(plan.transition[1].delta_mm.size(), 2U);
  EXPECT_DOUBLE_EQ(plan.transition[1].delta_mm[0], 2.0 * request.tolerance_mm);
  EXPECT_LE(plan.largest_residual_mm, 0.1);
}

// Up to 12 µm within 4 s, back to 0 after 23 s: both crossings are rounded onto the start.
TEST(Plan, WhatCancelsInTheRoundingIsNoCorrection) {
  ThermalAxis axis;
  for (const auto& [tau_s, level_mm] : {std::pair{2.0, 0.020}, {20.0, -0.029}}) {
    ThermalMode mode;
    mode.tau_s = tau_s;
    mode.speed_rev_s = {0.0, 10.0};
    mode.level_mm = {0.0, level_mm};
    axis.mode.push_back(mode);
  }
  PlanRequest request;
  request.resolution_s = 60.0;
  const auto plan = planned(*online::ThermalModel::make(axis), stages({{60, 10}}), request);
  ASSERT_EQ(plan.transition.size(), 1U);
  EXPECT_EQ(plan.transition[0].delta_mm, (List{0.0}));
  EXPECT_EQ(plan.corrections, 0U);
}

}  // namespace
}  // namespace steadyrest::thermal::offline
