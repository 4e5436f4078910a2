// SPDX-License-Identifier: Apache-2.0
// `cut --process`: chatter in the simulated machine, without and with the layer.
#include <fstream>
#include <string>

#include "expectations.hpp"
#include "program.hpp"
#include "scratch.hpp"
#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace steadyrest::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

const std::string kSlot =
    "cut examples/programs/slot.mpf --machine examples/machines/vmc-840d.toml";
const std::string kProcess = " --process examples/processes/slot-922hz.toml";

std::string at_depth(double depth_mm, const std::string& more = "") {
  return kSlot + kProcess + fmt::format(" --depth-mm {}", depth_mm) + more;
}

TEST(CutChatter, TheLayerTakesTheOverrideStepThatIsStable) {
  const json answer = answer_of(at_depth(1.0));
  for (const char* cut : {"without", "with"}) {
    for (const char* key : {"vibration_rms_um", "vibration_peak_um", "unforced_rms_um",
                            "force_peak_n", "power_peak_w", "chip_peak_um"}) {
      EXPECT_TRUE(answer[cut][key].is_number()) << cut << " " << key;
    }
  }
  EXPECT_GT(answer["without"]["unforced_rms_um"], 50.0);
  EXPECT_LT(answer["with"]["unforced_rms_um"].get<double>(),
            0.01 * answer["without"]["unforced_rms_um"].get<double>());
  EXPECT_LT(answer["with"]["force_peak_n"].get<double>(),
            0.5 * answer["without"]["force_peak_n"].get<double>());
  ASSERT_EQ(answer["chatter"].size(), 1U);
  EXPECT_EQ(answer["chatter"][0]["decision"], "constant");
  EXPECT_NEAR(answer["chatter"][0]["mean_percent"].get<double>(), 110.0, 1e-9);
  EXPECT_NEAR(answer["chatter"][0]["spindle_switch_percent"].get<double>(), 110.0, 1e-9);
}

/// The published border of this cut at 5000 rpm is 0.4086 mm.
TEST(CutChatter, OnEitherSideOfThePublishedBorder) {
  const auto unforced = [](double depth_mm) {
    return answer_of(at_depth(depth_mm))["without"]["unforced_rms_um"].get<double>();
  };
  EXPECT_LT(unforced(0.388), 0.2);
  EXPECT_GT(unforced(0.430), 1.0);
}

TEST(CutChatter, ByTheMachineFileNothingIsPlanned) {
  const json answer = answer_of(at_depth(1.0, " --chatter machine"));
  EXPECT_FALSE(answer.contains("chatter"));
  EXPECT_GT(answer["with"]["unforced_rms_um"], 50.0) << "its [chatter] is off";
}

TEST(CutChatter, WithoutAProcessItCutsAir) {
  const json answer = answer_of(kSlot);
  EXPECT_FALSE(answer["without"].contains("vibration_rms_um"));
  EXPECT_FALSE(answer.contains("chatter"));
}

TEST(CutChatter, ShowsPeopleTheVibrationAndTheChoice) {
  const Finished finished = run_line(at_depth(1.0));
  ASSERT_EQ(finished.code, 0) << finished.err;
  EXPECT_THAT(finished.out, HasSubstr("chatter: not from tooth to tooth, RMS"));
  EXPECT_THAT(finished.out, HasSubstr("S5000: override 110 %"));
}

TEST(CutChatter, TheReportHasItsCourse) {
  const Scratch scratch;
  answer_of(at_depth(1.0, " --report " + scratch.at("report")));
  const json report = json::parse(text_of_file(scratch.at("report/report.json")));
  const json& course = report["without"]["vibration"]["course"];
  ASSERT_GT(course["time_s"].size(), 500U);
  EXPECT_EQ(course["time_s"].size(), course["peak_um"].size());
  EXPECT_EQ(course["time_s"].size(), course["speed_rpm"].size());
}

TEST(CutChatter, RefusesWhatCannotBeCut) {
  const auto refuses = [](const std::string& line, const std::string& what) {
    const Finished finished = run_line(line);
    EXPECT_EQ(finished.code, 2) << line;
    EXPECT_THAT(finished.err, HasSubstr(what)) << line;
  };
  refuses(kSlot + kProcess, "--process without --depth-mm");
  refuses(at_depth(0.0), "--depth-mm 0 is not above 0");
  refuses(kSlot + " --depth-mm 1", "--process");
  refuses(kSlot + " --process none.toml --depth-mm 1", "none.toml");
  refuses(at_depth(1.0, " --chatter perhaps"), "--chatter");
  refuses("cut examples/programs/circle-r10.mpf --machine examples/machines/ideal-k50.toml" +
              kProcess + " --depth-mm 1",
          "a spindle that stands still");
}

}  // namespace
}  // namespace steadyrest::test
