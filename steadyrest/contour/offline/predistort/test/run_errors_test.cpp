// SPDX-License-Identifier: Apache-2.0
// Runs of blocks that are kept or given up together, and the error of each over all models.
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/contour/offline/predistort/run_errors.hpp>

namespace steadyrest::contour::offline {
namespace {

struct RunBlock {
  std::uint32_t line = 0;
  bool free = true;
  bool stops = false;
};

/// Each block is 1 mm long.
nc::plan::PlannedPath path_of(const std::vector<RunBlock>& blocks) {
  nc::plan::PlannedPath path;
  for (const RunBlock& block : blocks) {
    auto& segment = path.segments.emplace_back();
    segment.line = block.line;
    segment.position_mm = static_cast<double>(path.segments.size() - 1);
    segment.length_mm = 1.0;
  }
  return path;
}

CutRuns runs_of(const std::vector<RunBlock>& blocks) {
  std::vector<SegmentUse> use;
  use.reserve(blocks.size());
  for (const RunBlock& block : blocks) {
    use.push_back({.free = block.free, .stops = block.stops});
  }
  return {path_of(blocks), use};
}

using RunLines = std::vector<std::uint32_t>;

TEST(CutRuns, EndAtStopsAndAtBlocksThatStay) {
  const CutRuns runs = runs_of({{.line = 1},
                                {.line = 2, .stops = true},
                                {.line = 3},
                                {.line = 4, .free = false},
                                {.line = 5, .free = false},
                                {.line = 6},
                                {.line = 7}});
  ASSERT_EQ(runs.size(), 3U);
  EXPECT_EQ(runs.lines(0), (RunLines{1, 2}));
  EXPECT_EQ(runs.lines(1), (RunLines{3}));
  EXPECT_EQ(runs.lines(2), (RunLines{6, 7}));
  EXPECT_EQ(runs.of(3), 1U);
  EXPECT_EQ(runs.of(7), 2U);
  for (const std::uint32_t of_none : {0U, 4U, 5U, 8U}) {
    EXPECT_EQ(runs.of(of_none), runs.size()) << of_none;
  }
}

// A block is one line, however many segments the control makes of it.
TEST(CutRuns, NameALineOnce) {
  const CutRuns runs = runs_of({{.line = 3}, {.line = 3}, {.line = 4}, {.line = 4}});
  ASSERT_EQ(runs.size(), 1U);
  EXPECT_EQ(runs.lines(0), (RunLines{3, 4}));
}

constexpr Guard kGuard = Guard::by_worst;

constexpr std::array<OtherError, 2> both(double first_mm, double second_mm) {
  return {{{first_mm, first_mm}, {second_mm, second_mm}}};
}

ModelSample run_sample(double error_mm, const std::array<OtherError, 2>& others) {
  ModelSample sample;
  sample.error_mm = error_mm;
  sample.others = others;
  return sample;
}

// The model has 3 and 4 µm (RMS √12.5), the first other 1 and 1, the second 0 and 4.5 (RMS
// √10.125).
TEST(RunErrors, AreThoseOfTheWorstModel) {
  const std::vector<RunBlock> blocks = {{.line = 1}, {.line = 2, .free = false}, {.line = 3}};
  const auto path = path_of(blocks);
  const CutRuns runs = runs_of(blocks);
  RunErrors errors(runs, 2, {});
  constexpr auto kFirst = both(0.001, 0.0);
  constexpr auto kSecond = both(0.001, 0.0045);
  errors.add(run_sample(-0.003, kFirst), 1, path.segments);
  ModelSample of_none = run_sample(0.900, kSecond);
  of_none.foot_mm = 1.5;
  errors.add(of_none, 2, path.segments);
  errors.add(run_sample(0.004, kSecond), 1, path.segments);
  EXPECT_NEAR(errors.worst(0).rms_mm, 0.001 * std::sqrt(12.5), 1e-12);
  EXPECT_DOUBLE_EQ(errors.worst(0).max_mm, 0.0045);
  EXPECT_EQ(errors.worst(1).rms_mm, 0.0) << "no sample yet";
  errors.add(run_sample(0.002, kSecond), 3, path.segments);
  EXPECT_DOUBLE_EQ(errors.worst(1).max_mm, 0.0045);
  EXPECT_DOUBLE_EQ(errors.worst(1).rms_mm, 0.0045);
  EXPECT_DOUBLE_EQ(errors.worst(0).max_mm, 0.0045);
}

// The command is in the block that stays, the tool still in the run before.
TEST(RunErrors, AreTheRunsThatTheToolIsIn) {
  const std::vector<RunBlock> blocks = {{.line = 1}, {.line = 2, .free = false}, {.line = 3}};
  const auto path = path_of(blocks);
  const CutRuns runs = runs_of(blocks);
  RunErrors errors(runs, 2, {});
  constexpr auto kOthers = both(0.0, 0.0);
  ModelSample sample = run_sample(0.007, kOthers);
  sample.foot_mm = 0.8;
  errors.add(sample, 2, path.segments);
  EXPECT_DOUBLE_EQ(errors.worst(0).max_mm, 0.007);
}

// Behind a rapid: the lag is the run's before, its size over time that of the run that it is in.
TEST(RunErrors, BehindAPauseAreTheLargestOfTheRunBefore) {
  const std::vector<RunBlock> blocks = {{.line = 1}, {.line = 2, .free = false}, {.line = 3}};
  const auto path = path_of(blocks);
  const CutRuns runs = runs_of(blocks);
  RunErrors errors(runs, 2, {.lasts_s = 0.1});
  constexpr auto kOthers = both(0.0, 0.0);
  const auto add = [&](double time_s, double error_mm, std::uint32_t line) {
    ModelSample sample = run_sample(error_mm, kOthers);
    sample.time_s = time_s;
    errors.add(sample, line, path.segments);
    return errors.early();
  };
  add(0.0, 0.001, 1);
  for (double t = 0.01; t < 0.2; t += 0.01) {
    add(t, 0.003, 1);
  }
  EXPECT_TRUE(add(0.5, 0.008, 3));
  EXPECT_TRUE(add(0.51, 0.006, 3));
  EXPECT_DOUBLE_EQ(errors.worst(0).max_mm, 0.008);
  EXPECT_DOUBLE_EQ(errors.worst(1).max_mm, 0.0);
  EXPECT_NEAR(errors.worst(1).rms_mm, 0.001 * std::sqrt(50.0), 1e-12);
  for (double t = 0.52; t < 0.61; t += 0.01) {
    add(t, 0.0, 3);
  }
  EXPECT_FALSE(add(0.61, 0.004, 3));
  EXPECT_DOUBLE_EQ(errors.worst(1).max_mm, 0.004);
}

// 4 % more of a small error are nothing; of the program's largest they are.
TEST(WorseRuns, AreThoseBeyondTheLargestOfTheProgram) {
  const std::vector<RunBlock> blocks = {{.line = 1}, {.line = 2, .free = false}, {.line = 3}};
  const auto path = path_of(blocks);
  const CutRuns runs = runs_of(blocks);
  constexpr auto kOthers = both(0.0, 0.0);
  RunErrors before(runs, 2, {});
  RunErrors after(runs, 2, {});
  for (const double more : {1.0, 0.1}) {
    // The RMS falls.
    before.add(run_sample(0.3 * more, kOthers), more == 1.0 ? 1 : 3, path.segments);
    before.add(run_sample(0.3 * more, kOthers), more == 1.0 ? 1 : 3, path.segments);
    after.add(run_sample(1.04 * 0.3 * more, kOthers), more == 1.0 ? 1 : 3, path.segments);
    after.add(run_sample(0.0, kOthers), more == 1.0 ? 1 : 3, path.segments);
  }
  EXPECT_EQ(worse_runs(runs, before, after, {}, kGuard), (std::vector<std::size_t>{0}));
}

// The run that stays has what its neighbour's lag brings.
TEST(WorseRuns, AreThoseThatAreChanged) {
  const std::vector<RunBlock> blocks = {{.line = 1}, {.line = 2, .free = false}, {.line = 3}};
  const auto path = path_of(blocks);
  const CutRuns runs = runs_of(blocks);
  constexpr auto kOthers = both(0.0, 0.0);
  RunErrors before(runs, 2, {});
  RunErrors after(runs, 2, {});
  before.add(run_sample(0.3, kOthers), 1, path.segments);
  before.add(run_sample(0.1, kOthers), 3, path.segments);
  after.add(run_sample(0.2, kOthers), 1, path.segments);
  after.add(run_sample(0.15, kOthers), 3, path.segments);
  EXPECT_EQ(worse_runs(runs, before, after, {}, kGuard), (std::vector<std::size_t>{1}));
  EXPECT_TRUE(worse_runs(runs, before, after, {3}, kGuard).empty());
}

// One machine gains more than another loses: the worst of both falls, and yet the other's part is
// worse.
TEST(WorseRuns, AreJudgedByEachModelAgainstItself) {
  const std::vector<RunBlock> blocks = {{.line = 1}};
  const auto path = path_of(blocks);
  const CutRuns runs = runs_of(blocks);
  RunErrors before(runs, 2, {});
  RunErrors after(runs, 2, {});
  constexpr auto kBefore = both(0.1, 0.02);
  constexpr auto kAfter = both(0.01, 0.03);
  before.add(run_sample(0.05, kBefore), 1, path.segments);
  after.add(run_sample(0.01, kAfter), 1, path.segments);
  EXPECT_EQ(worse_runs(runs, before, after, {}, Guard::by_each), (std::vector<std::size_t>{0}));
  EXPECT_TRUE(worse_runs(runs, before, after, {}, Guard::by_worst).empty());
  constexpr auto kBetter = both(0.01, 0.02);
  RunErrors better(runs, 2, {});
  better.add(run_sample(0.01, kBetter), 1, path.segments);
  EXPECT_TRUE(worse_runs(runs, before, better, {}, Guard::by_each).empty());
}

// Led beyond its stop, the first run costs 14 µm at its end and takes 200 off the next. A
// block between them that stays keeps them apart.
TEST(WorseRuns, AStopBelongsToBothRuns) {
  for (const bool joined : {true, false}) {
    const std::vector<RunBlock> blocks = {
        {.line = 1, .stops = joined}, {.line = 2, .free = joined}, {.line = 3}};
    const auto path = path_of(blocks);
    const CutRuns runs = runs_of(blocks);
    ASSERT_EQ(runs.size(), 2U);
    EXPECT_EQ(runs.is_joined(1), joined);
    RunErrors before(runs, 2, {});
    RunErrors after(runs, 2, {});
    before.add(run_sample(0.002, both(0.002, 0.002)), 1, path.segments);
    before.add(run_sample(0.015, both(0.015, 0.015)), 1, path.segments);
    after.add(run_sample(0.002, both(0.002, 0.002)), 1, path.segments);
    after.add(run_sample(0.015, {{{.error_mm = 0.014, .peak_mm = 0.018}, {0.0, 0.0}}}), 1,
              path.segments);
    before.add(run_sample(0.2, both(0.2, 0.2)), 3, path.segments);
    after.add(run_sample(0.01, both(0.01, 0.01)), 3, path.segments);
    EXPECT_EQ(worse_runs(runs, before, after, {}, kGuard).empty(), joined);
  }
}

// The second machine's error is nearly none: whatever helps the others by more than twice that
// harms it.
TEST(RunErrors, BoundWhatCanBeWonOnAllModels) {
  const std::vector<RunBlock> blocks = {{.line = 1}};
  const auto path = path_of(blocks);
  const CutRuns runs = runs_of(blocks);
  RunErrors errors(runs, 2, {});
  constexpr auto kOthers = both(0.1, 0.001);
  errors.add(run_sample(0.05, kOthers), 1, path.segments);
  EXPECT_NEAR(errors.could_win_mm(0), 0.002 + 0.0005, 1e-12);
}

}  // namespace
}  // namespace steadyrest::contour::offline
