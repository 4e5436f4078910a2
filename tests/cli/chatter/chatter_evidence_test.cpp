// SPDX-License-Identifier: Apache-2.0
// What `chatter detect` says of a recording and its stretches, of a cut that is written down here.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>
#include <sstream>
#include <string>

#include "examples.hpp"
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
using testing::Not;

struct ShopCut {
  double rate_hz = 8000.0;
  double speed_rev_s = 49.7;  ///< 2982 rpm
  int teeth = 4;
  double chatter_hz = 0.0;
  double chatter = 0.9;
  double runout = 0.12;
  double most = 1e9;  ///< the sensor's
};

constexpr double kCutFrom_s = 0.5;
constexpr double kChatterFrom_s = 2.0;

/// 4 s; the tool leaves within 0.3 s before 3.8 s.
std::string rows(const ShopCut& cut, double from_s = 0.0) {
  std::mt19937_64 rng(8);
  std::normal_distribution<double> noise(0.0, 0.05);
  std::string out;
  for (int i = 0; i < static_cast<int>(4.0 * cut.rate_hz); ++i) {
    const double t = i / cut.rate_hz;
    const double engaged =
        std::clamp((t - kCutFrom_s) / 0.05, 0.0, 1.0) * std::clamp((3.8 - t) / 0.3, 0.0, 1.0);
    double value = noise(rng);
    for (int k = 1; k <= 60; ++k) {
      const double size = (k % cut.teeth == 0 ? 1.0 : cut.runout) * std::exp(-k / 25.0);
      value += size * std::pow(engaged, 1.0 + 0.3 * std::cos(5.0 * k)) *
               std::cos(2.0 * std::numbers::pi * k * cut.speed_rev_s * t + k * k);
    }
    if (cut.chatter_hz > 0.0 && t > kChatterFrom_s && t < 3.2) {
      value += cut.chatter * (1.0 - std::exp((kChatterFrom_s - t) / 0.05)) *
               std::sin(2.0 * std::numbers::pi * cut.chatter_hz * t);
    }
    out += fmt::format("{:.6f},{:.5f}\n", from_s + t, std::clamp(value, -cut.most, cut.most));
  }
  return out;
}

std::string recording(const ShopCut& cut) {
  return "Time (s),Accel X (m/s^2)\n" + rows(cut);
}

std::string detect(const Scratch& scratch, const ShopCut& cut, const std::string& said) {
  return "chatter detect " + scratch.file("cut.csv", recording(cut)) + kOnVmc + said;
}

TEST(ChatterEvidence, NamesTheOrderTheChannelAndHowSureItIs) {
  const Scratch scratch;
  const std::string line = detect(scratch, {.chatter_hz = 812.0}, " --teeth 4 --speed-rpm 2994");
  const json answer = answer_of(line);
  EXPECT_NEAR(answer["spindle_rpm"], 2982.0, 1.0);
  EXPECT_LT(answer["spindle_sd_rpm"], 2.0);
  ASSERT_EQ(answer["events"].size(), 1U);
  const json& event = answer["events"][0];
  EXPECT_GT(event["start_s"], kChatterFrom_s);
  EXPECT_LT(event["start_s"], kChatterFrom_s + 0.3);
  EXPECT_NEAR(event["order"], 812.0 / 49.7, 0.01);
  EXPECT_GT(event["confidence"], 0.9);
  EXPECT_EQ(event["nearest_mode"], nullptr);
  const json& evidence = event["evidence"][0];
  EXPECT_EQ(evidence["channel"], 1);
  EXPECT_EQ(evidence["nearest_order"], 16);
  EXPECT_EQ(evidence["order_folded"], false);
  EXPECT_NEAR(evidence["from_order_hz"], 812.0 - 16.0 * 49.7, 1.0);
  const std::string text = run_line(line).out;
  EXPECT_THAT(text, HasSubstr("0.40 % below the stated speed"));
  EXPECT_THAT(text, HasSubstr("16.34 × spindle, 16.8 Hz from 16"));
}

TEST(ChatterEvidence, IsSilentWhereOrdersFoldAndLeaveInTheirOwnWays) {
  const Scratch scratch;
  for (const double rate_hz : {1651.0, 8000.0}) {
    const json answer = answer_of(
        detect(scratch, {.rate_hz = rate_hz, .runout = 0.5}, " --teeth 4 --speed-rpm 2994"));
    EXPECT_TRUE(answer["events"].empty()) << rate_hz;
  }
  const std::string text =
      run_line(detect(scratch, {.rate_hz = 1651.0}, " --teeth 4 --speed-rpm 2982")).out;
  EXPECT_THAT(text, HasSubstr("chatter above 743 Hz cannot be identified"));
  EXPECT_LT(text.find("743 Hz"), text.find("no chatter in")) << "before the verdict";
}

// A tenth too fast, with a wrong cutter, from a sensor that clips, and of nothing at all.
TEST(ChatterEvidence, NamesWhatDoesNotFitTheRecording) {
  const Scratch scratch;
  std::string text =
      run_line(detect(scratch, {.chatter_hz = 812.0}, " --teeth 3 --speed-rpm 3300")).out;
  EXPECT_THAT(text, HasSubstr("the spectral lines fit a spindle at 2982 rpm"));
  EXPECT_THAT(text, HasSubstr("the strong orders are multiples of 4, which does not fit 3 teeth"));
  EXPECT_THAT(text, HasSubstr("812.0 Hz"));
  text = run_line(detect(scratch, {.most = 1.5}, " --teeth 4 --speed-rpm 2982")).out;
  EXPECT_THAT(text, HasSubstr("Accel X clips"));
  EXPECT_THAT(text, HasSubstr("no chatter in"));
  text = run_line(detect(scratch, {.speed_rev_s = 1e-9, .runout = 0.0, .most = 0.3},
                         " --teeth 4 --speed-rpm 2982"))
             .out;
  EXPECT_THAT(text, HasSubstr("no spindle orders rise above the noise"));
  text = run_line(detect(scratch, {}, " --teeth 4 --speed-rpm 2982")).out;
  EXPECT_THAT(text, Not(HasSubstr("the stated speed")));
}

TEST(ChatterEvidence, NamesEntryAndExitAndWhatTheyExplain) {
  const Scratch scratch;
  const std::string line = detect(scratch, {.chatter_hz = 812.0}, " --teeth 4 --speed-rpm 2982");
  const json answer = answer_of(line);
  ASSERT_EQ(answer["cuts"].size(), 1U);
  EXPECT_NEAR(answer["cuts"][0]["start_s"], kCutFrom_s, 0.06);
  EXPECT_NEAR(answer["cuts"][0]["end_s"], 3.7, 0.15);
  EXPECT_EQ(answer["cuts"][0]["entry_seen"], true);
  EXPECT_EQ(answer["edge_revolutions"], 10.0);
  EXPECT_EQ(answer["events"].size(), 1U);
  EXPECT_TRUE(answer["at_edges"].empty());
  // 4 s: all of the cut is its entry.
  const json near = answer_of(line + " --edge-revolutions 200");
  EXPECT_TRUE(near["events"].empty());
  ASSERT_EQ(near["at_edges"].size(), 1U);
  EXPECT_EQ(near["at_edges"][0]["at"], "entry");
  EXPECT_NEAR(near["at_edges"][0]["frequency_hz"], 812.0, 1.0);
  EXPECT_THAT(run_line(line + " --edge-revolutions 200").out,
              HasSubstr("within 200 revolutions of the tool's entry; not counted as chatter"));
  const Finished refused = run_line(line + " --edge-revolutions -1");
  EXPECT_EQ(refused.code, 2);
  EXPECT_THAT(refused.err, HasSubstr("allowed: 0 … 1000"));
}

// The first channel alone shows the cut; the second has noise.
TEST(ChatterEvidence, ACutIsNamedByTheChannelThatShowsIt) {
  const Scratch scratch;
  std::mt19937_64 rng(3);
  std::normal_distribution<double> noise(0.0, 0.05);
  std::string both = "Time (s),Accel X (m/s^2),Accel Y (m/s^2),Temp (C)\n";
  std::istringstream lines(rows({}));
  for (std::string line; std::getline(lines, line);) {
    both += fmt::format("{},{:.4f},21.5\n", line, noise(rng));
  }
  const json answer = answer_of("chatter detect " + scratch.file("both.csv", both) + kOnVmc +
                                " --teeth 4 --speed-rpm 2982");
  ASSERT_EQ(answer["cuts"].size(), 1U);
  EXPECT_NEAR(answer["cuts"][0]["start_s"], kCutFrom_s, 0.06);
  EXPECT_EQ(answer["channels"].size(), 2U);
  EXPECT_THAT(answer["notes"].dump(), HasSubstr("Temp (C) is not vibration"));
}

// The second tool chatters at another speed, with three teeth.
TEST(ChatterEvidence, NamesTheSecondToolOfAFile) {
  const Scratch scratch;
  const std::string both =
      recording({}) + rows({.speed_rev_s = 71.5, .teeth = 3, .chatter_hz = 812.0}, 4.0);
  const std::string line =
      "chatter detect " + scratch.file("two.csv", both) + kOnVmc + " --teeth 4 --speed-rpm 2982";
  const json answer = answer_of(line);
  ASSERT_EQ(answer["sensor"].size(), 1U) << answer["sensor"];
  const std::string said = answer["sensor"][0];
  EXPECT_THAT(said, HasSubstr("the lines fit a spindle at 4290 rpm, not 2982 rpm, and the strong "
                              "orders are multiples of 3, not of 4"));
  ASSERT_EQ(answer["events"].size(), 1U) << answer["events"];
  EXPECT_NEAR(answer["events"][0]["frequency_hz"], 812.0, 1.0);
  EXPECT_NEAR(answer["events"][0]["order"], 812.0 / 71.5, 0.02);
}

TEST(ChatterEvidence, GivesTheProcessFilesNearestMode) {
  const Scratch scratch;
  const json answer =
      answer_of(detect(scratch, {.teeth = 2, .chatter_hz = 912.0, .chatter = 2.5},
                       " --process examples/processes/slot-922hz.toml --speed-rpm 2982"));
  ASSERT_EQ(answer["events"].size(), 1U);
  EXPECT_NEAR(answer["events"][0]["nearest_mode"]["frequency_hz"], 922.0, 0.1);
  EXPECT_NEAR(answer["events"][0]["nearest_mode"]["off_hz"], -10.0, 0.5);
}

}  // namespace
}  // namespace steadyrest::test
