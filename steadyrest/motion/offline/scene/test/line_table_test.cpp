// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/kernel/rt/testing/allocation_guard.hpp>
#include <steadyrest/motion/offline/scene/test/learnt_lines.hpp>
#include <steadyrest/motion/offline/test/scenes.hpp>
#include <steadyrest/motion/online/bounded/motion_estimator.hpp>
#include <steadyrest/motion/online/line/line_table.hpp>
#include <steadyrest/motion/online/line/stored_lines.hpp>

namespace steadyrest::motion::offline::test {
namespace {

using online::LineTable;
using online::MotionEstimator;

/// RMS over lines from … to of table − truth, in counts, without the common part.
double table_error(const LineTable& table, const Record& record, int from = 100, int to = 600) {
  double sum = 0.0;
  double sum2 = 0.0;
  for (int line = from; line <= to; ++line) {
    const double truth =
        line + record.line_error_mm[static_cast<std::size_t>(line - record.first_line)] / 0.001;
    const double off = table.position_mm(line) / 0.001 - truth;
    sum += off;
    sum2 += off * off;
  }
  const double n = to - from + 1;
  return std::sqrt(sum2 / n - sum * sum / n / n);
}

// 5 % phase and 2 % random are 0.04 counts RMS at the start; one pass leaves an eighth.
TEST(LineTable, LearnsTheLinesOfASineInOnePass) {
  LineTable table = table_of(-10, 2100);
  EXPECT_GT(table_error(table, long_sine()), 0.03);
  learn(table, long_sine(), 1);
  EXPECT_LT(table_error(table, long_sine()), 0.005);
  learn(table, long_sine(), 3);
  EXPECT_LT(table_error(table, long_sine()), 0.0038);
}

// The fits err alike on each pass; a table that only adds up would grow without end.
TEST(LineTable, DoesNotDriftOverHundredsOfPasses) {
  LineTable table = table_of(-10, 2100);
  learn(table, long_sine(), 30);
  const double early = table_error(table, long_sine(), 5, 1990);
  learn(table, long_sine(), 120);
  EXPECT_LT(table_error(table, long_sine(), 5, 1990), 1.02 * early);
  EXPECT_LT(table_error(table, long_sine()), 0.005);
}

// The ripple repeats with time, not with the revolution, so it must average out. Newton steps find
// when each true line is passed.
TEST(LineTable, DoesNotDriftOnARotaryAxis) {
  // 1000 counts per revolution, 20 counts/ms with a ripple of ±1.5 %.
  std::vector<double> error(1000);
  for (std::size_t i = 0; i < error.size(); ++i) {
    error[i] = long_sine().line_error_mm[i + 20];
  }
  const double mean = std::accumulate(error.begin(), error.end(), 0.0) / 1000.0;
  LineTable table = table_of(0, 1000, true);
  const auto turn_for = [&](int revolutions) {
    for (int line = 0; line < 1000 * revolutions; ++line) {
      const double x = line * 0.001 + error[static_cast<std::size_t>(line % 1000)] - mean;
      double t = x / 20.0;
      for (int i = 0; i < 10; ++i) {
        t -= (20.0 * t + 0.05 * std::sin(6.0 * t) - x) / (20.0 + 0.3 * std::cos(6.0 * t));
      }
      table.learn(std::floor(t * 1e7) * 1e-7, line, 1, line == 0);
    }
  };
  const auto off = [&] {
    double sum = 0.0;
    double sum2 = 0.0;
    for (int line = 0; line < 1000; ++line) {
      const double d =
          (table.position_mm(line) - error[static_cast<std::size_t>(line)]) / 0.001 - line;
      sum += d;
      sum2 += d * d;
    }
    return std::sqrt(sum2 / 1000.0 - sum * sum / 1e6);
  };
  turn_for(20);
  EXPECT_LT(off(), 0.004);
  const double early = off();
  for (int i = 0; i < 10; ++i) {
    turn_for(100);
  }
  EXPECT_LT(off(), early);
  EXPECT_NEAR(table.position_mm(5) - 0.005, table.position_mm(-995) + 0.995, 1e-15);
}

// The truth is the mean of the lines drawn, so the random part's mean counts too.
TEST(LineTable, PhasesSumToZeroAndAreThoseOfTheEncoder) {
  LineTable table = table_of(-10, 2100);
  learn(table, long_sine(), 8);
  table.settle();
  const auto& phase = table.phase_mm();
  EXPECT_NEAR(phase[0] + phase[1] + phase[2] + phase[3], 0.0, 1e-15);
  // The means of the drawn errors, not the pattern alone: each phase has 500 lines of ±0.02.
  std::array<double, 4> truth{};
  for (int line = 0; line < 2000; ++line) {
    truth[static_cast<std::size_t>(line & 3)] +=
        long_sine().line_error_mm[static_cast<std::size_t>(line - long_sine().first_line)] / 500.0;
  }
  const double common = 0.25 * (truth[0] + truth[1] + truth[2] + truth[3]);
  for (std::size_t p = 0; p < 4; ++p) {
    EXPECT_NEAR(phase[p], truth[p] - common, 0.0005 * 0.001) << p;
  }
}

// Moving error from the lines to the phases must leave each line where it was.
TEST(LineTable, SettlingChangesNoLineThatWasLearntButByWhatAllHaveInCommon) {
  LineTable table = table_of(-10, 2100);
  learn(table, long_sine(), 2);
  const LineTable before = table;
  table.settle();
  const double shift = table.position_mm(1000) - before.position_mm(1000);
  for (int line = 100; line < 1900; ++line) {
    EXPECT_NEAR(table.position_mm(line) - before.position_mm(line), shift, 1e-12) << line;
  }
}

// A line never passed has a larger error than a learnt one, and its σ shows it.
TEST(LineTable, LinesThatWereNeverPassedHaveThePhaseAlone) {
  LineTable table = table_of(-10, 4000);
  learn(table, long_sine(), 4);
  for (int line = 2500; line < 2504; ++line) {
    EXPECT_FALSE(table.learnt(line));
    EXPECT_DOUBLE_EQ(table.position_mm(line),
                     line * 0.001 + table.phase_mm()[static_cast<std::size_t>(line & 3)]);
    EXPECT_GT(table.sigma_mm(line), 3.0 * table.sigma_mm(1000));
  }
  EXPECT_DOUBLE_EQ(table.position_mm(-5000), -5.0 + table.phase_mm()[0]);  // outside of the table
  LineTable restored = table_of(-10, 4000);
  restored.restore(table.phase_mm(), table.error_mm());
  EXPECT_TRUE(restored.learnt(1000));
  EXPECT_FALSE(restored.learnt(2500));
  EXPECT_GT(restored.sigma_mm(2500), 3.0 * restored.sigma_mm(1000));
  EXPECT_DOUBLE_EQ(restored.position_mm(1000), table.position_mm(1000));
}

// 0 in the file means "not learnt": a line learnt to be exact is stored as a hundred-thousandth of
// a count.
TEST(LineTable, ALineThatIsLearntToStandRightIsNotStoredAsUnknown) {
  LineTable table = table_of(0, 4);
  table.restore({}, std::vector<double>{2e-5, 1e-12, 0.0, -2e-5});
  kernel::machine::Encoder encoder;
  online::store_lines(table, encoder);
  EXPECT_EQ(encoder.line_table_au, (std::vector<double>{2e-5, 1e-8, 0.0, -2e-5}));
}

// A lost edge breaks the window; a table that fitted across it would learn a step.
TEST(LineTable, LearnsThroughLostEdges) {
  Recording how = line_errors();
  how.lost_share = 0.01;
  const Record record = offline::record(sine(1.0, 2.0, 8.0), how);
  LineTable table = table_of(-10, 2100);
  learn(table, record, 2);
  EXPECT_LT(table_error(table, record), 0.007);
}

TEST(LineTable, DoesNotAllocateWhileItLearns) {
  LineTable table = table_of(-10, 2100);
  const Record& record = sine_line_errors();
  const kernel::rt::testing::AllocationGuard guard;
  learn(table, record, 1);
  table.settle();
}

// 1002 is not a multiple of four: the phases would not close around the revolution.
TEST(LineTable, RefusesWhatCannotWork) {
  EXPECT_FALSE(LineTable::make({.count_mm = 0.0}).has_value());
  EXPECT_FALSE(LineTable::make({.lines = LineTable::kMaxLines + 1}).has_value());
  EXPECT_FALSE(LineTable::make({.lines = 1002, .periodic = true}).has_value());
  EXPECT_FALSE(LineTable::make({.lines = 0, .periodic = true}).has_value());
  EXPECT_FALSE(LineTable::make({.learn = 1.5}).has_value());
  EXPECT_FALSE(LineTable::make({.max_span_s = 0.0}).has_value());
  EXPECT_TRUE(LineTable::make({}).has_value());
}

/// What a control does: the table learns from every edge before the estimator takes it.
TEST(LineTable, LearnsWhileTheEstimatorRuns) {
  const Record& record = long_sine();
  LineTable table = table_of(-10, 2100);
  MotionEstimator estimator = MotionEstimator::make({}).value();
  std::vector<Estimate> estimates;
  auto edge = record.edges.begin();
  for (Tick tick : record.ticks) {
    for (; edge != record.edges.end() && edge->t_s <= tick.t_s; ++edge) {
      Edge taken = *edge;
      table.learn(taken.t_s, taken.line, taken.direction, taken.lost != 0);
      taken.position_mm = table.position_mm(taken.line);
      taken.sigma_mm = table.sigma_mm(taken.line);
      estimator.edge(taken);
    }
    tick.low_mm = table.position_mm(tick.count);
    tick.high_mm = table.position_mm(tick.count + 1);
    estimates.push_back(estimator.tick(tick));
  }
  Record start = record;
  start.ticks.resize(1001);
  start.truth.resize(1001);
  const Score first = score({estimates.begin(), estimates.begin() + 1001}, start, 0.0, 0.02);
  const Score last = score(estimates, record, 0.0, 7.0);
  EXPECT_LT(last.velocity_rms_mm_s, 0.5 * first.velocity_rms_mm_s);
  EXPECT_LT(last.acceleration_rms_mm_s2, 0.5 * first.acceleration_rms_mm_s2);
}

}  // namespace
}  // namespace steadyrest::motion::offline::test
