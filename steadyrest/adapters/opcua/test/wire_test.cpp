// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdint>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include <steadyrest/adapters/opcua/node_plan.hpp>
#include <steadyrest/adapters/opcua/wire.hpp>

namespace steadyrest::adapters::opcua {
namespace {

using kernel::machine::OpcUa;
using kernel::machine::Quantity;

const std::string kRead =
    R"({"id":7,"ok":true,"values":[[1,2.5,null],"CIRCLE.MPF",3],"status":[0,0,2150891520],"time_ms":[1000,2000,3000],"sent_ms":5})";

TEST(Wire, AReadingIsTakenWithWhatIsNotKnown) {
  const auto answer = decode_line(kRead);
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->id, 7U);
  ASSERT_EQ(answer->values.size(), 3U);
  EXPECT_EQ(answer->values[0].numbers[1], 2.5);
  EXPECT_TRUE(std::isnan(answer->values[0].numbers[2]));
  EXPECT_EQ(answer->values[1].text, "CIRCLE.MPF");
  EXPECT_EQ(answer->values[2].status, 2150891520U);
  EXPECT_EQ(answer->values[0].time_s, 1.0);
}

TEST(Wire, WhatIsNoAnswerIsNone) {
  for (const std::string line :
       {"", "{", "[]", "null", "7", R"({"id":1})", R"({"id":-1,"ok":true})",
        R"({"id":1.5,"ok":true})", R"({"event":"hello"})", R"({"event":"state","state":"half"})",
        R"({"id":1,"ok":1})", R"({"id":1,"ok":true,"values":[1],"status":[0,0],"time_ms":[1]})",
        R"({"id":1,"ok":true,"values":[1],"status":[-1],"time_ms":[1]})",
        R"({"id":1,"ok":true,"values":7,"status":[],"time_ms":[]})",
        R"({"id":1,"ok":true,"nodes":[7]})", R"({"id":1,"ok":true,"status":["Good"]})"}) {
    EXPECT_FALSE(decode_line(line)) << line;
  }
  EXPECT_FALSE(decode_line(std::string(kMaxLine + 1, ' ') + kRead)) << "too long";
}

TEST(Wire, RequestsAreSingleLines) {
  Configure configure;
  configure.endpoint = "opc.tcp://a\n:1";
  configure.user = "a\"b";
  configure.reads = {"s=\xff"};
  for (const std::string& line :
       {configure_line(1, configure), write_line(2, {{1.0, 2.0}, {3.0}}, {true, false}),
        trust_line(3, "ab\n"), plain_line(4, "read")}) {
    EXPECT_EQ(line.find('\n'), line.size() - 1) << line;
  }
  EXPECT_EQ(write_line(2, {{1.0, 2.0}, {3.0}}, {true, false}),
            "{\"do\":\"write\",\"id\":2,\"values\":[[1.0,2.0],3.0]}\n");
}

OpcUa small_mapping() {
  OpcUa out;
  out.reads = {
      {.quantity = Quantity::time_s,
       .node = "s=A",
       .index = 1,
       .length = 3,
       .scale = 2.0,
       .offset = 1.0},
      {.quantity = Quantity::command_mm, .axis = 1, .node = "s=A", .index = 2, .length = 3},
      {.quantity = Quantity::program_name, .node = "s=N"},
      {.quantity = Quantity::coolant, .node = "s=C"}};
  out.writes = {
      {.quantity = Quantity::heartbeat, .node = "s=O", .index = 0, .length = 3},
      {.quantity = Quantity::feed_percent, .node = "s=O", .index = 1, .length = 3, .scale = 0.5},
      {.quantity = Quantity::heartbeat_copy, .node = "s=O", .index = 2, .length = 3}};
  return out;
}

TEST(NodePlan, EachNodeIsReadOnceAndBadValuesAreNotKnown) {
  const NodePlan plan(small_mapping());
  ASSERT_EQ(plan.reads().size(), 3U);
  const auto reading = plan.decode(*decode_line(kRead)).value();
  EXPECT_EQ(reading[Quantity::time_s], 6.0);
  EXPECT_TRUE(std::isnan(reading(Quantity::command_mm, 1)));
  EXPECT_TRUE(std::isnan(reading[Quantity::coolant])) << "a bad status";
  EXPECT_STREQ(reading.program.data(), "CIRCLE.MPF");
}

TEST(NodePlan, AnOrderIsEncodedWithItsNumberFirstAndLast) {
  const NodePlan plan(small_mapping());
  const auto values = plan.encode({.heartbeat = 9, .masks_feed = true, .feed_percent = 40.0});
  ASSERT_EQ(values.size(), 1U);
  EXPECT_EQ(values[0], (std::vector<double>{9.0, 80.0, 9.0}));
}

/// Turned up by hand for a hunt; a million takes some seconds.
constexpr int kHostile = 1000000;

TEST(Wire, AMillionHostileLinesHarmNothing) {
  const NodePlan plan(small_mapping());
  std::mt19937_64 random(1);
  const std::string pieces[] = {"null",
                                "1e999",
                                "-1",
                                "[",
                                "]",
                                "{",
                                "}",
                                ",",
                                "\"",
                                "\\u0000",
                                "NaN",
                                "true",
                                "18446744073709551616",
                                "\xff\xfe",
                                "[[[[[[[[[["};
  std::size_t taken = 0;
  for (int i = 0; i < kHostile; ++i) {
    std::string line = kRead;
    const auto changes = 1 + random() % 3;
    for (std::uint64_t c = 0; c < changes && !line.empty(); ++c) {
      const std::size_t at = random() % line.size();
      switch (random() % 4) {
        case 0:
          line[at] = static_cast<char>(random());
          break;
        case 1:
          line.erase(at, 1 + random() % 8);
          break;
        case 2:
          line.insert(at, pieces[random() % std::size(pieces)]);
          break;
        default:
          line.resize(at + 1);
      }
    }
    const auto answer = decode_line(line);
    if (!answer) {
      continue;
    }
    ++taken;
    ASSERT_LE(answer->values.size(), kMaxNodes);
    const auto reading = plan.decode(*answer);
    // What is taken has the shape of the mapping; its numbers may be anything a control could show.
    ASSERT_EQ(reading.has_value(), answer->values.size() == 3);
  }
  EXPECT_GT(taken, kHostile / 100) << "some must come through, or nothing was tried";
}

}  // namespace
}  // namespace steadyrest::adapters::opcua
