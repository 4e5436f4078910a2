// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <random>
#include <string>
#include <vector>

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

constexpr double kRateHz = 8000.0;
constexpr double kSpeedRpm = 5000.0;
constexpr double kChatterHz = 943.0;
const std::string kDetect = "chatter detect examples/logs/slot-chatter.csv" + kOnVmc;

/// 1.2 s of a cut with two teeth: the forced vibration has the tooth order and its double, 1 %
/// noise. With `chatter` a tone at 943 Hz joins at 0.5 s with a rise of 20 ms; no tooth order is
/// near it (166.7 Hz · 5.66). Values within ±1, as WAV needs them.
std::vector<double> cut(bool chatter) {
  std::mt19937_64 rng(3);
  std::normal_distribution<double> noise(0.0, 0.01);
  std::vector<double> out;
  for (double t_s = 0.0; t_s < 1.2; t_s = static_cast<double>(out.size()) / kRateHz) {
    const double tooth = 2.0 * std::numbers::pi * t_s * 2.0 * kSpeedRpm / 60.0;
    double value = 0.1 * std::sin(tooth) + 0.05 * std::sin(2.0 * tooth) + noise(rng);
    if (chatter && t_s > 0.5) {
      value += 0.5 * (1.0 - std::exp((0.5 - t_s) / 0.02)) *
               std::sin(2.0 * std::numbers::pi * kChatterHz * t_s);
    }
    out.push_back(value);
  }
  return out;
}

std::string csv(const std::vector<double>& values, bool speed) {
  std::string text = speed ? "t_s,value,speed_rpm\n" : "t_s,value\n";
  for (std::size_t i = 0; i < values.size(); ++i) {
    text += fmt::format("{:.6f},{:.5f}{}\n", static_cast<double>(i) / kRateHz, values[i],
                        speed ? fmt::format(",{}", kSpeedRpm) : "");
  }
  return text;
}

/// A WAV of one channel and 16 bits, written byte by byte: the reader must not be tested with its
/// own writer.
std::string little_endian(std::uint32_t value, std::size_t bytes) {
  std::string out;
  for (std::size_t i = 0; i < bytes; ++i) {
    out.push_back(static_cast<char>((value >> (8 * i)) & 0xFFU));
  }
  return out;
}

std::string wav(const std::vector<double>& values) {
  const auto rate = static_cast<std::uint32_t>(kRateHz);
  const auto bytes = static_cast<std::uint32_t>(2 * values.size());
  std::string out = "RIFF" + little_endian(36 + bytes, 4) + "WAVEfmt " + little_endian(16, 4) +
                    little_endian(1, 2) + little_endian(1, 2) + little_endian(rate, 4) +
                    little_endian(2 * rate, 4) + little_endian(2, 2) + little_endian(16, 2) +
                    "data" + little_endian(bytes, 4);
  for (const double value : values) {
    out += little_endian(static_cast<std::uint32_t>(std::lround(value * 32767.0)), 2);
  }
  return out;
}

/// Detected within 150 ms after the onset, until the end, the frequency to 1 %.
void expect_the_chatter(const json& answer) {
  ASSERT_EQ(answer["events"].size(), 1U);
  const json& event = answer["events"][0];
  EXPECT_GT(event["start_s"], 0.5);
  EXPECT_LT(event["start_s"], 0.65);
  EXPECT_NEAR(event["end_s"], 1.2, 0.02);
  EXPECT_NEAR(event["frequency_hz"], kChatterHz, 0.01 * kChatterHz);
  EXPECT_EQ(event["type"], "hopf");
  EXPECT_NEAR(event["speed_rpm"], kSpeedRpm, 1e-6);
}

// The same signal with a speed column, with a given speed, and as WAV.
TEST(ChatterDetect, FindsChatterAndItsFrequency) {
  const Scratch scratch;
  const auto values = cut(true);
  expect_the_chatter(answer_of("chatter detect " + scratch.file("a.csv", csv(values, true)) +
                               kOnVmc + " --teeth 2"));
  expect_the_chatter(answer_of("chatter detect " + scratch.file("b.csv", csv(values, false)) +
                               kOnVmc + " --teeth 2 --speed-rpm 5000"));
  expect_the_chatter(answer_of("chatter detect " + scratch.file("a.wav", wav(values)) + kOnVmc +
                               " --teeth 2 --speed-rpm 5000"));
}

TEST(ChatterDetect, IsSilentInAStableCut) {
  const Scratch scratch;
  const std::string line =
      "chatter detect " + scratch.file("a.csv", csv(cut(false), true)) + kOnVmc + " --teeth 2";
  const json answer = answer_of(line);
  EXPECT_TRUE(answer["events"].is_array());
  EXPECT_TRUE(answer["events"].empty());
  EXPECT_NEAR(answer["seconds"], 1.2, 1e-3);
  EXPECT_THAT(run_line(line).out, HasSubstr("no chatter in 1.2"));
}

// Lobes lie near n = 60·fc/(N·k), but the step nearest to one, 95 %, is unstable at the depth of
// this recording: without a process no step is advised, and the answer says what the speeds rest
// on.
TEST(ChatterDetect, WithoutAProcessNamesTheLobesAndAdvisesNoStep) {
  const json answer = answer_of(kDetect + " --teeth 2");
  EXPECT_EQ(answer["advice_by"], "chatter frequency");
  const json event = answer["events"].at(0);
  EXPECT_GT(event["start_s"], 0.6);
  EXPECT_LT(event["start_s"], 0.75);
  EXPECT_NEAR(event["frequency_hz"], 940.0, 9.4);
  EXPECT_TRUE(event["advised_speed_rpm"].is_null());
  EXPECT_TRUE(event["advised_override_percent"].is_null());
  // 50 … 120 % of 5000 rpm, k = 5 … 11.
  const double first_rpm = 60.0 * event["frequency_hz"].get<double>() / 2.0;
  ASSERT_EQ(event["lobe_speeds_rpm"].size(), 7U);
  for (std::size_t i = 0; i < 7; ++i) {
    EXPECT_NEAR(event["lobe_speeds_rpm"][i], first_rpm / static_cast<double>(5 + i), 1e-6);
  }
  EXPECT_THAT(run_line(kDetect + " --teeth 2").out,
              HasSubstr("rest on the chatter frequency alone"));
}

// Without a depth the deepest step is advised. The solver confirms it: unstable as recorded, stable
// at the advised speed.
TEST(ChatterDetect, AdvisesTheDeepestStepOfTheProcess) {
  const std::string process = "examples/processes/slot-922hz.toml";
  const json event = answer_of(kDetect + " --process " + process)["events"].at(0);
  const double advised_rpm = event["advised_speed_rpm"];
  EXPECT_NEAR(advised_rpm, 50.0 * event["advised_override_percent"].get<double>(), 1e-6);
  const auto radius = [&](double speed_rpm) {
    return answer_of(fmt::format("chatter radius {} --speed-rpm {} --depth-mm 0.5", process,
                                 speed_rpm))["spectral_radius"]
        .get<double>();
  };
  EXPECT_GT(radius(kSpeedRpm), 1.0);
  EXPECT_LT(radius(advised_rpm), 1.0);
}

/// One question, one answer.
TEST(ChatterDetect, WithProcessAndDepthSaysWhatThePlannerSays) {
  const std::string cut =
      "examples/processes/slot-922hz.toml --machine "
      "examples/machines/vmc-840d.toml --depth-mm 1 ";
  const json plan = answer_of("chatter plan " + cut + "--speed-rpm 5000");
  const std::string line =
      "chatter detect examples/logs/slot-chatter.csv --programmed-rpm 5000 --process " + cut;
  const json answer = answer_of(line);
  EXPECT_EQ(answer["advice_by"], "planner");
  const json& event = answer["events"].at(0);
  EXPECT_EQ(event["decision"], plan["decision"]);
  EXPECT_NEAR(event["advised_override_percent"], plan["override_percent"][0], 1e-9);
  EXPECT_NEAR(event["advised_speed_rpm"], plan["speed_rpm"], 1e-9);
  EXPECT_THAT(run_line(line).out, HasSubstr("better speed, by the planner"));
}

// A spindle from 4990 to 5010 rpm has no other step.
TEST(ChatterDetect, AdvisesNothingBeyondTheSpindle) {
  const Scratch scratch;
  std::string machine = text_of_file(project_file("examples/machines/vmc-840d.toml"));
  const std::string wide = "min_rpm = 20\n";
  ASSERT_NE(machine.find(wide), std::string::npos);
  machine.replace(machine.find(wide), wide.size(), "min_rpm = 4990\n");
  const std::string most = "max_rpm = 8000 ";
  ASSERT_NE(machine.find(most), std::string::npos);
  machine.replace(machine.find(most), most.size(), "max_rpm = 5010 ");
  const json event =
      answer_of("chatter detect examples/logs/slot-chatter.csv --teeth 2 --machine " +
                scratch.file("narrow.toml", machine))["events"]
          .at(0);
  EXPECT_TRUE(event["advised_speed_rpm"].is_null());
  EXPECT_TRUE(event["advised_override_percent"].is_null());
  EXPECT_TRUE(event["lobe_speeds_rpm"].empty());
}

// What each kind of signal lacks: speed, teeth, samples, even stamps; WAV cut short.
TEST(ChatterDetect, Refuses) {
  const Scratch scratch;
  const auto detect = [](const std::string& signal, const std::string& rest = " --teeth 2") {
    return "chatter detect " + signal + kOnVmc + rest;
  };
  const std::string silent = scratch.file("silent.csv", csv(cut(false), false));
  expect_refused(detect(silent), "silent.csv: has no spindle speed");
  expect_refused(detect(silent, " --teeth 2 --speed-rpm 0"), "--speed-rpm 0 is not above 0");
  expect_refused(detect(silent, " --teeth 2 --speed-rpm nan"), "--speed-rpm nan");
  expect_refused(detect(silent, " --teeth 2 --speed-rpm 9000"), "above the spindle's 8000");
  expect_refused(kDetect + " --teeth 2 --speed-rpm 5000", "has a speed_rpm column");
  expect_refused(kDetect, "the number of teeth is unknown");
  expect_refused(kDetect + " --teeth 0", "--teeth 0");
  expect_refused(kDetect + " --teeth 65", "--teeth 65");
  expect_refused(kDetect + " --teeth 2 --depth-mm 1", "--depth-mm without --process");
  expect_refused(kDetect + " --teeth 2 --process examples/processes/slot-922hz.toml");
  expect_refused("chatter detect examples/logs/slot-chatter.csv --teeth 2");
  const std::string whole = wav(cut(false));
  expect_refused(detect(scratch.file("cut.wav", whole.substr(0, whole.size() / 2)),
                        " --teeth 2 --speed-rpm 5000"),
                 "the file is truncated");
  // The rate has bytes 24 to 27; a WAV has no t_s.
  std::string no_rate = whole;
  no_rate.replace(24, 4, std::string(4, '\0'));
  expect_refused(detect(scratch.file("rate.wav", no_rate), " --teeth 2 --speed-rpm 5000"),
                 "0 samples a second; allowed: 1000 … 1000000; record at 1 kHz or more\n");
  expect_refused(detect(scratch.file("text.wav", "t_s,value\n")), "is not RIFF");
  expect_refused(detect(scratch.file("gap.csv", "t_s,value\n0,1\n0.001,1\n0.002,1\n0.0035,1\n")),
                 "gap.csv:5: t_s advances by 0.0015 s");
  expect_refused(detect(scratch.file("none.csv", "t_s,speed_rpm\n0,1\n")),
                 "none.csv:1: the column value is missing");
  expect_refused(detect(scratch.file("short.csv", "t_s,value,speed_rpm\n0,1,60\n0.001,1,60\n")),
                 "has 2 samples");
  expect_refused(detect(scratch.file("still.csv", "t_s,value,speed_rpm\n0,1,0\n0.001,1,0\n")),
                 "speed_rpm is 0 throughout");
  expect_refused(detect("no/such.csv"), "no/such.csv: cannot be read");
}

// "No chatter" requires a usable signal.
TEST(ChatterDetect, RefusesADeadSensorAndImpossibleAmplitudes) {
  const Scratch scratch;
  const auto detect = [&scratch](double scale, double offset) {
    std::string text = "t_s,value\n";
    const std::vector<double> values = cut(true);
    for (std::size_t i = 0; i < values.size(); ++i) {
      text += fmt::format("{:.6f},{:.8g}\n", static_cast<double>(i) / kRateHz,
                          scale * values[i] + offset);
    }
    return "chatter detect " + scratch.file("a.csv", text) + kOnVmc + " --teeth 2 --speed-rpm 5000";
  };
  expect_refused(detect(0.0, 0.0),
                 "a.csv: value is 0 in every sample: no signal; check the sensor");
  expect_refused(detect(0.0, -32768.0), "value is -32768 in every sample");
  expect_refused(detect(1e308, 0.0), "it may reach 1e+100");
  expect_refused(detect(1e160, 0.0), "it may reach 1e+100");
  expect_refused(detect(1e-160, 0.0), "must change by 1e-100 or more");
  for (const double scale : {1e-30, 1e30}) {
    EXPECT_FALSE(answer_of(detect(scale, 0.0))["events"].empty()) << scale;
  }
}

TEST(ChatterDetect, RefusesASpeedThatTheSpindleDoesNotReach) {
  const Scratch scratch;
  std::string text = csv(cut(false), true);
  text.replace(text.rfind(",5000"), 5, ",1e9");
  expect_refused("chatter detect " + scratch.file("a.csv", text) + kOnVmc + " --teeth 2",
                 "a.csv: speed_rpm 1e+09 is above the spindle's 8000");
  expect_refused(kDetect + " --teeth 2 --programmed-rpm 1e9",
                 "--programmed-rpm 1e+09 is above the spindle's 8000");
}

}  // namespace
}  // namespace steadyrest::test
