// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstddef>
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

// One cut, recorded by an accelerometer that hears its chatter and a microphone that does not, in
// the files that people have.
namespace steadyrest::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

constexpr double kRecorded_hz = 8000.0;
constexpr double kTone_hz = 943.0;

/// 1.2 s at 5000 rpm with two teeth; with `chatter` a tone joins at 0.5 s.
std::vector<double> heard_by(bool chatter, unsigned seed) {
  std::mt19937_64 rng(seed);
  std::normal_distribution<double> noise(0.0, 0.01);
  std::vector<double> out;
  for (double t_s = 0.0; t_s < 1.2; t_s = static_cast<double>(out.size()) / kRecorded_hz) {
    const double tooth = 2.0 * std::numbers::pi * t_s * 2.0 * 5000.0 / 60.0;
    double value = 0.1 * std::sin(tooth) + 0.05 * std::sin(2.0 * tooth) + noise(rng);
    if (chatter && t_s > 0.5) {
      value += 0.5 * (1.0 - std::exp((0.5 - t_s) / 0.02)) *
               std::sin(2.0 * std::numbers::pi * kTone_hz * t_s);
    }
    out.push_back(value);
  }
  return out;
}

/// Rows of `line(time, quiet microphone, accelerometer)`.
template <class Line>
std::string rows_of(const Line& line) {
  const auto mic = heard_by(false, 1);
  const auto accel = heard_by(true, 2);
  std::string out;
  for (std::size_t i = 0; i < mic.size(); ++i) {
    out += line(static_cast<double>(i) / kRecorded_hz, mic[i], accel[i]);
  }
  return out;
}

std::string with_head(const std::string& head) {
  return head + rows_of([](double t_s, double mic, double accel) {
           return fmt::format("{:.6f},{:.5f},{:.5f}\n", t_s, mic, accel);
         });
}

std::string detect_in(const std::string& file, const std::string& rest = " --speed-rpm 5000") {
  return "chatter detect " + file + kOnVmc + " --teeth 2" + rest;
}

void expect_chatter(const json& answer) {
  ASSERT_EQ(answer["events"].size(), 1U) << answer;
  const json& event = answer["events"][0];
  EXPECT_GT(event["start_s"], 0.5);
  EXPECT_LT(event["start_s"], 0.65);
  EXPECT_NEAR(event["frequency_hz"], kTone_hz, 0.01 * kTone_hz);
}

TEST(ChatterDetectFiles, JudgesEveryColumnAndNamesIt) {
  const Scratch scratch;
  const std::string file = scratch.file("a.csv", with_head("Time (s),Mic (V),Accel X (m/s^2)\n"));
  const json answer = answer_of(detect_in(file));
  expect_chatter(answer);
  EXPECT_EQ(answer["channels"], json({1, 2}));
  EXPECT_EQ(answer["channel_names"], json({"Mic", "Accel X"}));
  EXPECT_EQ(answer["channel_units"], json({"V", "m/s^2"}));
  EXPECT_EQ(answer["events"][0]["channels"], json::array({2}));
  EXPECT_EQ(answer["events"][0]["channel_names"], json::array({"Accel X"}));
  EXPECT_THAT(run_line(detect_in(file)).out, HasSubstr("5000 rpm, channel Accel X"));
  EXPECT_THAT(run_line(detect_in(file) + " --channel 2").out,
              HasSubstr("5000 rpm, channel Accel X"));
}

TEST(ChatterDetectFiles, AChannelIsChosenByNumberOrName) {
  const Scratch scratch;
  const std::string file = scratch.file("a.csv", with_head("Time (s),Mic_V,Accel (m/s^2)\n"));
  for (const char* channel : {"2", "Accel", "accel", "ACCEL(m/s^2)", "Accel(m/s^2)"}) {
    const Finished said = run_line(detect_in(file) + " --json --channel " + channel);
    if (std::string(channel).find('(') != std::string::npos) {  // the blank is missing
      EXPECT_THAT(said.err, HasSubstr("matches none of the 2 channels: 1 Mic_V, 2 Accel (m/s^2)"));
      continue;
    }
    const json answer = json::parse(said.out);
    expect_chatter(answer);
    EXPECT_EQ(answer["channels"], json::array({2}));
  }
  for (const char* channel : {"1", "mic_v", "mic"}) {
    EXPECT_TRUE(answer_of(detect_in(file) + " --channel " + channel)["events"].empty()) << channel;
  }
  expect_refused(detect_in(file) + " --channel 3",
                 "--channel 3 matches none of the 2 channels: 1 Mic_V, 2 Accel");
  const std::string twice = scratch.file("b.csv", with_head("Time (s),Accel (V),Accel (m/s^2)\n"));
  expect_refused(detect_in(twice) + " --channel accel",
                 "--channel accel matches 2 of the 2 channels: 1 Accel (V), 2 Accel (m/s^2)");
}

TEST(ChatterDetectFiles, ReadsASpreadsheetWithItsSpeed) {
  const Scratch scratch;
  std::string text =
      "\xEF\xBB\xBFRecorder;Foo\r\nStart;12:30\r\n\r\n"
      "Time [ms];Mic (V);Accel (m/s²);Spindle speed (rpm)\r\n";
  text += rows_of([](double t_s, double mic, double accel) {
    std::string row = fmt::format("{:.3f};{:.5f};{:.5f};5000\r\n", 1e3 * t_s, mic, accel);
    std::ranges::replace(row, '.', ',');
    return row;
  });
  const json answer = answer_of(detect_in(scratch.file("a.csv", text), ""));
  expect_chatter(answer);
  EXPECT_NEAR(answer["events"][0]["speed_rpm"], 5000.0, 1e-6);
  EXPECT_THAT(answer["notes"].dump(), HasSubstr("the header is line 4"));
}

TEST(ChatterDetectFiles, ReadsBareColumns) {
  const Scratch scratch;
  const std::string two = scratch.file("two.txt", rows_of([](double t_s, double, double accel) {
                                         return fmt::format("{:.6f} {:.5f}\n", t_s, accel);
                                       }));
  expect_chatter(answer_of(detect_in(two)));
  const std::string one = scratch.file("one.txt", rows_of([](double, double, double accel) {
                                         return fmt::format("{:.5f}\n", accel);
                                       }));
  expect_refused(detect_in(one), "one.txt:1: there is no header");
  expect_refused(detect_in(one), "give the samples per second with --rate-hz");
  expect_chatter(answer_of(detect_in(one) + " --rate-hz 8000"));
  expect_refused(detect_in(one) + " --rate-hz 0", "--rate-hz 0 is not above 0");
  expect_refused(detect_in(one) + " --rate-hz 8000 --sample-hz 8000");
  expect_refused(detect_in(two) + " --rate-hz 500", "allowed: 1000 … 1000000");
}

TEST(ChatterDetectFiles, TakesTheSpeedFromTheFilesName) {
  const Scratch scratch;
  const std::string file =
      scratch.file("S5000_f300.csv", with_head("Time (s),Mic (V),Accel (m/s^2)\n"));
  const json answer = answer_of(detect_in(file, " --speed-from-name S{rpm}_f*.csv"));
  expect_chatter(answer);
  EXPECT_NEAR(answer["events"][0]["speed_rpm"], 5000.0, 1e-6);
  EXPECT_THAT(answer["notes"].dump(), HasSubstr("5000 rpm by the file's name"));
  expect_refused(detect_in(file, " --speed-from-name X{rpm}.csv"), "does not fit");
  expect_refused(detect_in(file, " --speed-from-name S*.csv"), "must have {rpm} once");
  expect_refused(detect_in(file, " --speed-from-name S{rpm}* --speed-rpm 5000"));
  const std::string fast =
      scratch.file("S50000.csv", with_head("Time (s),Mic (V),Accel (m/s^2)\n"));
  expect_refused(detect_in(fast, " --speed-from-name S{rpm}.csv"),
                 "--speed-from-name 50000 is above the spindle's 8000");
}

// Through a gap of 0.1 s before the chatter and single samples that are not numbers.
TEST(ChatterDetectFiles, HearsThroughGaps) {
  const Scratch scratch;
  const std::string text =
      "t_s,Mic (V),Accel (m/s^2)\n" + rows_of([](double t_s, double mic, double accel) {
        if (t_s > 0.2001 && t_s < 0.3) {
          return std::string();
        }
        const bool lost = std::lround(t_s * kRecorded_hz) == 5000;
        return fmt::format("{:.6f},{:.5f},{}\n", t_s, mic,
                           lost ? "nan" : fmt::format("{:.5f}", accel));
      });
  const std::string file = scratch.file("a.csv", text);
  const json answer = answer_of(detect_in(file));
  expect_chatter(answer);
  EXPECT_NEAR(answer["seconds"], 1.2, 1e-3);
  const std::string notes = answer["notes"].dump();
  EXPECT_THAT(notes, HasSubstr("samples are missing in 1 place, the first before line 1603"));
  EXPECT_THAT(notes, HasSubstr("Accel (m/s^2): 1 sample is not a number, the first in line "));
  const Finished report = run_line(detect_in(file) + " --report out");
  EXPECT_EQ(report.code, 0) << report.err;
}

/// Dataset 58 by its columns.
std::string time_record(int node, const std::vector<double>& values) {
  std::string out = "    -1\n    58\nNONE\nNONE\n30-Nov-26\nNONE\nNONE\n";
  out += fmt::format("{:5}{:10}{:5}{:10} {:10}{:10}{:4} {:10}{:10}{:4}\n", 1, 1, 1, 0, "NONE", node,
                     3, "NONE", 0, 0);
  out += fmt::format("{:10}{:10}{:10}{:13.5E}{:13.5E}{:13.5E}\n", 4, values.size(), 1, 0.0,
                     1.0 / kRecorded_hz, 0.0);
  for (const int kind : {17, 12, 0, 0}) {
    out += fmt::format("{:10}{:5}{:5}{:5} {:20} {:20}\n", kind, 0, 0, 0, "NONE",
                       kind == 17 ? "s" : "NONE");
  }
  for (std::size_t i = 0; i < values.size(); ++i) {
    out += fmt::format("{:20.12E}{}", values[i], i % 4 == 3 ? "\n" : "");
  }
  return out + "\n    -1\n";
}

TEST(ChatterDetectFiles, ReadsUniversalFiles) {
  const Scratch scratch;
  const std::string file =
      scratch.file("a.uff", time_record(7, heard_by(false, 1)) + time_record(8, heard_by(true, 2)));
  const json answer = answer_of(detect_in(file));
  expect_chatter(answer);
  EXPECT_EQ(answer["events"][0]["channel_names"], json::array({"node 8 +Z"}));
  EXPECT_TRUE(answer_of(detect_in(file) + " --channel 1")["events"].empty());
}

}  // namespace
}  // namespace steadyrest::test
