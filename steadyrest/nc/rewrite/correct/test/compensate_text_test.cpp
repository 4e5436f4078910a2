// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/nc/rewrite/test/workshop.hpp>

namespace steadyrest::nc::rewrite {
namespace {

using test::kGrowth;
using test::kPasses;
using test::one_step;
using test::text_of_file;
using test::Workshop;
using ::testing::HasSubstr;

TEST(Compensate, WritesMillimetresIntoAProgramInInches) {
  const Workshop shop;
  const std::string program =
      "G20 G90 G94 G54\nG0 Z1\nG1 X4 F4\nG0 Z1\nG0 X0\nG0 Z.5\nG1 X4 F4\nG0 Z1\nM2\n";
  // 0.01 mm whatever the unit: the text converts at run time.
  ASSERT_TRUE(shop.compensate(program, one_step(1.0, 1.05, 10)));
  EXPECT_THAT(text_of_file(shop.changed()), HasSubstr(test::change_to(-0.01)));
}

TEST(Compensate, StepsThatCancelAtOnePlaceLeaveNoText) {
  const Workshop shop;
  // +10 and −10 um within 0.6 s share a place; only the following 7 um show.
  const auto done = shop.compensate(
      kPasses,
      R"({"transitions": [{"n": 4, "t_min": [1, 0.01, 1, 2.19], "delta_um": [0, 10, -10, 7]}]})");
  ASSERT_TRUE(done) << done.error().what;
  ASSERT_EQ(done->insertions.size(), 1U);
  EXPECT_NEAR(done->insertions[0].total_um, -7.0, 1e-9);
}

// The lines work in either unit when the program does not say which one is in force.
TEST(Compensate, WritesForEitherUnitWhereTheProgramSaysNone) {
  for (const bool inch : {false, true}) {
    Workshop shop;
    shop.config.inch = inch;
    shop.settings.window_s = 20.0;
    const std::string feed = inch ? "F4" : "F100";
    const std::string far = inch ? "X4" : "X100";
    const std::string program = "G90 G94 G54\nG0 Z5\nG1 " + far + " " + feed +
                                "\nG0 Y10\nG0 X0\nG1 " + far + "\nG0 Z20\nM2\n";
    const auto done = shop.compensate(program, one_step(1.0, 1.05, 10));
    ASSERT_TRUE(done) << done.error().what;
    const std::string text = text_of_file(shop.changed());
    EXPECT_THAT(text, HasSubstr(test::change_to(-0.01) +
                                "G0 Z[#<_z>-0.0100*[#<_metric>+#<_imperial>/25.4]] "
                                "(STEADYREST restated)\n"));
    EXPECT_EQ(done->proof.added, 1U);
  }
}

TEST(Compensate, EveryLineForLinuxcncIsShortEnough) {
  constexpr std::size_t kMost = 250;  // LinuxCNC reads 255
  Workshop shop;
  shop.settings.axes = shop.config.axes = "XYZ";
  std::string text = whole_head(parse_plan(kGrowth, "plan.json").value(), shop.settings);
  text +=
      change_text(shop.settings, {.letter = 'Z', .from_mm = -0.123456, .to_mm = -0.654321}, "\n");
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = text.find('\n', at);
    EXPECT_LE(end - at, kMost) << text.substr(at, end - at);
    at = end + 1;
  }
}

}  // namespace
}  // namespace steadyrest::nc::rewrite
