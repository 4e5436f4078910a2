// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/adapters/lines/encoders/encoder_source.hpp>
#include <steadyrest/adapters/lines/encoders/recorder_message.hpp>

namespace steadyrest::adapters::lines {
namespace {

using Bytes = std::vector<std::uint8_t>;

RecorderSample sample_of(std::uint16_t sequence, std::uint32_t ticks, std::int32_t count) {
  RecorderSample sample{.sequence = sequence, .ticks = ticks, .clock_hz = 1'000'000, .counters = 2};
  sample.counter[0] = {.count = count, .edge_ticks = ticks - 10, .direction = 1};
  sample.counter[1] = {.count = -count, .edge_ticks = ticks - 20, .direction = -1};
  return sample;
}

// The check value of CRC-16/CCITT-FALSE in the catalogue of parametrised CRC algorithms.
TEST(RecorderMessage, ChecksumIsTheCataloguesOne) {
  constexpr std::string_view kDigits = "123456789";
  const Bytes bytes(kDigits.begin(), kDigits.end());
  EXPECT_EQ(crc16(bytes), 0x29B1);
}

// Worked out by hand with the README's table, so that firmware has something to compare with.
TEST(RecorderMessage, IsTheReadmesTable) {
  const RecorderSample sample{.sequence = 0x0102, .ticks = 0x01020304, .clock_hz = 0x0A0B0C0D};
  const Bytes plain = {'S', 0, 0x02, 0x01, 0x0D, 0x0C, 0x0B, 0x0A, 0x04, 0x03, 0x02, 0x01};
  const std::uint16_t check = crc16(plain);
  Bytes expected = {2, 'S', 13, 0x02, 0x01, 0x0D, 0x0C, 0x0B, 0x0A, 0x04, 0x03, 0x02, 0x01};
  expected.push_back(static_cast<std::uint8_t>(check & 0xFFU));
  expected.push_back(static_cast<std::uint8_t>(check >> 8U));
  expected.push_back(0);
  EXPECT_EQ(message_of(sample), expected);
}

TEST(RecorderMessage, ComesBackWholeHoweverItIsCutInPieces) {
  Bytes stream;
  for (std::uint16_t i = 0; i < 50; ++i) {
    const Bytes one = message_of(sample_of(i, 1000U * i, 256 * static_cast<std::int32_t>(i)));
    stream.insert(stream.end(), one.begin(), one.end());
  }
  for (const std::size_t piece : {1U, 7U, 64U, 4096U}) {
    RecorderParser parser;
    RecorderSample newest;
    for (std::size_t at = 0; at < stream.size(); at += piece) {
      parser.feed({stream.data() + at, std::min(piece, stream.size() - at)}, newest);
    }
    EXPECT_EQ(parser.counts().samples, 50U);
    EXPECT_EQ(parser.counts().broken, 0U);
    EXPECT_EQ(parser.counts().missing, 0U);
    EXPECT_EQ(newest.sequence, 49);
    EXPECT_EQ(newest.counter[0].count, 256 * 49);
    EXPECT_EQ(newest.counter[1].direction, -1);
  }
}

TEST(RecorderMessage, ABrokenOneIsCountedAndTheNextIsFound) {
  for (std::size_t at = 0; at + 1 < message_of(sample_of(1, 1000, 5)).size(); ++at) {
    for (const unsigned flip : {0x01U, 0x80U, 0xFFU}) {
      RecorderParser parser;
      RecorderSample newest;
      Bytes stream = message_of(sample_of(1, 1000, 5));
      stream[at] ^= static_cast<std::uint8_t>(flip);
      const Bytes good = message_of(sample_of(2, 2000, 6));
      stream.insert(stream.end(), good.begin(), good.end());
      ASSERT_TRUE(parser.feed(stream, newest));
      EXPECT_EQ(newest.sequence, 2);
      EXPECT_GE(parser.counts().broken, 1U) << "byte " << at;
      EXPECT_EQ(parser.counts().samples, 1U);
    }
  }
}

TEST(RecorderMessage, LostOnesAreCounted) {
  RecorderParser parser;
  RecorderSample newest;
  for (const std::uint16_t sequence :
       {std::uint16_t{65533}, std::uint16_t{65535}, std::uint16_t{2}}) {
    parser.feed(message_of(sample_of(sequence, 0, 0)), newest);
  }
  EXPECT_EQ(parser.counts().missing, 3U);  // 65534; 0 and 1
}

// Between two readings of the layer the recorder sends several; only the newest is taken.
TEST(RecorderMessage, WhatIsLostInAnOlderOneIsTold) {
  RecorderParser parser;
  RecorderSample newest;
  auto lost = sample_of(2, 2000, 2);
  lost.counter[1].lost = true;
  Bytes stream;
  for (const auto& one : {sample_of(1, 1000, 1), lost, sample_of(3, 3000, 3)}) {
    const Bytes message = message_of(one);
    stream.insert(stream.end(), message.begin(), message.end());
  }
  ASSERT_TRUE(parser.feed(stream, newest));
  EXPECT_EQ(newest.sequence, 3);
  EXPECT_FALSE(newest.counter[0].lost);
  EXPECT_TRUE(newest.counter[1].lost);
  RecorderSample next;
  ASSERT_TRUE(parser.feed(message_of(sample_of(4, 4000, 4)), next));
  EXPECT_FALSE(next.counter[1].lost) << "told once";
}

// A million bytes of noise: nothing but what has the right checksum by chance, 2^-16, could count.
TEST(RecorderMessage, NoiseIsNoSample) {
  std::mt19937 dice(7);  // NOLINT(bugprone-random-generator-seed): the same cases each time
  RecorderParser parser;
  RecorderSample newest;
  Bytes bytes(1000);
  for (int i = 0; i < 1000; ++i) {
    for (auto& byte : bytes) {
      byte = static_cast<std::uint8_t>(dice() % (i % 2 == 0 ? 256 : 20));
    }
    parser.feed(bytes, newest);
  }
  EXPECT_LE(parser.counts().samples, 1U);
  EXPECT_GT(parser.counts().broken, 1000U);
  EXPECT_TRUE(parser.feed(message_of(sample_of(9, 9, 9)), newest) ||
              parser.feed(message_of(sample_of(9, 9, 9)), newest));
}

TEST(RecorderTrack, FollowsClockAndCountsOverTheirEnds) {
  RecorderTrack track;
  std::uint32_t ticks = 0xFFFFFF00U;
  std::uint32_t count = 0x7FFFFFF0U;
  ASSERT_TRUE(track.take(sample_of(0, ticks, static_cast<std::int32_t>(count))));
  EncoderReading now;
  for (std::uint16_t i = 1; i <= 10; ++i) {
    ticks += 1000;
    count += 7;
    const auto taken = track.take(sample_of(i, ticks, static_cast<std::int32_t>(count)));
    ASSERT_TRUE(taken);
    now = *taken;
  }
  EXPECT_DOUBLE_EQ(now.time_s, 0.010);
  EXPECT_EQ(now.count[0], 70);
  EXPECT_EQ(now.count[1], -70);
  EXPECT_DOUBLE_EQ(now.edge_s[0], 0.010 - 10e-6);
}

TEST(RecorderTrack, AnOldEdgeKeepsItsTime) {
  RecorderTrack track;
  auto sample = sample_of(0, 1000, 0);
  ASSERT_TRUE(track.take(sample));
  ++sample.sequence;
  const double edge_s = track.take(sample).value().edge_s[0];
  for (int i = 0; i < 4000; ++i) {  // the clock goes round almost twice
    ++sample.sequence;
    sample.ticks += 1'900'000;
    ASSERT_DOUBLE_EQ(track.take(sample).value().edge_s[0], edge_s);
  }
}

TEST(RecorderTrack, AnEdgeWhileTheMessageWasMadeIsNow) {
  RecorderTrack track;
  auto sample = sample_of(0, 1000, 0);
  ASSERT_TRUE(track.take(sample));
  ++sample.sequence;
  sample.ticks += 1000;
  sample.counter[0].edge_ticks = sample.ticks + 3;
  sample.counter[0].direction = 1;
  const auto now = track.take(sample).value();
  EXPECT_EQ(now.edge_s[0], now.time_s);
}

TEST(RecorderTrack, ARestartIsSeenThoughItsClockFits) {
  RecorderTrack track;
  ASSERT_TRUE(track.take(sample_of(900, 900'000, 5000)));
  const auto again = track.take(sample_of(3, 903'000, 0));
  ASSERT_FALSE(again);
  EXPECT_NE(again.error().what.find("began again"), std::string::npos);
}

// At 4 GHz the ticks go round each second, and no silence would ever look long.
TEST(RecorderTrack, AClockThatGoesRoundTooSoonIsRefused) {
  RecorderTrack track;
  auto fast = sample_of(0, 1000, 0);
  fast.clock_hz = 4'000'000'000U;
  const auto refused = track.take(fast);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().what.find("4000000000 Hz"), std::string::npos);
}

TEST(RecorderTrack, WhatEndsThePositionsEndsThemForGood) {
  const auto good = sample_of(0, 10'000'000, 100);
  auto lost = good;
  lost.counter[1].lost = true;
  auto again = good;
  again.ticks = 5;  // it began again: as if the clock had gone round
  auto other = good;
  other.counters = 1;
  for (const auto& bad : {lost, again, other}) {
    RecorderTrack track;
    ASSERT_TRUE(track.take(good));
    const auto refused = track.take(bad);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().kind, kernel::outcome::Kind::unavailable);
    EXPECT_EQ(refused.error().to_do,
              "bring the machine to its reference point and start the layer again");
    const auto after = track.take(good);
    ASSERT_FALSE(after);
    EXPECT_EQ(after.error().what, refused.error().what);
  }
}

}  // namespace
}  // namespace steadyrest::adapters::lines
