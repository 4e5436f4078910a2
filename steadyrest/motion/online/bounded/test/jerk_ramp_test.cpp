// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/motion/online/bounded/jerk_ramp.hpp>

namespace steadyrest::motion::online {
namespace {

constexpr double kJerk = 5e6;  // count/s³: 5000 mm/s³ at counts of 1 µm
constexpr double kC = kJerk / 6.0;
constexpr double kVariance = 1e-8;

/// When a stop at t = 1 s and x = `place` passes the last lines below it.
std::vector<double> stop_passages(double place, int lines, double c = kC) {
  std::vector<double> out;
  for (int line = 1 - lines; line <= 0; ++line) {
    out.push_back(1.0 - std::cbrt((place - line) / c));
  }
  return out;
}

void pass_stop(JerkRamp& ramp, const std::vector<double>& times) {
  int line = 1 - static_cast<int>(times.size());
  for (const double t : times) {
    ramp.edge(t, line++, 1, kVariance, 0.0, 0.001);
  }
}

TEST(JerkRamp, StopIsForeseenWithoutALimit) {
  for (const double place : {0.1, 0.5, 0.9}) {
    JerkRamp ramp;
    const auto times = stop_passages(place, 8);
    pass_stop(ramp, times);
    for (double t = times.back(); t < 1.0; t += 1e-3) {
      const JerkRamp::Motion m = ramp.at(t, t);
      const double tau = 1.0 - t;
      EXPECT_GT(m.share, 0.99);
      EXPECT_NEAR(m.v, 3.0 * kC * tau * tau, 0.2);
      EXPECT_NEAR(m.a, -6.0 * kC * tau, 40.0);
    }
    EXPECT_EQ(ramp.at(1.001, 1.001).v, 0.0);
    EXPECT_GT(ramp.at(2.0, 2.0).share, 0.99);
  }
}

TEST(JerkRamp, FourLinesDoWhereTheJerkIsKnown) {
  JerkRamp known({.jerk = kJerk});
  JerkRamp unknown;
  const auto times = stop_passages(0.5, 4);
  pass_stop(known, times);
  pass_stop(unknown, times);
  EXPECT_GT(known.at(times.back(), times.back()).share, 0.95);
  EXPECT_EQ(unknown.at(times.back(), times.back()).share, 0.0);
}

// A ramp seen where there is none would pull a good estimate to a stop that never comes.
TEST(JerkRamp, OtherMotionsHaveNoShare) {
  const auto share = [](auto time_of_way_left) {
    JerkRamp ramp({.jerk = kJerk});
    double most = 0.0;
    for (int line = -20; line <= 0; ++line) {
      const double t = 1.0 - time_of_way_left(0.5 - line);
      ramp.edge(t, line, 1, kVariance, 0.0, 0.001);
      most = std::max(most, ramp.at(t, t).share);
    }
    return most;
  };
  EXPECT_LT(share([](double way) { return way / 300.0; }), 0.01);                   // steady
  EXPECT_LT(share([](double way) { return std::sqrt(way / 5e4); }), 0.01);          // even braking
  EXPECT_LT(share([](double way) { return -0.02 * std::log(30.0 / way); }), 0.01);  // a servo's lag
  EXPECT_LT(share([](double way) { return std::cbrt(way / (2.0 * kC)); }), 0.01);  // over the limit
}

TEST(JerkRamp, ALineThatDoesNotComeWithdrawsIt) {
  JerkRamp ramp({.jerk = kJerk});
  auto times = stop_passages(3.5, 6);
  pass_stop(ramp, times);
  EXPECT_GT(ramp.at(times.back(), times.back()).share, 0.9);
  EXPECT_EQ(ramp.at(1.0, 1.0).share, 0.0);
}

/// The way to the first line is evenly distributed over 0 … 1: there the mean is right and the
/// spread is the prior's, 0.262·∛(4.5·J); after the second line there is none.
TEST(JerkRamp, StartIsRightInTheMeanAtTheFirstLineAndExactAtTheSecond) {
  constexpr int kStarts = 1000;
  double mean = 0.0;
  double square = 0.0;
  for (int i = 0; i < kStarts; ++i) {
    JerkRamp ramp({.jerk = kJerk});
    const double way = (i + 0.5) / kStarts;
    const double t1 = std::cbrt(way / kC);
    const double t2 = std::cbrt((way + 1.0) / kC);
    ramp.edge(t1, 0.0, 1, kVariance, 1.0, 1.0);
    const double error = ramp.at(t1, t1).v - 3.0 * kC * t1 * t1;
    mean += error / kStarts;
    square += error * error / kStarts;
    ramp.edge(t2, 1.0, 1, kVariance, 0.0, t2 - t1);
    EXPECT_NEAR(ramp.at(t2, t2).v, 3.0 * kC * t2 * t2, 1e-6);
    EXPECT_NEAR(ramp.at(t2, t2).a, 6.0 * kC * t2, 1e-4);
    EXPECT_NEAR(ramp.at(t2, 0.5 * t1).v, 3.0 * kC * 0.25 * t1 * t1, 1e-6);  // with hindsight
  }
  const double whole = std::cbrt(4.5 * kJerk);
  EXPECT_NEAR(mean, 0.0, 0.001 * whole);
  EXPECT_NEAR(std::sqrt(square), 0.262 * whole, 0.002 * whole);
}

TEST(JerkRamp, AfterAStopTheStartIsExactAtItsFirstLine) {
  JerkRamp ramp;
  pass_stop(ramp, stop_passages(0.3, 6));
  const double t = 1.1 + std::cbrt(0.3 / kC);
  ramp.edge(t, 0.0, -1, kVariance, 0.5, 0.1);
  EXPECT_GT(ramp.at(t, t).share, 0.5);
  EXPECT_NEAR(ramp.at(t, t).v, -3.0 * kC * (t - 1.1) * (t - 1.1), 0.5);
}

// Trust is earned by how often starts on this axis came as predicted.
TEST(JerkRamp, StartsThatDoNotUseTheLimitAreBelievedLess) {
  JerkRamp ramp({.jerk = kJerk});
  const double c = 0.2 * kC;
  double first = 0.0;
  double last = 0.0;
  for (int i = 0; i < 6; ++i) {
    const double from = 1.0 + i;
    for (int line = 0; line < 4; ++line) {
      const double t = from + std::cbrt((0.6 + line) / c);
      ramp.edge(t, line, 1, kVariance, line == 0 ? 1.0 : 0.0, line == 0 ? 0.5 : 0.002);
      if (line == 0) {
        last = ramp.at(t, t).share;
        first = i == 0 ? last : first;
      }
    }
  }
  EXPECT_GT(first, 0.5);
  EXPECT_LT(last, 0.05);
}

TEST(JerkRamp, NoStartWhereTheOtherLimitsEndItWithinTwoCounts) {
  JerkRamp ramp({.jerk = kJerk, .acceleration = 6e4, .speed = 1e6});
  ramp.edge(1.0, 0.0, 1, kVariance, 1.0, 1.0);
  EXPECT_EQ(ramp.at(1.0, 1.0).share, 0.0);
}

}  // namespace
}  // namespace steadyrest::motion::online
