// SPDX-License-Identifier: Apache-2.0
// A program whose text corrects the path, cut and run with the layer acting: neither may spoil what
// the other does.
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>

#include "examples.hpp"
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

const std::string kMarkedPart = "examples/programs/circle-r10.mpf";

double rms_um(const json& cut) {
  return 1e3 * cut["contour_error_rms_mm"].get<double>();
}

/// With its corrected path, of a program for a machine.
struct Predistorted {
  explicit Predistorted(const std::string& program = kMarkedPart,
                        const std::string& machine_file = "examples/machines/vmc-840d.toml",
                        const std::string& more = "")
      : machine(" --machine " + machine_file),
        file(scratch.at("changed" + std::filesystem::path(program).extension().string())) {
    answer_of("program predistort " + program + machine + " --max-error-mm 0.01" + more + " -o " +
              file);
  }
  /// Something in its text changed by hand.
  void edit(const std::string& from, const std::string& to) const {
    std::string text = text_of_file(file);
    const auto at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    std::ofstream(file, std::ios::binary) << text.replace(at, from.size(), to);
  }
  Scratch scratch;
  std::string machine;
  std::string file;
};

TEST(CutMarked, TheLayerLeavesTheTextsPathAsItIsAndBothAreJudgedByTheOriginal) {
  const Predistorted part;
  const json by_marks = answer_of("cut " + part.file + part.machine + " --quick");
  EXPECT_EQ(by_marks["against"]["by_marks"], true);
  EXPECT_EQ(by_marks["against"]["program"], nullptr);
  EXPECT_GT(rms_um(by_marks["original"]), 80.0);
  EXPECT_LT(rms_um(by_marks["without"]), 1.0);
  EXPECT_NEAR(rms_um(by_marks["with"]), rms_um(by_marks["without"]), 0.02);
  EXPECT_LE(by_marks["with"]["contour_error_max_mm"], by_marks["without"]["contour_error_max_mm"]);
  // It slows down for the corner after the circle alone, as in the original.
  EXPECT_LT(by_marks["with"]["cycle_time_s"].get<double>(),
            1.02 * by_marks["without"]["cycle_time_s"].get<double>());
  // The original itself gives the same figures as the one that the marks hold.
  const json given = answer_of("cut " + part.file + " --against " + kMarkedPart + part.machine);
  EXPECT_EQ(given["against"]["by_marks"], false);
  for (const char* cut : {"original", "without", "with"}) {
    EXPECT_EQ(given[cut], by_marks[cut]) << cut;
  }
  const Finished finished = run_line("cut " + part.file + part.machine + " --quick");
  EXPECT_THAT(finished.out,
              HasSubstr("errors are against the path of the original that its marks"));
}

// Rapids, corners, fillets.
TEST(CutMarked, NeitherSpoilsTheOtherInAWholePart) {
  const Predistorted part("examples/programs/rib-pocket.mpf");
  const json cut = answer_of("cut " + part.file + part.machine + " --quick");
  EXPECT_LT(rms_um(cut["without"]), 2.0);
  EXPECT_LE(rms_um(cut["with"]), 1.02 * rms_um(cut["without"]));
  EXPECT_LE(cut["with"]["contour_error_max_mm"].get<double>(),
            1.02 * cut["without"]["contour_error_max_mm"].get<double>());
}

TEST(CutMarked, WhereBlocksStayTheLayerHoldsWhatTheTextDoesNot) {
  // The circle would need more than the largest shift.
  const Scratch scratch;
  const Predistorted part(
      scratch.file("part.ngc",
                   "G21 G90 G17 G54 G61\nS1000 M3\nG0 X0 Y0 Z0\nG4 P0.5\nG1 X40 F2000\nG3 X45 Y5 "
                   "I0 J5\nG1 Y40\nG3 X45 Y40 I-12 J0 P3 F5000\nG1 Y60 F2000\nG0 Z5\nM2\n"),
      "examples/machines/linuxcnc-mill.toml", " --max-shift-mm 0.5");
  const json cut = answer_of("cut " + part.file + part.machine + " --quick");
  EXPECT_LT(rms_um(cut["with"]), 0.9 * rms_um(cut["without"]));
  EXPECT_LE(cut["with"]["contour_error_max_mm"].get<double>(),
            1.02 * cut["without"]["contour_error_max_mm"].get<double>());
  EXPECT_GT(cut["with"]["override_changes"].get<int>(), 0);
}

TEST(CutMarked, AnOriginalThatTheMarksDoNotGiveIsSaidAndLeftAlone) {
  const Predistorted part;
  part.edit("--tube-mm 0.5", "--tube-mm 0.6");
  const json cut = answer_of("cut " + part.file + part.machine + " --quick");
  EXPECT_FALSE(cut.contains("against"));
  EXPECT_FALSE(cut.contains("original"));
  EXPECT_EQ(cut["with"]["cycle_time_s"], cut["without"]["cycle_time_s"]);
  EXPECT_EQ(cut["with"]["contour_error_rms_mm"], cut["without"]["contour_error_rms_mm"]);
  EXPECT_THAT(cut["warnings"][0]["text"].get<std::string>(), HasSubstr("--against names"));
  const std::string warning = cut["warnings"][1]["text"];
  EXPECT_THAT(warning, HasSubstr("the original is not known"));
  EXPECT_THAT(warning, HasSubstr("how it was made is missing or changed"));
  EXPECT_THAT(warning, HasSubstr("the layer stays out of the contour"));
}

TEST(CutMarked, ARunLeavesItAloneTooAndCountsTheErrorAgainstTheOriginal) {
  const Predistorted part;
  const std::string records = part.scratch.at("records");
  const json run = answer_of("run --mode act --program " + part.file + part.machine + " --socket " +
                             part.scratch.at("s") + " --record " + records);
  EXPECT_EQ(run["over_limit_s"], 0.0);
  EXPECT_FALSE(run["reasons"].contains("contour_limit"));
  EXPECT_GT(run["reasons"]["contour_in_text"].get<int>(), 1000);
  // The record has the original: a replay decides the same without the program.
  const std::string record = run["record"]["file"];
  const json replay = answer_of("record replay " + record);
  EXPECT_EQ(replay["first_difference"], nullptr);
  EXPECT_GT(replay["cycles"].get<int>(), 2000);
}

TEST(CutMarked, ARunSaysThatTheOriginalIsNotKnown) {
  const Predistorted part;
  part.edit("STEADYREST head made", "STEADYFAST head made");
  const Finished run = run_line("run --mode act --program " + part.file + part.machine +
                                " --json --for-s 9 --socket " + part.scratch.at("s"));
  EXPECT_EQ(run.code, 0);
  EXPECT_THAT(run.err,
              HasSubstr("warning: " + part.file + ": the program's text corrects its path"));
  const json answer = json::parse(run.out);
  EXPECT_GT(answer["reasons"]["contour_original_unknown"].get<int>(), 1000);
  EXPECT_EQ(answer["over_limit_s"], 0.0);
}

// The path is the original's; only the feeds are the text's.
TEST(CutMarked, FeedsInTheTextAndTheLayerHoldOneLimitTogether) {
  const Scratch scratch;
  const std::string file = scratch.at("feeds.mpf");
  const std::string machine = " --machine examples/machines/vmc-840d.toml";
  answer_of("program feeds " + kMarkedPart + machine + " --max-error-mm 0.01 -o " + file);
  const json cut = answer_of("cut " + file + machine + " --quick");
  EXPECT_FALSE(cut.contains("against"));
  EXPECT_LE(cut["with"]["contour_error_max_mm"].get<double>(), 0.010);
  EXPECT_LE(cut["with"]["cycle_time_s"].get<double>(),
            1.05 * cut["without"]["cycle_time_s"].get<double>());
}

TEST(CutMarked, SaysThatAPlanInTheTextKeepsTheThermalOffsetOut) {
  const json cut = answer_of(
      "cut examples/plans/rib-pocket-compensated.ngc --machine "
      "examples/machines/linuxcnc-mill.toml --quick");
  EXPECT_THAT(cut["warnings"].dump(), HasSubstr("the layer adds no thermal offset"));
}

}  // namespace
}  // namespace steadyrest::test
