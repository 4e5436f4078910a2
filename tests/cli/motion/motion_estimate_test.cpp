// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "estimate_rows.hpp"
#include "expectations.hpp"
#include "program.hpp"
#include "scratch.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace steadyrest::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::StartsWith;

const std::string kSine = "examples/logs/sine-edges.csv";
const std::string kEdges = " --input edges" + kAxis;

/// RMS error of the velocity against x = 0.15 mm·(1 − cos 2π·2 Hz·t), the exact motion of the
/// example's log, from 50 ms on.
double sine_error_mm_s(const std::vector<Row>& rows) {
  const double w = 2.0 * std::numbers::pi * 2.0;
  double squares = 0.0;
  double n = 0.0;
  for (const Row& row : rows) {
    if (row[0] >= 0.05) {
      const double error = row[2] - 0.15 * w * std::sin(w * row[0]);
      squares += error * error;
      n += 1.0;
    }
  }
  return std::sqrt(squares / n);
}

std::vector<Row> sine_by(const std::string& estimator) {
  const Finished finished =
      run_line("motion estimate " + kSine + kEdges + " --estimator " + estimator);
  EXPECT_EQ(finished.code, 0) << finished.err;
  return estimated_rows(finished.out);
}

TEST(MotionEstimate, WritesATickForEveryCycleOfALogOfEdges) {
  const Scratch scratch;
  const std::string out = scratch.at("out.csv");
  const Finished finished =
      run_line("motion estimate " + kSine + kEdges + " -o " + out + " --json");
  ASSERT_EQ(finished.code, 0) << finished.err;
  EXPECT_THAT(finished.err, IsEmpty());
  const json answer = json::parse(finished.out);
  EXPECT_THAT(answer["estimator"].get<std::string>(), Not(IsEmpty()));
  EXPECT_EQ(answer["ticks"], 501);
  EXPECT_EQ(answer["edges"], 598);  // lines 1 … 299, up and down
  EXPECT_EQ(answer["reports"], 0);
  EXPECT_EQ(answer["complete"], true);
  EXPECT_TRUE(answer["cycle"].is_null());
  EXPECT_DOUBLE_EQ(answer["clock_s"], 1e-7);
  const std::string table = text_of_file(out);
  EXPECT_THAT(table, HasSubstr("\n0.007000000,"));
  const std::vector<Row> rows = estimated_rows(table);
  ASSERT_EQ(rows.size(), 501U);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    ASSERT_NEAR(rows[i][0], 0.001 * static_cast<double>(i), 1e-10);
  }
}

TEST(MotionEstimate, DifferencesErrByWhatTheirQuantisationAllows) {
  // 0.408 counts/tick at constant speed (Kavanagh and Murphy), here with a lag of half a tick.
  EXPECT_NEAR(sine_error_mm_s(sine_by("difference")), 0.408, 0.05);
}

// Time stamps alone, without any axis limit, halve the error.
TEST(MotionEstimate, EdgesWithTheirTimesBeatDifferences) {
  EXPECT_LT(sine_error_mm_s(sine_by("mt")), 0.5 * sine_error_mm_s(sine_by("difference")));
}

// 0.00408 mm/s is a hundredth of what differences give, and every tick must keep its proven bound.
TEST(MotionEstimate, TheDefaultIsAHundredTimesFinerThanDifferencesAndKeepsItsBounds) {
  const Finished finished =
      run_line("motion estimate " + kSine + kEdges +
               " --max-speed 1.9 --max-acceleration 24 --max-jerk 300 --line-error-um 0");
  ASSERT_EQ(finished.code, 0) << finished.err;
  const std::vector<Row> rows = estimated_rows(finished.out);
  EXPECT_LT(sine_error_mm_s(rows), 0.00408);
  const double w = 2.0 * std::numbers::pi * 2.0;
  for (const Row& row : rows) {
    ASSERT_LE(std::abs(row[2] - 0.15 * w * std::sin(w * row[0])), row[4]) << row[0];
    ASSERT_LE(std::abs(row[3] - 0.15 * w * w * std::cos(w * row[0])), row[5]) << row[0];
    ASSERT_TRUE(row[0] < 0.05 || (std::isfinite(row[4]) && std::isfinite(row[5]))) << row[0];
  }
}

TEST(MotionEstimate, WithoutALimitOfTheJerkThereIsNoBound) {
  const std::string table = run_line("motion estimate " + kSine + kEdges).out;
  EXPECT_THAT(table, HasSubstr(",inf,inf\n"));
}

// The list in --help is the list that works.
TEST(MotionEstimate, EveryEstimatorOfItsHelpGivesFiniteNumbers) {
  const std::string help = run_line("motion estimate --help").out;
  const std::size_t at = help.find("One of ");
  ASSERT_NE(at, std::string::npos);
  std::string names = help.substr(at + 7);
  std::istringstream in(names.substr(0, names.find("\n  -")));
  std::string name;
  int tried = 0;
  while (in >> name) {
    name.erase(std::remove(name.begin(), name.end(), ','), name.end());
    const Finished finished =
        run_line("motion estimate " + kSine + kEdges +
                 " --max-speed 2 --max-acceleration 25 --max-jerk 300 --estimator " + name);
    ASSERT_EQ(finished.code, 0) << name << finished.err;
    const std::vector<Row> rows = estimated_rows(finished.out);
    EXPECT_EQ(rows.size(), 501U) << name;
    for (const Row& row : rows) {
      ASSERT_TRUE(std::isfinite(row[1]) && std::isfinite(row[2]) && std::isfinite(row[3])) << name;
      ASSERT_TRUE(row[4] >= 0.0 && row[5] >= 0.0) << name;
    }
    ++tried;
  }
  EXPECT_GE(tried, 7);
}

TEST(MotionEstimate, ReadsStdin) {
  const std::string log = project_file(kSine);
  const Finished finished = run_line_on("motion estimate -" + kEdges, log);
  EXPECT_EQ(finished.code, 0) << finished.err;
  EXPECT_EQ(finished.out, run_line("motion estimate " + log + kEdges).out);
}

// The rows before the bad one are worth having; exit code 2 says that they are not all.
TEST(MotionEstimate, KeepsWhatWasGoodBeforeABadRow) {
  const Scratch scratch;
  const std::string log = scratch.file("log.csv",
                                       "t_s,count\n0.000,0\n0.001,1\n0.002,2\n0.003,3\n"
                                       "0.002,4\n0.005,5\n");
  const std::string out = scratch.at("out.csv");
  const Finished finished =
      run_line("motion estimate " + log + kTicks + " --estimator difference --json -o " + out);
  EXPECT_EQ(finished.code, 2);
  EXPECT_THAT(finished.err, StartsWith("steadyrest: " + log + ":6: time goes back"));
  const json answer = json::parse(finished.out);
  EXPECT_EQ(answer["ticks"], 4);
  EXPECT_EQ(answer["complete"], false);
  EXPECT_EQ(answer["reports"], 1);
  EXPECT_EQ(answer["findings"][0]["line"], 6);
  const std::vector<Row> rows = estimated_rows(text_of_file(out));
  ASSERT_EQ(rows.size(), 4U);
  EXPECT_NEAR(rows[3][2], 1.0, 1e-9);
}

TEST(MotionEstimate, ReportsLostEdgesAndGoesOn) {
  const Scratch scratch;
  const std::string log =
      scratch.file("log.csv", "t_s,count\n0.0001,0\n0.0011,1\n0.0021,5\n0.0031,6\n");
  const Finished finished = run_line("motion estimate " + log + kEdges + " --json");
  EXPECT_EQ(finished.code, 0);
  EXPECT_THAT(finished.err, HasSubstr(log + ":4: the count jumps from 1 to 5"));
  const json answer = json::parse(finished.out);
  EXPECT_EQ(answer["jumps"], 1);
  EXPECT_EQ(answer["edges"], 3);
}

TEST(MotionEstimate, ReportsALogThatEndsMidRow) {
  const Scratch scratch;
  const std::string log = scratch.file("log.csv", "t_s,count\n0.000,0\n0.001,1\n0.00");
  const Finished finished = run_line("motion estimate " + log + kTicks + " --json");
  EXPECT_EQ(finished.code, 0);
  EXPECT_THAT(finished.err, HasSubstr(log + ":4: the log ends within a row"));
  EXPECT_EQ(json::parse(finished.out)["ticks"], 2);
}

// A refusal must leave an older result alone.
TEST(MotionEstimate, RefusesALogThatItCannotReadAndLeavesTheOutputAlone) {
  const Scratch scratch;
  const std::string older = "t_s,position_mm,velocity_mm_s,acceleration_mm_s2,precious\n";
  const std::string out = scratch.file("out.csv", older);
  for (const char* name :
       {"column-count-missing.csv", "compressed.csv.gz", "empty.csv", "none.csv"}) {
    const std::string log = project_file(std::string("tests/refused/motion/") + name);
    const Finished finished = run_line("motion estimate " + log + kEdges + " -o " + out);
    EXPECT_EQ(finished.code, 2) << name;
    EXPECT_THAT(finished.err, StartsWith("steadyrest: " + log + ":")) << name;
    EXPECT_EQ(text_of_file(out), older);
  }
}

TEST(MotionEstimate, DoesNotOverwriteItsOwnLog) {
  const Scratch scratch;
  const std::string text = "t_s,count\n0.000,0\n0.001,1\n";
  const std::string log = scratch.file("log.csv", text);
  EXPECT_EQ(run_line("motion estimate " + log + kTicks + " -o " + log).code, 2);
  EXPECT_EQ(text_of_file(log), text);
}

TEST(MotionEstimate, RefusesBadUsage) {
  const std::string verb = "motion estimate " + kSine + " ";
  expect_all_refused({std::string("motion estimate") + kEdges,
                      verb + kAxis,
                      verb + "--input words" + kAxis,
                      verb + "--input edges --cycle-hz 1000",
                      verb + "--input edges --count-mm 0.001",
                      verb + "--input edges --count-mm 0 --cycle-hz 1000",
                      verb + "--input edges --count-mm nan --cycle-hz 1000",
                      verb + "--input edges --count-mm 0.001 --cycle-hz -1000",
                      verb + "--input edges --count-mm 0.001 --cycle-hz inf",
                      verb + kEdges + " --max-acceleration 0",
                      verb + kEdges + " --max-jerk -5",
                      verb + kEdges + " --max-speed nan",
                      verb + kEdges + " --line-error-um -1",
                      verb + kEdges + " --clock-ns -1",
                      verb + kEdges + " --lag-ms nan",
                      verb + kEdges + " --estimator difference --lag-ms 2",
                      verb + kEdges + " --estimator oracle",
                      verb + kTicks + " --estimator mt",
                      verb + kTicks + " --estimator event-fit",
                      verb + kEdges + " --estimator worst-case"});
  EXPECT_THAT(run_line(verb + kEdges + " --estimator oracle").err, HasSubstr("difference, mt"));
}

TEST(MotionEstimate, SaysSoWhenTheOutputCannotBeWritten) {
  const std::string line = "motion estimate " + kSine + kEdges + " -o ";
  EXPECT_EQ(run_line(line + "none/out.csv").code, 1);
  EXPECT_EQ(run_line(line + "/dev/full").code, 1);
}

/// A second of 1 kHz: 20 mm/s, 20 counts a row.
std::string ticks(double stamp_per_s, std::int64_t jump = 0) {
  std::string text = "t_s,count\n";
  for (int i = 0; i < 1000; ++i) {
    text += std::to_string(i * 1e-3 * stamp_per_s) + "," +
            std::to_string(20 * i + (i >= 500 ? jump : 0)) + "\n";
  }
  return text;
}

// Milliseconds in t_s, a wrong cycle, a lost reference: each with its numbers and what to check.
TEST(MotionEstimate, WarnsWhereTheLogIsNotWhatWasSaidOfIt) {
  const Scratch scratch;
  const auto line = [&](const std::string& text, const std::string& hz) {
    return "motion estimate " + scratch.file("log.csv", text) +
           " --input ticks --count-mm 0.001 --cycle-hz " + hz + " -o " + scratch.at("out.csv") +
           " --force";
  };
  EXPECT_TRUE(answer_of(line(ticks(1.0), "1000"))["warnings"].empty());
  expect_refused(line(ticks(1e3), "1000"),
                 "log.csv: rows are 1000 ms apart (median), but 1000 cycles a second are 1 ms: "
                 "nothing can be estimated; check --cycle-hz, and that t_s is in seconds");
  const Finished twice = run_line(line(ticks(1.0), "2000"));
  EXPECT_EQ(twice.code, 0);
  EXPECT_THAT(twice.err,
              HasSubstr("log.csv: warning: rows are 1 ms apart (median), but 2000 cycles "
                        "a second are 0.5 ms; check --cycle-hz"));
  const Finished jump = run_line(line(ticks(1.0, 1'000'000'000), "1000"));
  EXPECT_EQ(jump.code, 0);
  EXPECT_THAT(jump.err, HasSubstr("warning: the count jumps by 1e+09 in 1 ms at t_s = 0.5"));
  EXPECT_EQ(answer_of(line(ticks(1.0, 200), "1000"))["warnings"].size(), 0U)
      << "ten times the speed may be a short move";
  expect_refused(
      "motion estimate " + scratch.file("short.csv", "t_s,count\n0.0001,0\n0.0002,1\n") + kEdges,
      "no control cycle of 1 ms lies between");
}

}  // namespace
}  // namespace steadyrest::test
