// SPDX-License-Identifier: Apache-2.0
// `cut --ways` and `--curve`: every way to cut the part, each as `cut` by itself would measure it.
#include <string>
#include <vector>

#include "expectations.hpp"
#include "program.hpp"
#include "scratch.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace steadyrest::test {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;

const std::string kRound = "examples/programs/circle-r10.mpf";
const std::string kRoundLarger = "examples/programs/circle-r10-larger.mpf";
const std::string kVmc = "examples/machines/vmc-840d.toml";

/// The example's machine, with a control that takes offsets against the contour error.
std::string with_offsets(const Scratch& scratch) {
  std::string machine = text_of_file(project_file(kVmc));
  const std::string head = "[envelope]\n";
  machine.insert(machine.find(head) + head.size(),
                 "max_path_offset_um = 500\npath_offset_slew_um_s = 100000\n");
  return scratch.file("offsets.toml", machine);
}

std::vector<std::string> ways_in(const json& ways) {
  std::vector<std::string> out;
  for (const json& way : ways) {
    out.push_back(way["way"]);
  }
  return out;
}

/// The figures of a way without its name.
json figures_of(json way) {
  way.erase("way");
  way.erase("get");
  way.erase("limit_um");
  return way;
}

TEST(CutWays, OfAMachineWithoutOffsetsAreTheTwoCuts) {
  const std::string line = "cut " + kRound + " --machine " + kVmc;
  EXPECT_FALSE(answer_of(line + " --quick").contains("ways"));
  const json answer = answer_of(line + " --quick --ways");
  ASSERT_THAT(ways_in(answer["ways"]), ElementsAre("alone", "feed_override"));
  EXPECT_EQ(figures_of(answer["ways"][0]), answer["without"]);
  EXPECT_EQ(figures_of(answer["ways"][1]), answer["with"]);
  EXPECT_TRUE(answer["curve"].empty());
}

TEST(CutWays, WithOffsetsTheFeedOverrideIsCutWithoutThem) {
  const Scratch scratch;
  const std::string line = "cut " + kRound + " --machine " + with_offsets(scratch);
  const json answer = answer_of(line + " --quick --ways");
  ASSERT_THAT(ways_in(answer["ways"]), ElementsAre("alone", "feed_override", "path_offsets"));
  EXPECT_EQ(figures_of(answer["ways"][2]), answer["with"]);
  const json plain = answer_of("cut " + kRound + " --machine " + kVmc + " --quick");
  EXPECT_EQ(figures_of(answer["ways"][1]), plain["with"]);
  // The offsets leave the time as it is, where the override more than doubles it.
  EXPECT_LT(answer["ways"][2]["cycle_time_s"],
            1.02 * answer["ways"][0]["cycle_time_s"].get<double>());
  EXPECT_GT(answer["ways"][1]["cycle_time_s"],
            1.5 * answer["ways"][0]["cycle_time_s"].get<double>());
}

// The original's ways are what `cut` says of the original.
TEST(CutWays, OfAChangedProgramShowTheOriginalsWaysAndItsOwn) {
  const Scratch scratch;
  const std::string machine = " --machine " + with_offsets(scratch);
  const json answer =
      answer_of("cut " + kRoundLarger + " --against " + kRound + machine + " --ways");
  ASSERT_THAT(ways_in(answer["ways"]), ElementsAre("alone", "feed_override", "path_offsets",
                                                   "changed", "changed_path_offsets"));
  const json original = answer_of("cut " + kRound + machine + " --quick --ways");
  for (const std::size_t i : {0U, 1U, 2U}) {
    EXPECT_EQ(answer["ways"][i], original["ways"][i]) << i;
  }
  EXPECT_EQ(figures_of(answer["ways"][3]), answer["without"]);
  EXPECT_EQ(figures_of(answer["ways"][4]), answer["with"]);
}

// A tighter limit takes longer; at the machine's own limit the point is the way itself.
TEST(CutWays, TheCurveIsTheFeedOverrideAtOtherLimits) {
  const std::string line = "cut " + kRound + " --quick --machine " + kVmc;
  const json answer = answer_of(line + " --curve");
  const json& curve = answer["curve"];
  ASSERT_EQ(curve.size(), 3U);
  double last_s = 1e9;
  for (const json& point : curve) {
    EXPECT_LT(point["cycle_time_s"], last_s) << point["limit_um"];
    last_s = point["cycle_time_s"];
  }
  EXPECT_EQ(curve[0]["limit_um"], 5.0);
  EXPECT_EQ(curve[2]["limit_um"], 50.0);
  const json tight = answer_of(line + " --limit-um 5")["with"];
  EXPECT_EQ(curve[0]["cycle_time_s"], tight["cycle_time_s"]);
  EXPECT_EQ(curve[0]["contour_error_max_mm"], tight["contour_error_max_mm"]);
  EXPECT_LE(curve[0]["samples_over_limit"], tight["samples_over_limit"]) << "over 10 µm, not 5";
  EXPECT_EQ(answer_of(line + " --curve --limit-um 7")["curve"].size(), 4U);
}

TEST(CutWays, AReportComparesThemByItselfWhereThereAreSeveral) {
  const Scratch scratch;
  const auto report = [&](const std::string& line) {
    answer_of(line + " --report " + scratch.at("out"));
    return json::parse(text_of_file(scratch.at("out/report.json")));
  };
  EXPECT_TRUE(report("cut " + kRound + " --quick --machine " + kVmc)["ways"].empty());
  const json offsets = report("cut " + kRound + " --quick --machine " + with_offsets(scratch));
  EXPECT_THAT(ways_in(offsets["ways"]), ElementsAre("alone", "feed_override", "path_offsets"));
  EXPECT_FALSE(offsets.contains("against"));
  const json changed =
      report("cut " + kRoundLarger + " --against " + kRound + " --machine " + kVmc);
  EXPECT_EQ(changed["against"], "circle-r10.mpf");
  EXPECT_THAT(ways_in(changed["ways"]),
              ElementsAre("alone", "feed_override", "changed", "changed_feed_override"));
}

TEST(CutWays, PeopleGetATableOfThem) {
  const Finished finished =
      run_line("cut " + kRoundLarger + " --against " + kRound + " --machine " + kVmc + " --curve");
  ASSERT_EQ(finished.code, 0) << finished.err;
  EXPECT_THAT(finished.out, HasSubstr("over 10 µm"));
  for (const char* way : {"as programmed", "feed override", "changed program",
                          "changed, with feed override", "feed override for 50 µm"}) {
    EXPECT_THAT(finished.out, HasSubstr("\n" + std::string(way) + " "));
  }
}

}  // namespace
}  // namespace steadyrest::test
