// SPDX-License-Identifier: Apache-2.0
#include <bit>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/chatter/offline/signal/signal_file.hpp>

namespace steadyrest::chatter::offline::test {
namespace {

using testing::HasSubstr;

std::string le(std::uint32_t value, std::size_t bytes) {
  std::string out;
  for (std::size_t i = 0; i < bytes; ++i) {
    out.push_back(static_cast<char>((value >> (8 * i)) & 0xFFU));
  }
  return out;
}

struct Wav {
  std::uint32_t tag = 1;
  std::uint32_t channels = 1;
  std::uint32_t rate_hz = 8000;
  std::uint32_t bits = 16;
  // Lets designated initialisers leave it out.
  // NOLINTNEXTLINE(readability-redundant-member-init)
  std::string extra{};  ///< chunks before the data
};

std::string wav(const Wav& how, const std::vector<std::uint32_t>& words) {
  std::string data;
  for (const std::uint32_t word : words) {
    data += le(word, how.bits / 8);
  }
  const std::uint32_t frame = how.channels * how.bits / 8;
  const std::string body = "WAVEfmt " + le(16, 4) + le(how.tag, 2) + le(how.channels, 2) +
                           le(how.rate_hz, 4) + le(how.rate_hz * frame, 4) + le(frame, 2) +
                           le(how.bits, 2) + how.extra + "data" +
                           le(static_cast<std::uint32_t>(data.size()), 4) + data;
  return "RIFF" + le(static_cast<std::uint32_t>(body.size()), 4) + body;
}

/// The first channel.
kernel::outcome::Result<RecordedSignal> parse_signal(const std::string& bytes,
                                                     const std::string& file,
                                                     const table::Format& format = {}) {
  auto all = parse_signals(bytes, file, format);
  if (!all) {
    return std::unexpected(all.error());
  }
  return std::move(all->front());
}

void expect_refused(const std::string& bytes, const std::string& why, std::size_t line = 0,
                    const std::string& file = "signal") {
  const auto read = parse_signal(bytes, file);
  ASSERT_FALSE(read) << why;
  EXPECT_THAT(read.error().what, HasSubstr(why));
  EXPECT_EQ(read.error().line, line) << why;
  EXPECT_EQ(read.error().file, file);
  EXPECT_FALSE(read.error().to_do.empty()) << why;
}

TEST(SignalFile, ReadsColumnsByTheirNames) {
  const auto read = parse_signal(
      "\xEF\xBB\xBF# a remark\r\n\r\nspeed_rpm; other;value ;t_s\r\n-600;x;1.5;0.1\r\n"
      "1200;y;-2e-1;0.1005\r\n0;;3;0.101",
      "signal");
  ASSERT_TRUE(read) << read.error().what;
  EXPECT_NEAR(read->rate_hz, 2000.0, 1e-6);
  EXPECT_EQ(read->start_s, 0.1);
  EXPECT_THAT(read->value, testing::ElementsAre(1.5, -0.2, 3.0));
  EXPECT_THAT(read->speed_rev_s, testing::ElementsAre(10.0, 20.0, 0.0));
}

TEST(SignalFile, ReadsWhatHasNoTimeWhenItsRateIsSaid) {
  table::Format format;
  format.columns = {"sample", "value"};
  format.sample_hz = 2000.0;
  const auto read = parse_signal("4 0.5 \n5 -0.5 \n6 0.25 \n", "signal", format);
  ASSERT_TRUE(read) << read.error().what;
  EXPECT_NEAR(read->rate_hz, 2000.0, 1e-6);
  EXPECT_THAT(read->value, testing::ElementsAre(0.5, -0.5, 0.25));
  const auto lost = parse_signal("4 0.5 \n5 -0.5 \n6 0.5 \noverrun\n9 0.25 \n", "signal", format);
  ASSERT_TRUE(lost) << lost.error().what;
  EXPECT_NEAR(lost->rate_hz, 2000.0, 1e-6);
  EXPECT_THAT(lost->value,
              testing::ElementsAre(0.5, -0.5, 0.5, testing::IsNan(), testing::IsNan(), 0.25));
}

TEST(SignalFile, HasNoSpeedWithoutTheColumn) {
  const auto read = parse_signal("t_s,value\n0,1\n0.001,2\n", "signal");
  ASSERT_TRUE(read);
  EXPECT_TRUE(read->speed_rev_s.empty());
}

TEST(SignalFile, TakesRoundedStamps) {
  std::string text = "t_s,value\n";
  for (int i = 0; i < 100; ++i) {
    text += std::to_string(static_cast<double>(i) / 44100.0) + ",0\n";  // six decimals
  }
  const auto read = parse_signal(text, "signal");
  ASSERT_TRUE(read) << read.error().what;
  EXPECT_NEAR(read->rate_hz, 44100.0, 44.1);
}

TEST(SignalFile, RefusesTextByLine) {
  const std::string head = "t_s,value\n0,1\n0.001,2\n0.002,3\n";
  expect_refused("", "0 samples");
  expect_refused("t_s,value\n0,1\n", "1 samples");
  expect_refused("# x\npart,value\n0,1\n", "t_s is missing in the header: \"part\"", 2);
  expect_refused("t_s,speed_rpm\n0,1\n", "value is missing", 1);
  expect_refused("t_s,state\n0,on\n0.001,off\n", "no column beside time and speed has numbers");
  expect_refused("t_s,value,t_s\n0,1,0\n", "t_s appears twice", 1);
  expect_refused(head + "0.003\n", "the row has 1 fields, the header 2", 5);
  expect_refused(head + "0.003,4,5\n", "3 fields", 5);
  expect_refused(head + "0.003,4x\n", "\"4x\"", 5);
  expect_refused(head + "0.003,1e999\n", "\"1e999\"", 5);
  expect_refused(head + "0.0035,4\n", "t_s advances by 0.0015 s here and by 0.001 s elsewhere", 5);
  expect_refused(head + "1.0031,4\n", "t_s advances by 1.0011 s", 5);
  expect_refused(head + "0.9,4\n", "more samples are missing", 5);
  expect_refused(head + "0.002,4\n", "t_s advances by 0 s", 5);
  expect_refused(head + "0.001,4\n0.002,1\n", "t_s advances by -0.001 s", 5);
  expect_refused("t_s,value\n0,1\n0.01,2\n", "100 samples a second");
  expect_refused("t_s,value\n0,1\n0.0000005,2\n", "2e+06 samples a second");
  expect_refused(std::string("t_s,value\n0,\0", 13), "neither text nor RIFF");
}

TEST(SignalFile, ReadsPcmAndFloats) {
  const auto values = [](const Wav& how, const std::vector<std::uint32_t>& words) {
    const auto read = parse_signal(wav(how, words), "a.wav");
    EXPECT_TRUE(read) << read.error().what;
    return read ? read->value : std::vector<double>{};
  };
  using testing::ElementsAre;
  EXPECT_THAT(values({}, {0x4000, 0x8000, 0}), ElementsAre(0.5, -1.0, 0.0));
  EXPECT_THAT(values({.bits = 8}, {192, 0, 128}), ElementsAre(0.5, -1.0, 0.0));
  EXPECT_THAT(values({.bits = 24}, {0x400000, 0x800000}), ElementsAre(0.5, -1.0));
  EXPECT_THAT(values({.bits = 32}, {0x40000000, 0x80000000}), ElementsAre(0.5, -1.0));
  EXPECT_THAT(values({.tag = 3, .bits = 32},
                     {std::bit_cast<std::uint32_t>(0.25F), std::bit_cast<std::uint32_t>(-3.0F)}),
              ElementsAre(0.25, -3.0));
  EXPECT_THAT(values({.channels = 2}, {0x4000, 0x1111, 0x2000, 0x2222}), ElementsAre(0.5, 0.25));
  EXPECT_THAT(values({.extra = "LIST" + le(3, 4) + "abc" + '\0'}, {0x4000, 0}),
              ElementsAre(0.5, 0.0));
  const auto read = parse_signal(wav({.rate_hz = 44100}, {1, 2}), "a.wav");
  ASSERT_TRUE(read);
  EXPECT_EQ(read->rate_hz, 44100.0);
  EXPECT_TRUE(read->speed_rev_s.empty());
}

TEST(SignalFile, ReadsEveryChannel) {
  const auto read =
      parse_signals(wav({.channels = 3, .bits = 24},
                        {0x400000, 0x800000, 0, 0x200000, 0x400000, 0, 0, 0x600000, 0x400000}),
                    "a.wav");
  ASSERT_TRUE(read) << read.error().what;
  ASSERT_EQ(read->size(), 3U);
  EXPECT_THAT(read->at(0).value, testing::ElementsAre(0.5, 0.25, 0.0));
  EXPECT_THAT(read->at(1).value, testing::ElementsAre(-1.0, 0.5, 0.75));
  EXPECT_THAT(read->at(2).value, testing::ElementsAre(0.0, 0.0, 0.5));
  EXPECT_EQ(read->at(2).channel, 3U);
}

TEST(SignalFile, RefusesWavByByte) {
  const std::string whole = wav({}, {1, 2, 3, 4});
  for (std::size_t bytes = 4; bytes < whole.size(); ++bytes) {
    expect_refused(whole.substr(0, bytes), bytes < 12 ? "byte 0" : "byte 4");
  }
  std::string long_data = whole;
  long_data.replace(40, 4, le(9, 4));
  expect_refused(long_data, "byte 36: 9 bytes announced, 8 found: the file is truncated");
  expect_refused("RIFX....WAVE", "is not RIFF", 0, "a.WAV");
  expect_refused("", "is not RIFF", 0, "a.wav");
  expect_refused("RIFF" + le(4, 4) + "AVI ", "not WAVE");
  expect_refused("RIFF" + le(4, 4) + "WAVE", "no fmt chunk");
  expect_refused(wav({.rate_hz = 800}, {1, 2}), "800 samples a second");
  expect_refused(wav({.rate_hz = 1100000}, {1, 2}), "1.1e+06 samples a second");
  expect_refused(wav({.bits = 12}, {1, 2}), "format 1 of 12 bits");
  expect_refused(wav({.tag = 2}, {1, 2}), "format 2 of 16 bits");
  expect_refused(wav({.channels = 0}, {1, 2}), "0 channels");
  expect_refused(wav({.channels = 2}, {1, 2, 3}), "6 bytes of data");
  expect_refused(wav({}, {1}), "2 bytes of data");
}

TEST(SignalFile, RefusesWhatCannotBeRead) {
  EXPECT_THAT(read_signals("no/such.csv").error().what, HasSubstr("cannot be read"));
  EXPECT_THAT(read_signals("/").error().what, HasSubstr("is a folder"));
}

}  // namespace
}  // namespace steadyrest::chatter::offline::test
