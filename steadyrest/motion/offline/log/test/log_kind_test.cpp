// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/motion/offline/log/log_record.hpp>

// Logs of known motions: a row for each edge, for the last edge of each cycle, for each cycle.
namespace steadyrest::motion::offline {
namespace {

using testing::HasSubstr;
using Motion = std::function<double(double)>;  ///< t in s to counts

constexpr double kCycle_s = 1e-3;
constexpr int kCycles = 1500;

EdgeLog log_of(const std::vector<LogRow>& rows, int decimals = 7) {
  EdgeLog log;
  log.file = "log.csv";
  log.rows = rows;
  log.decimals = decimals;
  return log;
}

std::int64_t cell(const Motion& x, double t_s) {
  return static_cast<std::int64_t>(std::floor(x(t_s)));
}

EdgeLog ticks(const Motion& x, double jitter_s = 0.0, double from_s = 0.0) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  std::vector<LogRow> rows;
  for (int k = 0; k < kCycles; ++k) {
    const double t_s = from_s + k * kCycle_s + jitter_s * normal(random);
    rows.push_back({t_s, cell(x, t_s)});
  }
  return log_of(rows);
}

/// When the count changes within a cycle, found by looking 2000 times; all edges, or only the last
/// one as a latch shows it.
EdgeLog edges(const Motion& x, bool all, int lose_each = 0) {
  constexpr int kLooks = 2000;
  std::vector<LogRow> rows;
  int seen = 0;
  std::int64_t before = cell(x, 0.0);
  for (int k = 0; k < kCycles / 3; ++k) {
    for (int look = 1; look <= kLooks; ++look) {
      const double t_s = (k + static_cast<double>(look) / kLooks) * kCycle_s;
      if (const std::int64_t now = cell(x, t_s); now != before) {
        before = now;
        if (lose_each > 0 && ++seen % lose_each == 0) {
          continue;
        }
        const bool again = !all && !rows.empty() && rows.back().t_s > k * kCycle_s;
        if (again) {
          rows.back() = {t_s, now};
        } else {
          rows.push_back({t_s, now});
        }
      }
    }
  }
  return log_of(rows);
}

Motion steady(double counts_s) {
  return [counts_s](double t_s) { return counts_s * t_s + 0.3; };
}
Motion sine(double counts, double hz) {
  return [=](double t_s) { return counts * std::sin(2.0 * std::numbers::pi * hz * t_s) + 0.3; };
}

// Steady speed is the hard case: rows are even in time either way. 300 counts/s give rows that
// mostly repeat the count, 33.3e3 counts/s rows that step by 33 or 34.
TEST(LogKind, ARowForEachCycleIsNoLogOfEdges) {
  for (const auto& [name, log] :
       {std::pair{"100 mm/s", ticks(steady(1e5))}, std::pair{"jitter", ticks(steady(1e5), 5e-6)},
        std::pair{"from 12.3456 s", ticks(steady(33.3e3), 0.0, 12.3456)},
        std::pair{"slow", ticks(steady(300.0))},
        std::pair{"slow, jitter", ticks(steady(300.0), 20e-6)},
        std::pair{"1.2 counts", ticks(steady(1200.0))},
        std::pair{"sine", ticks(sine(5000.0, 1.0), 2e-6)},
        std::pair{"standstill", ticks(steady(0.0))}}) {
    const auto fault = other_kind(log, LogInput::edges, 1.0 / kCycle_s);
    ASSERT_TRUE(fault) << name;
    EXPECT_THAT(fault->to_do, HasSubstr("--input ticks")) << name;
    EXPECT_FALSE(other_kind(log, LogInput::ticks, 1.0 / kCycle_s)) << name;
  }
}

// Edges at exactly one per cycle look like ticks and must not be refused.
TEST(LogKind, ARowForEachEdgeIsOne) {
  for (const auto& [name, log] : {std::pair{"even", edges(steady(5000.0), true)},
                                  std::pair{"slow", edges(steady(700.0), true)},
                                  std::pair{"one each cycle", edges(steady(1000.0), true)},
                                  std::pair{"sine", edges(sine(300.0, 4.0), true)},
                                  std::pair{"some lost", edges(steady(5000.0), true, 20)},
                                  std::pair{"latched", edges(sine(5000.0, 2.0), false)},
                                  std::pair{"latched, steady", edges(steady(33.37e3), false)}}) {
    EXPECT_FALSE(other_kind(log, LogInput::edges, 1.0 / kCycle_s)) << name;
  }
}

TEST(LogKind, ARowForEachEdgeIsNoLogOfCycles) {
  for (const auto& [name, log] : {std::pair{"even", edges(steady(5000.0), true)},
                                  std::pair{"sine", edges(sine(300.0, 4.0), true)},
                                  std::pair{"some lost", edges(steady(5000.0), true, 20)}}) {
    const auto fault = other_kind(log, LogInput::ticks, 1.0 / kCycle_s);
    ASSERT_TRUE(fault) << name;
    EXPECT_THAT(fault->to_do, HasSubstr("--input edges")) << name;
  }
}

TEST(LogKind, AFewRowsDoNotTell) {
  std::vector<LogRow> rows;
  rows.reserve(12);
  for (int k = 0; k < 12; ++k) {
    rows.push_back({k * kCycle_s, 5});
  }
  EXPECT_FALSE(other_kind(log_of(rows), LogInput::edges, 1000.0));
}

// 77058.1 s at 1 kHz would be 77 million cycles from 350 rows.
TEST(LogKind, OneWrongStampMakesNoEndlessRecord) {
  // In the middle: the row itself is wrong. At the end: the cycles are more than the rows warrant.
  std::string text = "t_s,count\n";
  for (int k = 0; k < 350; ++k) {
    text += fmt::format("{:.7f},{}\n", k == 65 ? 77058.1 : 0.002 * k + 1e-5 * (k % 7), k);
  }
  const auto log = parse_edge_log(text, "log.csv");
  ASSERT_TRUE(log);
  EXPECT_TRUE(log->stopped);
  EXPECT_EQ(log->findings.back().line, 67U);
  EXPECT_THAT(log->findings.back().what, HasSubstr("t_s = 77058.1 leaps ahead"));
  ASSERT_EQ(log->rows.size(), 65U);
  const auto record = record_of(*log, {});
  ASSERT_TRUE(record);
  EXPECT_LT(record->ticks.size(), 200U);

  const auto late = parse_edge_log(text.substr(0, text.find("77058")) + "77058.1,65\n", "log.csv");
  ASSERT_TRUE(late);
  const auto endless = record_of(*late, {});
  ASSERT_FALSE(endless);
  EXPECT_EQ(endless.error().line, 67U);
  EXPECT_THAT(endless.error().what, HasSubstr("66 rows span 77058.1 s"));
}

}  // namespace
}  // namespace steadyrest::motion::offline
