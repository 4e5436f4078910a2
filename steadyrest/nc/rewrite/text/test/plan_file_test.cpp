// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/nc/rewrite/test/workshop.hpp>
#include <steadyrest/nc/rewrite/text/plan_file.hpp>

namespace steadyrest::nc::rewrite {
namespace {

using ::testing::HasSubstr;

// The example of the paper (Marusich 2012): R = {3;{18,27,15};{0,10,10}}, {3;{15,40,5};{0,10,10}},
// three stages without corrections. The residual carries over from stage to stage.
TEST(PlanFile, ReadsThePapersExample) {
  // Sums of the paper's table: 10, 20, 30, 40 um at 18, 18 + 27, 60 + 15 and 60 + 55 minutes.
  const auto plan = parse_plan(R"({"axis": "Z", "transitions": [
      {"n": 3, "t_min": [18, 27, 15], "delta_um": [0, 10, 10]},
      {"n": 3, "t_min": [15, 40, 5], "delta_um": [0, 10, 10]},
      {"n": 1, "t_min": [60], "delta_um": [0]},
      {"n": 1, "t_min": [60], "delta_um": [0]},
      {"n": 1, "t_min": [60], "delta_um": [0]}]})",
                               "plan.json")
                        .value();
  EXPECT_DOUBLE_EQ(plan.total_s, 300.0 * 60.0);
  ASSERT_EQ(plan.axes.size(), 1U);
  const auto& steps = plan.axes[0].steps;
  ASSERT_EQ(steps.size(), 4U);
  const double minutes[] = {18, 45, 75, 115};
  for (std::size_t i = 0; i < steps.size(); ++i) {
    EXPECT_DOUBLE_EQ(steps[i].time_s, minutes[i] * 60.0);
    EXPECT_DOUBLE_EQ(steps[i].displacement_um, 10.0 * static_cast<double>(i + 1));
  }
}

TEST(PlanFile, ReadsSeveralAxes) {
  const auto plan = parse_plan(
      R"({"axes": {"Z": {"transitions": [{"n": 1, "t_min": [9], "delta_um": [3]}]},
                   "X": {"transitions": [{"n": 1, "t_min": [9], "delta_um": [-4.5]}]}},
          "machine": "m.toml", "level": 2})",
      "plan.json");
  ASSERT_TRUE(plan);
  EXPECT_EQ(plan->machine, "m.toml");
  ASSERT_EQ(plan->axes.size(), 2U);
}

// Each file names its fault on its first line, after //.
TEST(PlanFile, RefusesEveryFileOfTheCorpus) {
  // The corpus is the truth; each file's first line is a piece of the refusal.
  std::size_t seen = 0;
  const auto folder = std::filesystem::path(STEADYREST_SOURCE_DIR) / "tests/refused/plan";
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string text = test::text_of_file(entry.path().string());
    const auto head = text.find('\n');
    ASSERT_EQ(text.substr(0, 3), "// ") << entry.path();
    // The fault's line is left empty to keep the line numbers.
    const auto plan = parse_plan("\n" + text.substr(head + 1), "plan.json");
    ASSERT_FALSE(plan) << entry.path();
    EXPECT_THAT(kernel::outcome::text(plan.error()), HasSubstr(text.substr(3, head - 3)))
        << entry.path();
    ++seen;
  }
  EXPECT_GE(seen, 18U);
}

TEST(PlanFile, NamesTheKeyThatIsMeant) {
  const auto to_do = [](const char* text) { return parse_plan(text, "plan.json").error().to_do; };
  EXPECT_EQ(to_do(R"({"transitoins": []})"), "write transitions if that is what you mean");
  EXPECT_EQ(to_do(R"({"transitions": [{"n": 1, "tmin": [9], "delta_um": [3]}]})"),
            "write t_min if that is what you mean");
  EXPECT_EQ(to_do(R"({"transitions": [{"n": 1, "paint": [9], "delta_um": [3]}]})"),
            "use n, t_min, delta_um and name");
}

TEST(PlanFile, RefusesAFileThatIsNotThere) {
  const auto plan = read_plan("/nowhere/plan.json");
  ASSERT_FALSE(plan);
  EXPECT_EQ(plan.error().kind, kernel::outcome::Kind::unavailable);
}

}  // namespace
}  // namespace steadyrest::nc::rewrite
