// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include <steadyrest/chatter/offline/cycle/growth_course.hpp>
#include <steadyrest/chatter/offline/cycle/reach.hpp>
#include <steadyrest/chatter/offline/cycle/stability.hpp>
#include <steadyrest/chatter/offline/depth/depth_line.hpp>
#include <steadyrest/chatter/offline/depth/limit_depth.hpp>
#include <steadyrest/chatter/offline/test/cuts.hpp>
#include <steadyrest/kernel/testing/cases.hpp>

namespace steadyrest::chatter::offline::test {
namespace {

using kernel::testing::cases;
using kernel::testing::kSanitized;

Process slot() {
  return benchmark_cut(1.0, Direction::up);
}

DelayCycle cycle_at(const Process& process, double rpm, double depth_mm) {
  DelayCycle out =
      DelayCycle::make(
          process,
          {.speed_rev_s = rpm / 60.0, .modulation = {}, .course = {}, .most_depth_mm = depth_mm})
          .value();
  out.set_depth(depth_mm);
  return out;
}

TEST(Reach, RefusesWhatWouldTakeNoEndAndNamesWhatIsAllowed) {
  for (const auto& [rpm, depth_mm] : {std::pair{1.0, 1.0}, {5000.0, 1e9}, {5000.0, 9e4}}) {
    const auto refused = beyond_reach(slot(), rpm / 60.0, depth_mm);
    ASSERT_TRUE(refused) << rpm << " " << depth_mm;
    EXPECT_TRUE(refused->what.contains(" rpm on") || refused->what.contains("allowed"))
        << refused->what;
    EXPECT_FALSE(DepthLine::make(slot(), rpm / 60.0, {}, depth_mm));
  }
}

// Reads the refusal's figure back from its text: rounded the wrong way, it would be refused again.
TEST(Reach, WhatItSaysIsAllowedIsAllowed) {
  const auto refused = beyond_reach(slot(), 1.0 / 60.0, 1.0);
  ASSERT_TRUE(refused);
  const auto at = refused->what.find("from ");
  ASSERT_NE(at, std::string::npos) << refused->what;
  const double rpm = std::stod(refused->what.substr(at + 5));
  EXPECT_GT(rpm, 50.0);
  EXPECT_LT(rpm, 500.0);
  EXPECT_FALSE(beyond_reach(slot(), rpm / 60.0, 1.0));
}

/// A stiffness a million times too small: no practical speed is within reach at 1 mm.
TEST(Reach, AStiffnessFarOffIsRefusedBeforeAnyWork) {
  Process p = slot();
  p.modes[0].mass_kg *= 1e-6;
  EXPECT_TRUE(beyond_reach(p, 1629.0 / 60.0, 10.0));
  EXPECT_FALSE(DelayCycle::make(
      p, {.speed_rev_s = 1629.0 / 60.0, .modulation = {}, .course = {}, .most_depth_mm = 10.0}));
}

// All keys of a process file over their whole ranges. What is not refused must give a finite
// answer.
TEST(Reach, AnyProcessAtAnyPointIsRefusedOrAnswered) {
  std::mt19937_64 random(20261122);
  std::uniform_real_distribution<double> share;
  const auto log_uniform = [&](double from, double to) {
    return from * std::pow(to / from, share(random));
  };
  std::size_t answered = 0;
  for (int i = 0; i < 60 && !(kSanitized && answered > 0); ++i) {
    Process p = benchmark_cut(log_uniform(1e-4, 1.0),
                              share(random) < 0.5 ? Direction::up : Direction::down);
    p.tool.teeth = static_cast<std::size_t>(log_uniform(1.0, 64.9));
    p.cut.operation = share(random) < 0.3 ? Operation::turning : Operation::milling;
    if (p.cut.operation == Operation::turning) {
      p.tool.teeth = 1;
    }
    p.tool.diameter_mm = log_uniform(0.01, 1e5);
    p.tool.helix_rad = share(random) < 0.5 ? 0.0 : 1.39 * share(random);
    p.cut.tangential_n_mm2 = log_uniform(1.0, 1e5);
    p.cut.radial_n_mm2 = log_uniform(1.0, 1e5) * (share(random) < 0.3 ? -1.0 : 1.0);
    p.cut.process_damping_n_mm = share(random) < 0.7 ? 0.0 : log_uniform(1e-3, 1e6);
    p.modes[0].frequency_hz = log_uniform(0.01, 1e6);
    p.modes[0].damping_ratio = share(random) < 0.1 ? 0.0 : log_uniform(1e-6, 0.999);
    p.modes[0].mass_kg = log_uniform(1e-9, 1e7);
    if (share(random) < 0.3) {
      p.modes.push_back(p.modes[0]);
      p.modes[1].shape = {0.0, 1.0};
      p.modes[1].frequency_hz = log_uniform(0.01, 1e6);
    }
    const double speed_rev_s = log_uniform(1e-6, 1e6);
    const double depth_mm = log_uniform(1e-9, 1e9);
    auto line = DepthLine::make(p, speed_rev_s, {}, depth_mm);
    if (!line) {
      EXPECT_FALSE(line.error().what.empty() || line.error().to_do.empty());
      continue;
    }
    ++answered;
    const double log_radius = line->log_radius(depth_mm);
    EXPECT_TRUE(std::isfinite(log_radius)) << i << " " << log_radius;
    const auto limit = limit_depth_mm(*line, depth_mm);
    EXPECT_TRUE(!limit || (*limit >= 0.0 && *limit <= depth_mm)) << i;
    auto cycle = cycle_at(p, 60.0 * speed_rev_s, depth_mm);
    const Stability found = stability(cycle, {.peak_growth = true, .frequency = true});
    EXPECT_TRUE(std::isfinite(found.log_radius)) << i;
    EXPECT_TRUE(std::isfinite(found.peak_growth)) << i;
  }
  // Enough inside the reach, or the bounds would be tested on nothing.
  EXPECT_GT(answered, kSanitized ? 0U : 8U);
}

/// At low speed a pass is long: its waves are many, and the lobes merge into the absolute limit
/// 2ζ(1 + ζ)·k/Kr of turning.
TEST(Reach, AtLowSpeedTheBorderIsTheAbsoluteLimit) {
  Process p;
  p.cut.operation = Operation::turning;
  p.cut.tangential_n_mm2 = 1000.0;
  p.cut.radial_n_mm2 = 400.0;
  Mode mode;
  mode.frequency_hz = 250.0;
  mode.damping_ratio = 0.012;
  const double k_n_mm = 226e3;
  mode.mass_kg = 1000.0 * k_n_mm / std::pow(2.0 * std::numbers::pi * 250.0, 2);
  p.modes = {mode};
  // min Re G = −1/(4ζ(1 + ζ)·k), and b_lim = −1/(2·Kr·min Re G) (Tlusty).
  const double absolute = 2.0 * k_n_mm * 0.012 * 1.012 / 400.0;
  for (const double rpm : cases({100.0, 77.0, 60.0})) {
    const auto limit = limit_depth_mm(p, rpm / 60.0, {}, 2.0 * absolute).value();
    ASSERT_TRUE(limit.has_value()) << rpm;
    EXPECT_GT(*limit, absolute * (1.0 - 1e-9)) << rpm;
    EXPECT_LT(*limit, absolute * 1.02) << rpm;
    auto below = cycle_at(p, rpm, 0.99 * *limit);
    EXPECT_LT(stability(below, {}).log_radius, 0.0) << rpm;
    auto above = cycle_at(p, rpm, 1.01 * *limit);
    EXPECT_GT(stability(above, {}).log_radius, 0.0) << rpm;
  }
}

/// The map of a pass column by column, which defines the growth.
std::vector<double> slow_log_growth(DelayCycle& cycle, std::size_t passes) {
  Eigen::MatrixXd map = Eigen::MatrixXd::Identity(cycle.state_size(), cycle.state_size());
  std::vector<double> out{0.0};
  for (std::size_t k = 0; k < passes; ++k) {
    for (Eigen::Index i = 0; i < map.cols(); ++i) {
      cycle.advance(0, map.col(i));
    }
    out.push_back(std::log(map.cwiseAbs().rowwise().sum().maxCoeff()));
  }
  return out;
}

/// The rows followed at low speed find the worst of all rows; process damping, uneven pitch and two
/// directions use the other half of the adjoint.
TEST(Reach, GrowthByRowsIsThatOfTheWholeMap) {
  Process damped = slot();
  damped.cut.process_damping_n_mm = 10.0;
  Process uneven = slot();
  uneven.tool.pitch_rad = {3.0, 2.0 * std::numbers::pi - 3.0};
  uneven.modes.push_back(uneven.modes[0]);
  uneven.modes[1].shape = {0.6, 0.8};
  // 700 rpm has hundreds of rows, only some followed; 5000 rpm has few, all followed.
  for (const Process& p : cases({slot(), damped, uneven})) {
    for (const double rpm : {700.0, 5000.0}) {
      auto cycle = cycle_at(p, rpm, 0.3);
      const auto slow = slow_log_growth(cycle, 8);
      const auto quick = growth_courses(cycle)[0].log_growth;
      for (std::size_t k = 0; k < std::min(slow.size(), quick.size()); ++k) {
        EXPECT_NEAR(quick[k], slow[k], 1e-2) << rpm << " " << k;
        EXPECT_LE(quick[k], slow[k] + 1e-9);
      }
    }
  }
}

}  // namespace
}  // namespace steadyrest::chatter::offline::test
