// SPDX-License-Identifier: Apache-2.0
// `cut CHANGED --against ORIGINAL` as a user runs it.
#include <string>

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

const std::string kOriginal = "examples/programs/circle-r10.mpf";
const std::string kLarger = "examples/programs/circle-r10-larger.mpf";
const std::string kMachine = " --machine examples/machines/ideal-k50.toml";

/// Every key that scripts rely on.
json figures(const json& cut) {
  json out;
  for (const char* key :
       {"cycle_time_s", "contour_error_max_mm", "contour_error_rms_mm", "tracking_error_max_mm",
        "over_limit_s", "override_changes", "cutting_time_s", "samples", "samples_over_limit"}) {
    EXPECT_TRUE(cut[key].is_number()) << key;
    out[key] = cut[key];
  }
  return out;
}

// The circle comes out 87.7 µm too small; commanded larger by as much only entry and exit are
// wrong.
TEST(CutAgainst, JudgesAChangedProgramByItsOriginal) {
  const json alone = answer_of("cut " + kOriginal + kMachine + " --quick");
  const json own = answer_of("cut " + kLarger + kMachine + " --quick");
  const json answer = answer_of("cut " + kLarger + " --against " + kOriginal + kMachine);
  EXPECT_EQ(answer["program"], kLarger);
  EXPECT_EQ(answer["against"]["program"], kOriginal);
  EXPECT_EQ(answer["against"]["tube_mm"], 1.0);
  EXPECT_NEAR(answer["against"]["farthest_mm"], 0.0877, 1e-6);
  EXPECT_EQ(figures(answer["original"]), alone["without"]);
  EXPECT_FALSE(alone.contains("original"));
  // The same motion, another judge.
  EXPECT_EQ(answer["without"]["cycle_time_s"], own["without"]["cycle_time_s"]);
  EXPECT_NEAR(own["without"]["contour_error_rms_mm"], 0.0843, 0.001);
  EXPECT_NEAR(figures(answer["without"])["contour_error_rms_mm"], 0.0037, 0.0002);
  // The layer does not know the original: it holds the larger circle, at the price of time.
  EXPECT_EQ(answer["with"]["cycle_time_s"], own["with"]["cycle_time_s"]);
  EXPECT_GT(figures(answer["with"])["contour_error_rms_mm"], 0.07);
}

TEST(CutAgainst, TakesTheTubeThatTheChangedProgramNames) {
  const Scratch scratch;
  const std::string changed = scratch.at("changed.mpf");
  const std::string circle = "examples/programs/circle-r10.mpf";
  const std::string mill = " --machine examples/machines/vmc-840d.toml";
  answer_of("program predistort " + circle + mill + " --max-shift-mm 2 -o " + changed);
  const std::string line = "cut " + changed + " --against " + circle + mill;
  EXPECT_EQ(answer_of(line)["against"]["tube_mm"], 2.5);
  EXPECT_EQ(answer_of(line + " --tube-mm 0.3")["against"]["tube_mm"], 0.3);
}

TEST(CutAgainst, OfAProgramAgainstItselfHasTheFiguresOfTheProgram) {
  const json alone = answer_of("cut " + kOriginal + kMachine + " --quick");
  const json answer = answer_of("cut " + kOriginal + " --against " + kOriginal + kMachine);
  for (const char* cut : {"without", "with"}) {
    EXPECT_EQ(answer[cut]["samples"], alone[cut]["samples"]);
    for (const char* key : {"contour_error_max_mm", "contour_error_rms_mm"}) {
      EXPECT_NEAR(answer[cut][key], alone[cut][key], 1e-9) << cut << " " << key;
    }
  }
  EXPECT_EQ(answer["original"], alone["without"]);
}

// Which machine rounds a corner within a tolerance: both verbs judge by the corner itself.
TEST(CutAgainst, JudgesATolerancesCornersAsCorrectDoes) {
  const Scratch scratch;
  const std::string mill = " --machine examples/machines/linuxcnc-mill.toml";
  for (const char* const tolerance : {"0.02", "0.1", "0.4"}) {
    const std::string name = std::string("p") + tolerance;
    const std::string part = scratch.file(
        name + ".ngc", std::string("G17 G21 G90 G94 G64 P") + tolerance +
                           "\nG0 X0 Y0 Z5\nG1 Z0 F300\nX30 F1500\nY20\nX20 Y40\nX0\nM2\n");
    const std::string out = scratch.at(name + "-out.ngc");
    const json said =
        answer_of("program correct " + part + mill + " --max-error-mm 0.01 -o " + out)["path"];
    const json seen = answer_of("cut " + out + mill + " --quick");
    // The model knows no friction: the largest error is that of one corner, the RMS that of all.
    const auto same = [&](const char* cut, const char* key, const char* predicted, double within) {
      EXPECT_NEAR(seen[cut][key].get<double>() / said[predicted].get<double>(), 1.0, within)
          << tolerance << " " << predicted;
    };
    same("original", "contour_error_max_mm", "predicted_error_max_before_mm", 0.01);
    same("original", "contour_error_rms_mm", "predicted_error_rms_before_mm", 0.01);
    same("without", "contour_error_max_mm", "predicted_error_max_mm", 0.2);
    same("without", "contour_error_rms_mm", "predicted_error_rms_mm", 0.03);
    EXPECT_LT(said["predicted_error_rms_mm"],
              0.4 * said["predicted_error_rms_before_mm"].get<double>());
  }
}

TEST(CutAgainst, ShowsPeopleAllThreeCuts) {
  const Finished finished = run_line("cut " + kLarger + " --against " + kOriginal + kMachine);
  EXPECT_THAT(finished.out, HasSubstr("against the path of " + kOriginal));
  EXPECT_THAT(finished.out, HasSubstr("up to 87.7 µm away (line 13, there line 11)"));
  EXPECT_THAT(finished.out, HasSubstr("original  changed, without  changed, with"));
}

TEST(CutAgainst, RefusesProgramsThatPartWithTheLinesOfBoth) {
  const Scratch scratch;
  const std::string original =
      scratch.file("a.mpf", "G71 G90 G94 G60\nG1 X20 F1000\nX40\nY20\nM30\n");
  const std::string changed =
      scratch.file("b.mpf", "G71 G90 G94 G60\nG1 X20 F1000\nX20 Y2\nX40\nY20\nM30\n");
  const std::string line = "cut " + changed + " --against " + original + kMachine;
  expect_refused(line, changed + ":3: the programs part here: line 3 of the original is ");
  EXPECT_NEAR(answer_of(line + " --tube-mm 2.5")["against"]["farthest_mm"], 2.0, 1e-6);
  expect_refused(line + " --tube-mm 0", "--tube-mm: the tube of 0 mm is out of range");
  expect_refused(line + " --tube-mm nan", "--tube-mm");
  expect_refused("cut " + changed + kMachine + " --tube-mm 2", "--tube-mm requires --against");
  expect_refused("cut " + changed + kMachine + " --against none.mpf", "none.mpf");
  const std::string other = scratch.file("c.mpf", "G71 G90\nG21\nM30\n");
  expect_refused("cut " + changed + kMachine + " --against " + other, other + ":2: `G21`");
}

}  // namespace
}  // namespace steadyrest::test
