// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <numbers>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "expectations.hpp"
#include "program.hpp"
#include "scratch.hpp"
#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace steadyrest::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

constexpr double kOmega = 2.0 * std::numbers::pi * 2.0;
const std::string kCount = " --count-mm 0.001";

/// 4 s of x = 1 mm·(1 − cos 2π·2 Hz·t) over lines with 2 % random and ±5 % phase error, stamps of
/// 100 ns. The times are exact: t = acos(1 − x)/ω at each line's true place. The log has the count
/// after each edge.
void write_log(const std::string& path) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  std::vector<double> line_mm;
  const std::array<double, 4> phase{0.05, -0.05, 0.03, -0.03};
  for (std::size_t i = 0; i <= 2000; ++i) {
    line_mm.push_back(1e-3 * (static_cast<double>(i) + phase[i & 3U] + 0.02 * normal(random)));
  }
  std::ofstream out(path);
  out << "t_s,count\n0,0\n";
  for (int half = 0; half < 16; ++half) {
    for (std::size_t i = 1; i < 2000; ++i) {
      const bool up = half % 2 == 0;
      const std::size_t line = up ? i : 2000 - i;
      const double way = std::acos(1.0 - line_mm[line]) / kOmega;
      const double t = 0.25 * (half + (up ? 0 : 1)) + (up ? way : -way);
      out << fmt::format("{:.7f},{}\n", std::floor(t * 1e7) * 1e-7, up ? line : line - 1);
    }
  }
}

/// RMS error of the estimated velocity from 50 ms on, against the exact derivative.
double error_mm_s(const std::string& table) {
  std::istringstream in(table);
  std::string line;
  std::getline(in, line);
  double sum2 = 0.0;
  double n = 0.0;
  while (std::getline(in, line)) {
    double t = 0.0;
    double x = 0.0;
    double v = 0.0;
    EXPECT_EQ(std::sscanf(line.c_str(), "%lf,%lf,%lf", &t, &x, &v), 3) << line;
    if (t >= 0.05) {
      sum2 += std::pow(v - kOmega * std::sin(kOmega * t), 2.0);
      n += 1.0;
    }
  }
  return std::sqrt(sum2 / n);
}

// Learnt phases within 0.004 counts of the true ones; the residual falls fivefold, the estimate's
// error by at least a third.
TEST(MotionCalibrate, WhatItLearnsTakesAThirdOffTheErrorOfTheEstimate) {
  const Scratch scratch;
  const std::string log = scratch.at("edges.csv");
  const std::string lines = scratch.at("lines.toml");
  write_log(log);
  const Finished learnt = run_line("motion calibrate " + log + kCount + " -o " + lines + " --json");
  ASSERT_EQ(learnt.code, 0) << learnt.err;
  const json answer = json::parse(learnt.out);
  EXPECT_EQ(answer["edges"], 16 * 1999);
  EXPECT_GT(answer["lines_learnt"], 1900);
  EXPECT_GT(answer["residual_before_um"], 0.03);
  EXPECT_LT(answer["residual_after_um"], 0.006);
  EXPECT_NEAR(answer["phase_error_um"][0].get<double>(), 0.05, 0.004);
  EXPECT_NEAR(answer["phase_error_um"][3].get<double>(), -0.03, 0.004);
  const std::string estimate = "motion estimate " + log + kCount + " --input edges --cycle-hz 1000";
  const Finished before = run_line(estimate);
  const Finished after = run_line(estimate + " --calibration " + lines);
  ASSERT_EQ(after.code, 0) << after.err;
  EXPECT_LT(error_mm_s(after.out), 0.67 * error_mm_s(before.out));
}

// Into the machine file (bytes around it untouched) and back: the estimates are the same as from
// the keys alone.
TEST(MotionCalibrate, PutsTheTableIntoAMachineFileAndEstimateTakesItFromThere) {
  const Scratch scratch;
  const std::string log = scratch.at("edges.csv");
  const std::string machine = scratch.at("machine.toml");
  const std::string keys = scratch.at("lines.toml");
  write_log(log);
  const std::string head =
      "[control] # µ\ndialect = \"linuxcnc\"\n[[axis]]\nname = \"X\"\nservo_gain_1_s = 50\n"
      "max_feed_mm_min = 12000\nmax_acceleration_mm_s2 = 2000\n[axis.encoder]\ncount_um = 1 # q\n";
  const std::string tail =
      "\n[[axis]]\nname = \"Y\"\nservo_gain_1_s = 50\nmax_feed_mm_min = 12000\n"
      "max_acceleration_mm_s2 = 2000\n[override.feed]\npercent = [0, 100]\n";
  std::ofstream(machine) << head << tail;
  const std::string learn = "motion calibrate " + log + kCount;
  const Finished done =
      run_line(learn + " --machine " + machine + " --axis X --force -o " + machine);
  ASSERT_EQ(done.code, 0) << done.err;
  const std::string text = text_of_file(machine);
  EXPECT_TRUE(text.starts_with(head));
  EXPECT_TRUE(text.ends_with(tail));
  EXPECT_EQ(run_line("doctor --machine " + machine + " --json").err, "");
  ASSERT_EQ(run_line(learn + " -o " + keys).code, 0);
  const std::string estimate =
      "motion estimate " + log + kCount + " --input edges --cycle-hz 1000 --calibration ";
  const Finished by_machine = run_line(estimate + machine + " --axis X");
  EXPECT_EQ(by_machine.code, 0) << by_machine.err;
  EXPECT_EQ(by_machine.out, run_line(estimate + keys).out);
  EXPECT_EQ(run_line(estimate + machine + " --axis Z").code, 2);
  EXPECT_EQ(run_line(estimate + machine).code, 2);
}

// The same log read as 0.01° a count: errors scale with the count, in degrees and not in µm.
TEST(MotionCalibrate, SaysAnglesOfARotaryAxisInDegrees) {
  const Scratch scratch;
  const std::string log = scratch.at("edges.csv");
  const std::string machine = scratch.at("machine.toml");
  const std::string keys = scratch.at("lines.toml");
  write_log(log);
  std::ofstream(machine) << "[control]\ndialect = \"linuxcnc\"\n[[axis]]\nname = \"X\"\n"
                            "servo_gain_1_s = 50\nmax_feed_mm_min = 12000\n"
                            "max_acceleration_mm_s2 = 2000\n[axis.encoder]\ncount_um = 1\n"
                            "[[axis]]\nname = \"B\"\nservo_gain_1_s = 50\nmax_speed_deg_s = 180\n"
                            "max_acceleration_deg_s2 = 360\n[axis.encoder]\ncount_deg = 0.01\n"
                            "[override.feed]\npercent = [0, 100]\n";
  const std::string learn = "motion calibrate " + log;
  const std::string rad = " --count-mm 0.00017453292519943295";
  const std::string b = " --axis B --machine " + machine + " -o ";
  const json alone = answer_of(learn + " --count-deg 0.01 -o " + keys);
  EXPECT_NEAR(alone["phase_error_deg"][0].get<double>(), 0.0005, 0.00004);
  EXPECT_GT(alone["residual_before_deg"], 0.0003);
  EXPECT_LT(alone["residual_after_deg"], 0.00006);
  EXPECT_FALSE(alone.contains("phase_error_um"));
  EXPECT_FALSE(alone.contains("residual_before_um"));
  EXPECT_THAT(text_of_file(keys), HasSubstr("phase_error_deg = [0.00048"));
  for (const std::string& count : {rad, std::string(" --count-deg 0.01")}) {
    const std::string out = scratch.at("out.toml");
    const json answer = answer_of(learn + count + b + out);
    EXPECT_NEAR(answer["phase_error_deg"][0], alone["phase_error_deg"][0], 1e-12);
    EXPECT_NEAR(answer["residual_after_deg"], alone["residual_after_deg"], 1e-12);
    EXPECT_THAT(text_of_file(out), HasSubstr("phase_error_deg = [0.00048"));
  }
  EXPECT_THAT(run_line(learn + " --count-deg 0.01 -o " + keys).out, HasSubstr("°\n"));
  expect_refused(learn + " --count-deg 0.01 --axis X --machine " + machine + " -o " + keys,
                 "no rotary axis X");
  expect_refused(learn + " --count-deg 0.01" + rad + " -o " + keys, "--count-deg");
  expect_refused(learn + " --count-deg 0 -o " + keys, "");
  expect_refused(learn + " --count-deg -1 -o " + keys, "");
  expect_refused(learn + " -o " + keys, "--count-mm");
}

// Impossible ranges, passes and revolutions, and an output that is the log itself.
TEST(MotionCalibrate, RefusesWhatCannotWork) {
  const Scratch scratch;
  const std::string log = scratch.at("edges.csv");
  write_log(log);
  const std::string to = " -o " + scratch.at("out.toml");
  const std::string learn = "motion calibrate " + log + kCount;
  EXPECT_EQ(run_line(learn + to + " --range 5").code, 2);
  EXPECT_EQ(run_line(learn + to + " --range 9:5").code, 2);
  EXPECT_EQ(run_line(learn + to + " --passes 0").code, 2);
  EXPECT_EQ(run_line(learn + to + " --counts-per-rev 1002").code, 2);
  EXPECT_EQ(run_line(learn + to + " --machine x.toml").code, 2);
  EXPECT_EQ(run_line("motion calibrate " + log + " --count-mm 0" + to).code, 2);
  EXPECT_THAT(run_line(learn + " -o " + log).err, HasSubstr("is the log itself"));
  EXPECT_THAT(text_of_file(log), HasSubstr("t_s,count"));
  EXPECT_EQ(text_of_file(scratch.at("out.toml")), "");
}

}  // namespace
}  // namespace steadyrest::test
