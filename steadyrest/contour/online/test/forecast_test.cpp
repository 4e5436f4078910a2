// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <complex>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <steadyrest/contour/online/forecast.hpp>
#include <steadyrest/contour/online/test/closed_loop.hpp>
#include <steadyrest/contour/online/test/paths.hpp>
#include <steadyrest/math/geometry/test/segments.hpp>

namespace steadyrest::contour::online {
namespace {

using math::geometry::test::number;
using test::kTurn;
using test::PathMaker;
using test::PathSegment;
using test::Point;

/// ε = R·(1 − |G(jω)|), G = (k + a·s)/(τ·s² + s + k).
double closed_form_mm(const AxisModel& m, double radius, double speed) {
  const std::complex<double> s(0.0, speed / radius);
  const auto g = (m.gain_1_s + m.feed_forward * s) / (m.velocity_lag_s * s * s + s + m.gain_1_s);
  return radius * (1.0 - std::abs(g));
}

struct Scene {
  LookAhead ahead{test::mill().axes, kernel::machine::kUnlimited};
  Forecast forecast;
  Outset outset;
  RatioPlan plan;
};

// Floor, target and start are one ratio: a forecast of steady state, long enough (10/k) for the
// start to be forgotten to e⁻¹⁰.
Scene scene(const std::vector<PathSegment>& path, const AxisModel& model, double ratio) {
  Scene s;
  for (int i = 0; i < 60; ++i) {
    s.ahead.update(path, 0, 0.0, 0.0, 60.0);
  }
  Forecast::Timing timing;
  timing.step_s = 0.12 / model.gain_1_s;
  timing.settle_s = 10.0 / model.gain_1_s + 6.0 * model.velocity_lag_s;
  s.forecast.set_timing(timing);
  s.forecast.set_model(std::array{model, model, model});
  s.forecast.set_table(test::siemens_23());
  s.plan = {ratio, ratio, ratio, 0.0};
  s.outset.speed_mm_s = ratio * path.front().feed_mm_s;
  return s;
}

// Truth: the transfer function in complex numbers, which shares no formula with the forecast's
// exact steps and cells.
RC_GTEST_PROP(Forecast, OfASteadyCircleAgreesWithTheClosedForm, ()) {
  const AxisModel model{*number(25.0, 90.0), *rc::gen::element(0.0, 0.4, 0.8),
                        *rc::gen::element(0.0, 0.003)};
  const double radius = *number(2.0, 40.0);
  const double speed = std::min(*number(5.0, 60.0), std::sqrt(1500.0 * radius));
  const auto path = PathMaker({radius, 0, 0}, speed).arc({0, 0, 0}, 60.0 / radius + kTurn).path();
  Scene s = scene(path, model, 1.0);
  Forecast::Trace trace;
  RC_ASSERT(s.forecast.run(s.ahead, s.outset, s.plan, 1e9, false, nullptr, &trace).kept);
  RC_ASSERT(trace.count > 0u);
  const double truth = std::abs(closed_form_mm(model, radius, speed));
  RC_ASSERT(std::abs(trace.error_mm[trace.count - 1] - truth) <= 1e-3 * truth + 1e-4);
}

TEST(Forecast, OfUnequalGainsOnALineGivesTheTextbookError) {
  // (v/2)·sin 2θ·|1/kx − 1/ky| at 30°
  const double angle = kTurn / 12.0;
  const auto path =
      PathMaker({0, 0, 0}, 40.0).line_to({100 * std::cos(angle), 100 * std::sin(angle), 0}).path();
  Scene s = scene(path, {50.0, 0.0, 0.0}, 1.0);
  s.forecast.set_model(
      std::array{AxisModel{50.0, 0.0, 0.0}, AxisModel{55.0, 0.0, 0.0}, AxisModel{50.0, 0.0, 0.0}});
  Forecast::Trace trace;
  ASSERT_TRUE(s.forecast.run(s.ahead, s.outset, s.plan, 1e9, false, nullptr, &trace).kept);
  EXPECT_NEAR(trace.error_mm[trace.count - 1],
              20.0 * std::sin(2.0 * angle) * (1.0 / 50.0 - 1.0 / 55.0), 1e-5);
}

TEST(Forecast, RoundsACornerAsTheServoDoes) {
  // A first-order servo at constant speed v cuts a right angle; the closest point to both legs is
  // where the distances are equal: e⁻ᵏᵗ·v/k = v·t − v/k·(1 − e⁻ᵏᵗ) ⇒ kt = 1, ε = v/(k·e).
  std::vector<PathSegment> path =
      PathMaker({0, 0, 0}, 20.0).line_to({4, 0, 0}).line_to({4, 30, 0}).path();
  for (auto& segment : path) {
    segment.exit_speed_limit_mm_s = 20.0;
  }
  Scene s = scene(path, {50.0, 0.0, 0.0}, 1.0);
  s.outset.servo.error_mm = {0.4, 0.0, 0.0};
  Forecast::Timing timing = s.forecast.timing();
  timing.step_s = 2e-4;
  timing.settle_s = 0.09;
  s.forecast.set_timing(timing);
  s.forecast.set_model(std::array{AxisModel{}, AxisModel{}, AxisModel{}});
  s.outset.position_mm = 2.5;
  const auto result = s.forecast.run(s.ahead, s.outset, s.plan, 1e9, false, nullptr, nullptr);
  EXPECT_NEAR(std::abs(result.error_mm), 0.4 / std::exp(1.0), 0.003);
}

// Play holds the table b/2 behind each motor: on a counter-clockwise circle that moves it inwards
// by b/2·(sin θ − cos θ) in the first quadrant, and so on round: ±b/2 on either side of a reversal.
TEST(Forecast, OfBacklashTakesTheTableHalfOfItBehindTheMotors) {
  constexpr double kRadius = 10.0;
  constexpr double kSpeed = 20.0;
  constexpr double kHalf = 0.001;
  const AxisModel model{50.0, 0.0, 0.0};
  const auto path = PathMaker({kRadius, 0, 0}, kSpeed).arc({0, 0, 0}, 1.25 * kTurn).path();
  Scene s = scene(path, model, 1.0);
  s.plan.hold_s = kTurn / 4.0 * kRadius / kSpeed;  // a quarter of the circle, after settling
  const auto errors = [&](double half_mm) {
    s.forecast.set_half_backlash({half_mm, half_mm, half_mm});
    Forecast::Trace trace;
    EXPECT_TRUE(s.forecast.run(s.ahead, s.outset, s.plan, 1e9, false, nullptr, &trace).kept);
    // Without the first fifth of the way, on which the axes start from no lag.
    const auto begin = trace.error_mm.begin() + static_cast<std::ptrdiff_t>(trace.count / 5);
    const auto end = trace.error_mm.begin() + static_cast<std::ptrdiff_t>(trace.count);
    return std::pair(*std::min_element(begin, end), *std::max_element(begin, end));
  };
  const double ideal = closed_form_mm(model, kRadius, kSpeed);
  const auto [least, most] = errors(kHalf);
  // Within 5 % of b/2: a step passes 0.05 mm of the quarter, and its slope is b/2 per 45°.
  EXPECT_NEAR(most, ideal + kHalf, 0.05 * kHalf);
  EXPECT_NEAR(least, ideal - kHalf, 0.05 * kHalf);
  const auto [same, too] = errors(0.0);
  EXPECT_NEAR(same, ideal, 2e-4);
  EXPECT_NEAR(too, ideal, 2e-4);
}

// At the outset the table lies where the last reversal has left it.
TEST(Forecast, BeginsWithThePlayThatItIsGiven) {
  const auto path = PathMaker({0, 0, 0}, 20.0).line_to({60, 0, 0}).path();
  Scene s = scene(path, {50.0, 0.0, 0.0}, 1.0);
  s.forecast.set_half_backlash({0.001, 0.001, 0.001});
  s.outset.play_mm = {0.0, -0.001, 0.0005};  // X alone moves; Y and Z stay within their play
  Forecast::Trace trace;
  ASSERT_TRUE(s.forecast.run(s.ahead, s.outset, s.plan, 1e9, false, nullptr, &trace).kept);
  EXPECT_NEAR(trace.error_mm[trace.count - 1], std::hypot(0.001, 0.0005), 1e-9);
}

// The objective compares what steps are worth once what came before has settled.
TEST(Forecast, CountsErrorsOnlyFromWhereItIsToldTo) {
  const auto path = PathMaker({10, 0, 0}, 20.0).arc({0, 0, 0}, kTurn).path();
  const AxisModel model{50.0, 0.0, 0.0};
  Scene s = scene(path, model, 1.0);
  s.outset.servo.error_mm = {0.1, 0.0, 0.0};  // 100 µm off the path at first
  const auto all = s.forecast.run(s.ahead, s.outset, s.plan, 1e9, false, nullptr, nullptr);
  EXPECT_GT(std::abs(all.error_mm), 0.05);
  s.plan.judged_from_s = 8.0 / model.gain_1_s;  // e⁻⁸ of it, 0.03 µm, is left
  const auto settled = s.forecast.run(s.ahead, s.outset, s.plan, 1e9, false, nullptr, nullptr);
  EXPECT_NEAR(settled.error_mm, closed_form_mm(model, 10.0, 20.0), 2e-4);
}

// ε on the arc of R = 5 mm rises to v²/(2Rk²) = 0.064 mm; it exceeds 0.010 mm within the first two
// millimetres of the arc, seen from a foot that lags by 0.8 mm.
TEST(Forecast, StopsWhereTheLimitIsBrokenAndSaysWhere) {
  const auto path = PathMaker({0, 0, 0}, 40.0).line_to({3, 0, 0}).arc({3, 5, 0}, kTurn).path();
  Scene s = scene(path, {50.0, 0.0, 0.0}, 1.0);
  const auto result = s.forecast.run(s.ahead, s.outset, s.plan, 0.010, true, nullptr, nullptr);
  EXPECT_FALSE(result.kept);
  EXPECT_GT(result.broken_mm, 2.5);
  EXPECT_LT(result.broken_mm, 5.0);
  EXPECT_GT(result.error_mm, 0.010);
}

// Two branches compute it, closed form and Runge–Kutta; just above the switch (0.15 ms against 0.1
// ms) they must nearly agree.
TEST(AxisStep, OfNoLagIsTheLimitOfSmallLag) {
  const AxisStep none = AxisStep::of({50.0, 0.3, 0.0}, 0.002);
  const AxisStep little = AxisStep::of({50.0, 0.3, 1.5e-4}, 0.002);
  EXPECT_NEAR(none.ee, little.ee, 2e-2);
  EXPECT_NEAR(none.e_mean, little.e_mean, 2e-4);
}

// Each cell's parabola must end where the next one begins, and the limits must be reachable by
// braking: v² ≤ v_next² + 2·a·length.
RC_GTEST_PROP(LookAhead, CellsReproduceThePathAndItsSpeedLimits, ()) {
  PathMaker maker({0, 0, 0}, 30.0);
  for (int i = 0; i < 6; ++i) {
    const double size = *number(0.5, 10.0);
    switch (*rc::gen::inRange(0, 4)) {
      case 0:
        maker.line_to(math::geometry::add(maker.at(), {size, 0.3 * size, 0.0}));
        break;
      case 1:
        maker.arc(math::geometry::add(maker.at(), {0, size, 0}), *number(0.2, 5.0), {0, 0, -1});
        break;
      case 2:
        maker.arc(math::geometry::add(maker.at(), {size, 0, 0}), *number(0.2, 5.0), {0, 0, 1}, 0.5,
                  0.3 * size);
        break;
      default:
        maker.chords(math::geometry::add(maker.at(), {0, size, 0}), 1.0, 0.02);
    }
  }
  const auto path = maker.limited(2000.0, 4.0);
  const double whole = path.back().position_mm + path.back().length_mm;
  LookAhead ahead(test::mill().axes, kernel::machine::kUnlimited);
  for (int i = 0; i < 400; ++i) {
    ahead.update(path, 0, 0.0, 0.0, whole + 1.0);
  }
  RC_ASSERT(ahead.complete() || ahead.end() - ahead.begin() == LookAhead::kCells);
  for (std::size_t i = ahead.begin(); i + 1 < ahead.end(); ++i) {
    const Cell& cell = ahead.cell(i);
    const Cell& next = ahead.cell(i + 1);
    const double d = cell.length_mm;
    Point end = math::geometry::add_scaled(cell.point_mm, cell.tangent, d);
    end = math::geometry::add_scaled(end, cell.curvature_1_mm, 0.5 * d * d);
    RC_ASSERT(math::geometry::distance(end, next.point_mm) <= 1e-4);
    RC_ASSERT(cell.square_mm2_s2 <=
              next.square_mm2_s2 + 2.0 * cell.acceleration_mm_s2 * cell.length_mm + 1e-6);
  }
}

}  // namespace
}  // namespace steadyrest::contour::online
