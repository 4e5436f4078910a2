// SPDX-License-Identifier: Apache-2.0
#include <cstdlib>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/kernel/file/testing/own_folder.hpp>
#include <steadyrest/motion/offline/log/estimate_table.hpp>

namespace steadyrest::motion::offline {
namespace {

using online::Estimate;
using testing::StartsWith;

/// The lines written for these estimates, with the head as the first.
std::vector<std::string> table_lines(const std::vector<Estimate>& estimates) {
  const kernel::file::testing::OwnFolder folder;
  auto file = kernel::file::OutputFile::open(folder.at("out.csv")).value();
  EstimateTable table(file);
  for (const Estimate& estimate : estimates) {
    table.put(estimate);
  }
  table.finish();
  EXPECT_TRUE(file.commit().has_value());
  std::istringstream text(kernel::file::testing::text_of_file(folder.at("out.csv")));
  std::vector<std::string> lines;
  for (std::string line; std::getline(text, line);) {
    lines.push_back(line);
  }
  return lines;
}

TEST(EstimateTable, HasTheColumnsThatScriptsReadAndInfWhereThereIsNoBound) {
  const auto lines = table_lines({{0.25, 1.5, -2.0, 1e-9, 0.0, 7.0, online::kNoBound}});
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_EQ(lines[0],
            "t_s,position_mm,velocity_mm_s,acceleration_mm_s2,velocity_bound_mm_s,"
            "acceleration_bound_mm_s2");
  EXPECT_EQ(lines[1], "0.250000000,1.5,-2,1e-09,7,inf");
}

TEST(EstimateTable, TimesHaveNineDecimalsOnBothSidesOfZero) {
  Estimate e;
  std::vector<Estimate> at;
  for (const double t_s : {0.0, 1.0, 0.000000001, 12345.678901234, -0.0005, -3.0, 0.9999999996}) {
    e.t_s = t_s;
    at.push_back(e);
  }
  const auto lines = table_lines(at);
  ASSERT_EQ(lines.size(), 8U);
  EXPECT_THAT(lines[1], StartsWith("0.000000000,"));
  EXPECT_THAT(lines[2], StartsWith("1.000000000,"));
  EXPECT_THAT(lines[3], StartsWith("0.000000001,"));
  EXPECT_THAT(lines[4], StartsWith("12345.678901234,"));
  EXPECT_THAT(lines[5], StartsWith("-0.000500000,"));
  EXPECT_THAT(lines[6], StartsWith("-3.000000000,"));
  EXPECT_THAT(lines[7], StartsWith("1.000000000,")) << "rounded, with the carry";
}

// More rows than the buffer holds, so that it is emptied on the way.
TEST(EstimateTable, EveryNumberReadsBackAsTheSameDouble) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  std::vector<Estimate> put(10'000);
  for (Estimate& e : put) {
    e.position_mm = normal(random) * 1e3;
    e.velocity_mm_s = normal(random) * 1e-7;
  }
  const auto lines = table_lines(put);
  ASSERT_EQ(lines.size(), put.size() + 1);
  for (std::size_t i = 0; i < put.size(); ++i) {
    const char* at = lines[i + 1].c_str() + lines[i + 1].find(',') + 1;
    char* next = nullptr;
    ASSERT_EQ(std::strtod(at, &next), put[i].position_mm) << i;
    ASSERT_EQ(std::strtod(next + 1, nullptr), put[i].velocity_mm_s) << i;
  }
}

}  // namespace
}  // namespace steadyrest::motion::offline
