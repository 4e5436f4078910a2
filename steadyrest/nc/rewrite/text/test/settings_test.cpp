// SPDX-License-Identifier: Apache-2.0
// Which plans fit a machine and a program.
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/nc/rewrite/text/settings.hpp>

namespace steadyrest::nc::rewrite {
namespace {

using ::testing::HasSubstr;

/// A plan of one step for each of these axes.
Plan plan_for(std::string_view letters, double displacement_um = 10.0) {
  Plan plan;
  for (const char letter : letters) {
    plan.axes.push_back({.letter = letter, .steps = {{60.0, displacement_um}}});
  }
  return plan;
}

std::string plan_fault(const Plan& plan, Method method = Method::linuxcnc) {
  Settings settings;
  settings.method = method;
  settings.axes = "XYZW";
  interpret::Config config;
  config.axes = "XYZW";
  const auto checked = check_plan(plan, settings, config);
  return checked ? "" : checked.error().what;
}

TEST(CheckPlan, RefusesWhatTheMachineOrTheMethodCannotTake) {
  EXPECT_EQ(plan_fault(plan_for("YZ")), "");
  EXPECT_THAT(plan_fault(plan_for("A")), HasSubstr("no axis A; it has XYZW"));
  EXPECT_THAT(plan_fault(plan_for("X")), HasSubstr("needs two axis letters"))
      << "Z and Y have them";
  EXPECT_THAT(plan_fault(plan_for("W"), Method::fanuc), HasSubstr("an increment in this dialect"));
  EXPECT_THAT(plan_fault(plan_for("YZ"), Method::r_parameter), HasSubstr("only one variable"));
  EXPECT_THAT(plan_fault(plan_for("YZ"), Method::setting_data), HasSubstr("only one variable"));
  EXPECT_EQ(plan_fault(plan_for("YZ"), Method::frame_fine), "");
}

TEST(CheckPlan, KeepsTheClampAndTheNumberOfSteps) {
  EXPECT_EQ(plan_fault(plan_for("Z", 200.0)), "");
  EXPECT_EQ(plan_fault(plan_for("Z", -200.0)), "");
  EXPECT_THAT(plan_fault(plan_for("Z", 200.01)), HasSubstr("by -200.01 um at 1 min"));
  EXPECT_THAT(plan_fault(plan_for("Z", -200.01)), HasSubstr("allows 200 um"));
  Plan many = plan_for("Z");
  many.axes[0].steps.resize(10'000);
  EXPECT_EQ(plan_fault(many), "");
  many.axes[0].steps.resize(10'001);
  EXPECT_THAT(plan_fault(many), HasSubstr("10001 corrections of Z"));
}

// README: 2 % or 30 s, whichever is larger.
TEST(CheckTotal, APlanMayDifferByTwoPercentOrThirtySeconds) {
  const auto fits = [](double plan_s, double program_s) {
    Plan plan;
    plan.total_s = plan_s;
    return check_total(plan, program_s).has_value();
  };
  EXPECT_TRUE(fits(130.0, 100.0) && fits(70.0, 100.0));
  EXPECT_FALSE(fits(130.1, 100.0) || fits(69.9, 100.0));
  EXPECT_TRUE(fits(10'200.0, 10'000.0) && fits(9'800.0, 10'000.0));
  EXPECT_FALSE(fits(10'201.0, 10'000.0) || fits(9'799.0, 10'000.0));
}

}  // namespace
}  // namespace steadyrest::nc::rewrite
