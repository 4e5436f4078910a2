// SPDX-License-Identifier: Apache-2.0
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/chatter/offline/response/test/uff.hpp>
#include <steadyrest/chatter/offline/signal/signal_file.hpp>
#include <steadyrest/chatter/offline/signal/signal_speed_name.hpp>

// WAV of every kind, universal files, and the speed in a file's name.
namespace steadyrest::chatter::offline::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsNan;

std::string bytes_of_word(std::uint64_t value, std::size_t bytes) {
  std::string out;
  for (std::size_t i = 0; i < bytes; ++i) {
    out.push_back(static_cast<char>((value >> (8 * i)) & 0xFFU));
  }
  return out;
}

/// WAVE_FORMAT_EXTENSIBLE: the real tag begins the GUID of the sub-format.
std::string extensible(std::uint32_t tag, std::uint32_t channels, std::uint32_t bits,
                       const std::string& data) {
  constexpr std::uint32_t kRate = 51200;
  const std::uint32_t frame = channels * bits / 8;
  const std::string guid("\x00\x00\x00\x00\x10\x00\x80\x00\x00\xAA\x00\x38\x9B\x71", 14);
  const std::string body = "WAVEfmt " + bytes_of_word(40, 4) + bytes_of_word(0xFFFE, 2) +
                           bytes_of_word(channels, 2) + bytes_of_word(kRate, 4) +
                           bytes_of_word(std::uint64_t{kRate} * frame, 4) +
                           bytes_of_word(frame, 2) + bytes_of_word(bits, 2) + bytes_of_word(22, 2) +
                           bytes_of_word(bits, 2) + bytes_of_word(0, 4) + bytes_of_word(tag, 2) +
                           guid + "data" + bytes_of_word(data.size(), 4) + data;
  return "RIFF" + bytes_of_word(body.size(), 4) + body;
}

TEST(SignalSource, ReadsExtensibleWavOfManyChannels) {
  std::string data;
  for (int i = 0; i < 4000; ++i) {
    for (std::uint32_t c = 0; c < 6; ++c) {
      data += bytes_of_word((c + 1) << 12U, 2);
    }
  }
  const auto six = parse_signals(extensible(1, 6, 16, data), "a.wav");
  ASSERT_TRUE(six) << six.error().what;
  ASSERT_EQ(six->size(), 6U);
  EXPECT_EQ(six->at(5).value.at(100), 0.75);
  EXPECT_EQ(six->at(5).recorded_hz, 51200.0);
  EXPECT_EQ(six->at(5).name, "");
}

TEST(SignalSource, ReadsDoublesAndKeepsTheirGaps) {
  std::string data;
  for (const double value : {0.25, -3.0, std::numeric_limits<double>::infinity(), 1e-300}) {
    data += bytes_of_word(std::bit_cast<std::uint64_t>(value), 8);
  }
  std::string file = extensible(3, 1, 64, data);
  file.replace(24, 4, bytes_of_word(8000, 4));  // not reduced
  const auto one = parse_signals(file, "a.wav");
  ASSERT_TRUE(one) << one.error().what;
  EXPECT_THAT(one->front().value, ElementsAre(0.25, -3.0, IsNan(), 1e-300));
  EXPECT_THAT(one->front().notes.at(0),
              HasSubstr("1 sample is not a number, the first is number 3"));
}

struct UffRecord {
  std::string title = "NONE";
  int type = 1;
  int node = 1;
  int direction = 1;
  double step = 5e-4;
  std::string unit = "s";
  int samples = 8;
};

/// A time response in single precision, sample i of node n being n + i/8.
std::string uff_record(const UffRecord& how) {
  std::string out = "    -1\n    58\n" + how.title + "\nNONE\n30-Nov-26\nNONE\nNONE\n";
  out += fmt::format("{:5}{:10}{:5}{:10} {:10}{:10}{:4} {:10}{:10}{:4}\n", how.type, 1, 1, 0,
                     "NONE", how.node, how.direction, "NONE", 0, 0);
  out += fmt::format("{:10}{:10}{:10}{:13.5E}{:13.5E}{:13.5E}\n", 2, how.samples, 1, -0.01,
                     how.step, 0.0);
  out += fmt::format("{:10}{:5}{:5}{:5} {:20} {:20}\n", 17, 0, 0, 0, "Time", how.unit);
  out += fmt::format("{:10}{:5}{:5}{:5} {:20} {:20}\n", 12, 0, 0, 0, "Acceleration", "m/s^2");
  for (int i = 0; i < 2; ++i) {
    out += fmt::format("{:10}{:5}{:5}{:5} {:20} {:20}\n", 0, 0, 0, 0, "NONE", "NONE");
  }
  for (int i = 0; i < how.samples; ++i) {
    out += fmt::format("{:13.5E}{}", how.node + i / 8.0, i % 6 == 5 ? "\n" : "");
  }
  return out + "\n    -1\n";
}

std::string uff_refusal(const std::string& text) {
  const auto out = parse_signals(text, "a.uff");
  return out ? "accepted" : kernel::outcome::text(out.error());
}

TEST(SignalSource, EachTimeResponseOfAUniversalFileIsAChannel) {
  const auto two = parse_signals(
      uff_record({.node = 3}) + UffText().made() + uff_record({.node = 4, .direction = -2}),
      "a.uff");
  ASSERT_TRUE(two) << kernel::outcome::text(two.error());
  ASSERT_EQ(two->size(), 2U);
  EXPECT_NEAR(two->at(0).rate_hz, 2000.0, 1e-3);
  EXPECT_NEAR(two->at(0).start_s, -0.01, 1e-9);
  EXPECT_EQ(two->at(0).name, "node 3 +X");
  EXPECT_EQ(two->at(0).unit, "m/s^2");
  EXPECT_EQ(two->at(1).name, "node 4 −Y");
  EXPECT_EQ(two->at(1).channel, 2U);
  EXPECT_EQ(two->at(1).value,
            (std::vector<double>{4.0, 4.125, 4.25, 4.375, 4.5, 4.625, 4.75, 4.875}));
  EXPECT_THAT(two->at(0).notes,
              testing::Contains("1 of function type 4 (frequency response) skipped"));
}

TEST(SignalSource, TheFirstLineOfARecordNamesItWhereAllDiffer) {
  const auto two = parse_signals(
      uff_record({.title = "Spindle nose"}) + uff_record({.title = "Table", .node = 2}), "a.uff");
  ASSERT_TRUE(two);
  EXPECT_EQ(two->at(0).name, "Spindle nose");
  EXPECT_EQ(two->at(0).written, "node 1 +X");
  const auto same = parse_signals(
      uff_record({.title = "Run 7"}) + uff_record({.title = "Run 7", .node = 2}), "a.uff");
  ASSERT_TRUE(same);
  EXPECT_EQ(same->at(1).name, "node 2 +X");
}

TEST(SignalSource, ReadsBinaryUniversalFiles) {
  UffText uff;
  uff.function = 1;
  uff.abscissa = "s";
  uff.value = {0.5, 0.0};
  for (const int data : {2, 4}) {
    for (const int order : {1, 2}) {
      uff.data = data;
      uff.per_hz = 1e-5;  // 100 Hz apart become 1 ms
      std::string text = uff.made_binary(order);
      const std::string hz = fmt::format("{:10}{:5}", 18, 0);
      ASSERT_NE(text.find(hz), std::string::npos);
      text.replace(text.find(hz), hz.size(), fmt::format("{:10}{:5}", 17, 0));
      const auto one = parse_signals(text, "a.uff");
      ASSERT_TRUE(one) << kernel::outcome::text(one.error());
      EXPECT_EQ(one->front().value, std::vector<double>(8, 0.5));
      EXPECT_NEAR(one->front().rate_hz, 1000.0, 1e-6);
    }
  }
}

TEST(SignalSource, RefusesWhatIsNotOneRecording) {
  EXPECT_THAT(uff_refusal(UffText().made()),
              HasSubstr("a.uff:8: no time response (type 1): 1 of function type 4"));
  EXPECT_THAT(uff_refusal("    -1\n   164\n    -1\n"), HasSubstr("has no dataset 58"));
  EXPECT_THAT(uff_refusal(uff_record({}) + uff_record({.node = 2, .step = 2.5e-4})),
              HasSubstr("8 samples at 4000 Hz"));
  EXPECT_THAT(uff_refusal(uff_record({}) + uff_record({.node = 2, .samples = 7})),
              HasSubstr("7 samples at 2000 Hz"));
  EXPECT_THAT(uff_refusal(uff_record({.unit = "Hz"})), HasSubstr("a.uff:10: the abscissa is of"));
  EXPECT_THAT(uff_refusal(uff_record({.step = 0.5})), HasSubstr("2 samples a second"));
  const std::string whole = uff_record({});
  EXPECT_THAT(uff_refusal(whole.substr(0, whole.size() - 40)),
              HasSubstr("a.uff:14: the file ends"));
}

TEST(SignalSource, TheSpeedMayBeInTheName) {
  const auto rpm = [](const std::string& path, const std::string& pattern) {
    const auto out = speed_rpm_in_name(path, pattern);
    return out ? fmt::format("{}", *out) : kernel::outcome::text(out.error());
  };
  EXPECT_EQ(rpm("/data/300/S5000_f300.csv", "S{rpm}_f*.csv"), "5000");
  EXPECT_EQ(rpm("S5000_f300.csv", "S{rpm}*"), "5000");
  EXPECT_EQ(rpm("cut 12 at 8000rpm b.wav", "*at {rpm}rpm*"), "8000");
  EXPECT_EQ(rpm("7250.5.wav", "{rpm}.wav"), "7250.5");
  EXPECT_THAT(rpm("S5000_f300.csv", "*{rpm}*"), HasSubstr("with 5000 and 300"));
  EXPECT_THAT(rpm("S5000_f300.csv", "S{rpm}.csv"), HasSubstr("does not fit"));
  EXPECT_THAT(rpm("S5000.csv", "S5{rpm}.csv"), HasSubstr("does not fit"));
  EXPECT_THAT(rpm("S0.csv", "S{rpm}.csv"), HasSubstr("not above 0"));
  EXPECT_THAT(rpm("S0.csv", "S*.csv"), HasSubstr("must have {rpm} once"));
  EXPECT_THAT(rpm("S0.csv", "{rpm}{rpm}"), HasSubstr("must have {rpm} once"));
}

}  // namespace
}  // namespace steadyrest::chatter::offline::test
