// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <sstream>
#include <string>
#include <vector>

#include "estimate_rows.hpp"
#include "program.hpp"
#include "scratch.hpp"
#include <fmt/core.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <steadyrest/kernel/file/testing/recorded.hpp>

namespace steadyrest::test {
namespace {

using nlohmann::json;

/// The recorded servo axis: five logs that may be absent, and two excerpts.
class RecordedAxis : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    using namespace kernel::file::testing;
    const auto whole = shared_data() / "encoder" / fmt::format("{}.csv.gz", GetParam());
    const std::string packed = std::filesystem::exists(whole) ? whole : excerpt(GetParam());
    if (!std::filesystem::exists(packed)) {
      GTEST_SKIP() << packed << " is absent";
    }
    log_ = scratch_.at("log.csv");
    ASSERT_EQ(std::system(fmt::format("zcat '{}' > '{}'", packed, log_).c_str()), 0);
    std::istringstream in(text_of_file(log_));
    std::string line;
    std::getline(in, line);
    double t_s = 0.0;
    char comma = ' ';
    long count = 0;
    while (in >> t_s >> comma >> count) {
      t_s_.push_back(t_s);
      counts_.push_back(count);
    }
    ASSERT_GE(t_s_.size(), 2000U);
  }

  Scratch scratch_;
  std::string log_;
  std::vector<double> t_s_;
  std::vector<long> counts_;
};

TEST_P(RecordedAxis, TicksComeBackRowByRowAsDifferences) {
  const Finished finished =
      run_line("motion estimate " + log_ + kTicks + " --estimator difference");
  ASSERT_EQ(finished.code, 0) << finished.err;
  const std::vector<Row> rows = estimated_rows(finished.out);
  ASSERT_EQ(rows.size(), counts_.size());
  for (std::size_t i = 1; i < rows.size(); ++i) {
    ASSERT_NEAR(rows[i][0], t_s_[i], 1e-9);
    ASSERT_NEAR(rows[i][2], static_cast<double>(counts_[i] - counts_[i - 1]), 1e-6) << i;
  }
}

TEST_P(RecordedAxis, TheJitterOfItsCycleIsTold) {
  const Finished finished = run_line("motion estimate " + log_ + kTicks + " --json");
  ASSERT_EQ(finished.code, 0) << finished.err;
  const json cycle = json::parse(finished.out)["cycle"];
  double longest_s = 0.0;
  for (std::size_t i = 1; i < t_s_.size(); ++i) {
    longest_s = std::max(longest_s, t_s_[i] - t_s_[i - 1]);
  }
  EXPECT_NEAR(cycle["mean_s"], 1e-3, 1e-6);
  EXPECT_GT(cycle["jitter_rms_s"], 0.5e-6);
  EXPECT_LT(cycle["jitter_rms_s"], 20e-6);
  // One of the logs has a gap of six seconds.
  EXPECT_EQ(cycle["gaps"], longest_s > 0.011 ? 1 : 0);
  EXPECT_NEAR(longest_s > 0.011 ? cycle["longest_gap_s"] : cycle["longest_s"], longest_s, 1e-9);
}

TEST_P(RecordedAxis, CoarseEdgesKeepThePositionWithinTheirCount) {
  // Counts ÷ 64, edges in the straight line between two samples: a coarse encoder on a real motion.
  // The position must lie within a coarse count of the recorded one.
  constexpr long kCoarse = 64;
  const auto cell = [](long count) {
    return count >= 0 ? count / kCoarse : -((-count + kCoarse - 1) / kCoarse);
  };
  std::string text = fmt::format("t_s,count\n{:.9f},{}\n", t_s_[0], cell(counts_[0]));
  std::size_t edges = 0;
  for (std::size_t i = 1; i < counts_.size(); ++i) {
    const double per_count_s =
        (t_s_[i] - t_s_[i - 1]) /
        static_cast<double>(std::max(1L, std::abs(counts_[i] - counts_[i - 1])));
    for (long at = cell(counts_[i - 1]); at != cell(counts_[i]); ++edges) {
      const bool up = at < cell(counts_[i]);
      const long line = (up ? at + 1 : at) * kCoarse;
      at += up ? 1 : -1;
      text += fmt::format(
          "{:.9f},{}\n",
          t_s_[i - 1] + per_count_s * static_cast<double>(std::abs(line - counts_[i - 1])), at);
    }
  }
  text += fmt::format("{:.9f},{}\n", t_s_.back(), cell(counts_.back()));
  const std::string log = scratch_.file("edges.csv", text);
  const std::string out = scratch_.at("out.csv");
  const Finished finished = run_line("motion estimate " + log +
                                     " --input edges --count-mm 0.064 --cycle-hz 1000 "
                                     "--estimator mt --json -o " +
                                     out);
  ASSERT_EQ(finished.code, 0) << finished.err;
  EXPECT_EQ(json::parse(finished.out)["edges"], edges);
  const std::vector<Row> rows = estimated_rows(text_of_file(out));
  EXPECT_EQ(rows.size(), static_cast<std::size_t>(std::floor(t_s_.back() * 1000.0)) + 1);
  std::size_t at = 0;
  for (const Row& row : rows) {
    while (at + 2 < t_s_.size() && t_s_[at + 1] < row[0]) {
      ++at;
    }
    const double low = 0.001 * static_cast<double>(std::min(counts_[at], counts_[at + 1]));
    const double high = 0.001 * static_cast<double>(std::max(counts_[at], counts_[at + 1]));
    ASSERT_GE(row[1], low - 0.0641) << row[0];
    ASSERT_LE(row[1], high + 0.0641) << row[0];
  }
}

INSTANTIATE_TEST_SUITE_P(MotionEstimate, RecordedAxis,
                         testing::Values("k0m0.06", "k12m", "k3m0.07", "k50m", "torque_oscillation",
                                         "servo-gap", "servo-slow"),
                         [](const auto& param) {
                           std::string name = param.param;
                           std::ranges::replace_if(
                               name, [](char c) { return c == '.' || c == '-'; }, '_');
                           return name;
                         });

}  // namespace
}  // namespace steadyrest::test
