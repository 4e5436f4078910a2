// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/chatter/offline/cycle/delay_cycle.hpp>
#include <steadyrest/chatter/offline/test/cuts.hpp>

namespace steadyrest::chatter::offline {
namespace {

using Eigen::VectorXd;

constexpr double kCycleSpeed_rev_s = 80.0;

DelayCycle cycle_of(const Process& p, double depth_mm, const Modulation& modulation = {}) {
  DelayCycle::Config config;
  config.speed_rev_s = kCycleSpeed_rev_s;
  config.modulation = modulation;
  DelayCycle out = DelayCycle::make(p, config).value();
  out.set_depth(depth_mm);
  return out;
}

/// Each of them takes another way through the solver.
std::vector<Process> all_kinds() {
  std::vector<Process> out(4, test::benchmark_cut(0.5, Direction::down));
  out[1].cut.process_damping_n_mm = 300.0;
  out[2].tool.pitch_rad = {2.5, 2.0 * std::numbers::pi - 2.5};
  out[3].tool.helix_rad = 0.5;
  out[2].modes.push_back({{0.6, 0.8}, 700.0, 0.03, 0.06});
  out[3].modes = out[2].modes;
  return out;
}

// row·(A·state) = (Aᵀ·row)·state for any two vectors.
TEST(DelayCycle, RetreatIsTheAdjointOfAdvance) {
  std::mt19937_64 random(8);
  std::normal_distribution<double> normal;
  for (const Process& p : all_kinds()) {
    DelayCycle cycle = cycle_of(p, 0.7, {online::Law::sine, 0.2, 0.5, 1});
    for (std::size_t pass = 0; pass < cycle.passes(); ++pass) {
      const VectorXd state =
          VectorXd::NullaryExpr(cycle.state_size(), [&] { return normal(random); });
      const VectorXd row =
          VectorXd::NullaryExpr(cycle.state_size(), [&] { return normal(random); });
      VectorXd ahead = state;
      cycle.advance(pass, ahead);
      VectorXd back = row;
      cycle.retreat(pass, back);
      EXPECT_NEAR(row.dot(ahead), back.dot(state), 1e-11 * row.norm() * ahead.norm()) << pass;
    }
  }
}

// A law of RVF 0.3 repeats after 3⅓ turns, which is no whole number of half turns; three are 20.
TEST(DelayCycle, LastsUntilLawAndTeethMeetAgain) {
  const Process p = test::benchmark_cut(0.5, Direction::down);
  const DelayCycle constant = cycle_of(p, 0.5);
  EXPECT_EQ(constant.passes(), 1U);
  EXPECT_EQ(constant.law_periods(), 1U);
  EXPECT_NEAR(constant.pass_rad(), std::numbers::pi, 1e-12);
  EXPECT_NEAR(constant.period_s(), 1.0 / 160.0, 1e-12);
  const DelayCycle slow = cycle_of(p, 0.5, {online::Law::triangle, 0.2, 0.1, 1});
  EXPECT_EQ(slow.passes(), 20U);
  EXPECT_EQ(slow.law_periods(), 1U);
  EXPECT_NEAR(slow.period_s(), 10.0 / kCycleSpeed_rev_s, 1e-9);
  const DelayCycle odd = cycle_of(p, 0.5, {online::Law::square, 0.2, 0.3, 1});
  EXPECT_EQ(odd.passes(), 20U);
  EXPECT_EQ(odd.law_periods(), 3U);
}

// q = cos ωt·e^(−ζωt) to first order in ζ; here ζ is 0.
TEST(DelayCycle, WithoutADepthVibratesFreely) {
  Process p = test::benchmark_cut(0.5, Direction::down);
  p.modes[0].damping_ratio = 0.0;
  DelayCycle cycle = cycle_of(p, 0.0, {online::Law::square, 0.2, 1.0, 1});
  VectorXd state = VectorXd::Zero(cycle.state_size());
  state[0] = 1.0;
  const double w = 2.0 * std::numbers::pi * 922.0;
  double weight_s = 0.0;
  for (std::size_t pass = 0; pass < cycle.passes(); ++pass) {
    cycle.advance(pass, state);
    for (const DelayCycle::Sample& sample : cycle.last_pass(pass)) {
      EXPECT_NEAR(sample.x_mm, std::cos(w * sample.t_s), 1e-9) << sample.t_s;
      weight_s += sample.weight_s;
    }
  }
  EXPECT_NEAR(weight_s, cycle.period_s(), 1e-12);
  EXPECT_NEAR(state[0], std::cos(w * cycle.period_s()), 1e-9);
  EXPECT_NEAR(state[1], -std::sin(w * cycle.period_s()), 1e-9);
}

}  // namespace
}  // namespace steadyrest::chatter::offline
