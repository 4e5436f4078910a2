// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <string>

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/motion/offline/log/log_record.hpp>

namespace steadyrest::motion::offline {
namespace {

using testing::HasSubstr;

EdgeLog log_of(const std::string& rows) {
  return parse_edge_log("t_s,count\n" + rows, "log.csv").value();
}

Record made(const std::string& rows, const LogRecordConfig& config = {}) {
  return record_of(log_of(rows), config).value();
}

TEST(LogRecord, AnEdgeUpPassesTheCountAndAnEdgeDownTheCountBefore) {
  const Record record = made("0.0001,5\n0.0002,6\n0.0003,5\n0.0004,4\n");
  ASSERT_EQ(record.edges.size(), 3U);
  EXPECT_EQ(record.edges[0].line, 6);  // into cell 6, over its lower line
  EXPECT_EQ(record.edges[0].direction, 1);
  EXPECT_DOUBLE_EQ(record.edges[0].position_mm, 0.006);
  EXPECT_EQ(record.edges[1].line, 6);  // back over the same line
  EXPECT_EQ(record.edges[1].direction, -1);
  EXPECT_EQ(record.edges[2].line, 5);
  EXPECT_EQ(record.edges[2].t_s, 0.0004);
  for (const online::Edge& edge : record.edges) {
    EXPECT_EQ(edge.lost, 0);
  }
}

TEST(LogRecord, LostEdgesLeaveTheLastLineThatWasPassed) {
  const Record record = made("0,5\n0.1,9\n0.2,3\n0.3,2000\n");
  ASSERT_EQ(record.edges.size(), 3U);
  EXPECT_EQ(record.edges[0].line, 9);
  EXPECT_EQ(record.edges[0].lost, 3);
  EXPECT_EQ(record.edges[1].line, 4);
  EXPECT_EQ(record.edges[1].direction, -1);
  EXPECT_EQ(record.edges[1].lost, 5);
  EXPECT_EQ(record.edges[2].lost, 255);
}

TEST(LogRecord, ARowThatKeepsTheCountIsNoEdge) {
  EXPECT_EQ(made("0,5\n0.1,5\n0.2,6\n0.3,6\n").edges.size(), 1U);
}

TEST(LogRecord, TicksStandAtMultiplesOfTheCycleWithTheCountOfTheLastRow) {
  const Record record = made("0.0005,5\n0.0015,6\n0.003,7\n0.0042,8\n");
  ASSERT_EQ(record.ticks.size(), 4U);  // 1, 2, 3 and 4 ms
  const std::int64_t counts[] = {5, 6, 7, 7};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(record.ticks[i].t_s, static_cast<double>(i + 1) / 1000.0);
    EXPECT_EQ(record.ticks[i].count, counts[i]) << i;
    EXPECT_DOUBLE_EQ(record.ticks[i].low_mm, 0.001 * static_cast<double>(counts[i]));
    EXPECT_DOUBLE_EQ(record.ticks[i].high_mm, 0.001 * static_cast<double>(counts[i] + 1));
  }
  EXPECT_EQ(made("0,5\n1.0,6\n").ticks.size(), 1001U);
  EXPECT_TRUE(made("0.0001,5\n0.0002,6\n").ticks.empty());
}

TEST(LogRecord, BringsARecordedSceneBack) {
  const Record scene = record(s_curve(), Recording{});
  std::string rows = fmt::format("0,{}\n", scene.ticks.front().count);
  for (const online::Edge& edge : scene.edges) {
    rows += fmt::format("{:.7f},{}\n", edge.t_s, edge.direction > 0 ? edge.line : edge.line - 1);
  }
  rows += fmt::format("{:.7f},{}\n", scene.ticks.back().t_s, scene.ticks.back().count);
  const Record back = made(rows);
  EXPECT_DOUBLE_EQ(back.how.clock_s, 1e-7);
  ASSERT_EQ(back.edges.size(), scene.edges.size());
  for (std::size_t i = 0; i < back.edges.size(); ++i) {
    ASSERT_NEAR(back.edges[i].t_s, scene.edges[i].t_s, 1e-12);
    ASSERT_EQ(back.edges[i].line, scene.edges[i].line);
    ASSERT_EQ(back.edges[i].direction, scene.edges[i].direction);
  }
  ASSERT_EQ(back.ticks.size(), scene.ticks.size());
  std::size_t other = 0;
  for (std::size_t i = 0; i < back.ticks.size(); ++i) {
    ASSERT_NEAR(back.ticks[i].t_s, scene.ticks[i].t_s, 1e-12);
    other += back.ticks[i].count != scene.ticks[i].count ? 1U : 0U;
  }
  EXPECT_LE(other, 2U);  // an edge within the tick's own period of the clock
}

TEST(LogRecord, TicksComeAsTheyWereLogged) {
  LogRecordConfig config;
  config.input = LogInput::ticks;
  const Record record = made("0.0001,5\n0.0012,9\n0.0019,2\n", config);
  EXPECT_TRUE(record.edges.empty());
  ASSERT_EQ(record.ticks.size(), 3U);
  EXPECT_EQ(record.ticks[1].t_s, 0.0012);
  EXPECT_EQ(record.ticks[2].count, 2);
}

TEST(LogRecord, TakesTheUsersClockOverTheOneFound) {
  LogRecordConfig config;
  EXPECT_DOUBLE_EQ(made("0,5\n0.001,6\n", config).how.clock_s, 1e-3);
  EXPECT_DOUBLE_EQ(made("0,5\n1,6\n", config).how.clock_s, 1e-3);  // not 1 s: the cycle
  config.clock_s = 2e-8;
  EXPECT_EQ(made("0,5\n0.001,6\n", config).how.clock_s, 2e-8);
}

TEST(LogRecord, RefusesWhatNoMachineHas) {
  for (const double bad : {0.0, -1.0, std::nan(""), HUGE_VAL}) {
    LogRecordConfig count;
    count.count_mm = bad;
    EXPECT_FALSE(record_of(log_of("0,5\n1,6\n"), count)) << bad;
    LogRecordConfig cycle;
    cycle.cycle_hz = bad;
    EXPECT_FALSE(record_of(log_of("0,5\n1,6\n"), cycle)) << bad;
  }
  LogRecordConfig clock;
  clock.clock_s = -1.0;
  EXPECT_FALSE(record_of(log_of("0,5\n1,6\n"), clock));
}

TEST(LogRecord, RefusesALogOfYears) {
  const auto record = record_of(log_of("0,5\n8e9,6\n"), {});
  ASSERT_FALSE(record.has_value());
  EXPECT_THAT(record.error().what, HasSubstr("8e+12 control cycles"));
}

}  // namespace
}  // namespace steadyrest::motion::offline
