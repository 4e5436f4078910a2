// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/nc/rewrite/test/workshop.hpp>

namespace steadyrest::nc::rewrite {
namespace {

using test::kGrowth;
using test::kPasses;
using test::one_step;
using test::replaced;
using test::text_of_file;
using test::Workshop;
using ::testing::HasSubstr;

TEST(Compensate, RefusesAWorkOffsetThatChangesWithTheAxis) {
  Workshop shop;
  const std::string program = replaced(kPasses, "G0 X0 Y30\n", "G55 G0 X0 Y30 Z6\n");
  const auto refused = shop.compensate(program, kGrowth);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().line, 19U);
  EXPECT_THAT(refused.error().what, HasSubstr("moves Z"));
}

TEST(Compensate, RefusesAPlanForAnotherProgramWithBothFigures) {
  const Workshop shop;
  // The plan is for 11 minutes, the program takes about four.
  const auto refused = shop.compensate(kPasses, one_step(1.0, 10.0, 10));
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().what, HasSubstr("660.0 s"));
  EXPECT_THAT(refused.error().what, HasSubstr("s on this machine"));
}

TEST(Compensate, RefusesACorrectionBeyondTheClamp) {
  Workshop shop;
  shop.settings.clamp_mm = 0.015;
  const auto refused = shop.compensate(kPasses, kGrowth);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().what, HasSubstr("-20 um"));
  EXPECT_THAT(refused.error().what, HasSubstr("allows 15 um"));
}

TEST(Compensate, RefusesAProgramThatIsCompensatedAlready) {
  const Workshop shop;
  ASSERT_TRUE(shop.compensate(kPasses, kGrowth));
  const auto refused = shop.compensate(text_of_file(shop.changed()), kGrowth);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().to_do, HasSubstr("program strip"));
}

TEST(Compensate, LeavesTheOldFileWhenItRefuses) {
  const Workshop shop;
  test::write_file(shop.changed(), "old");
  ASSERT_FALSE(shop.compensate(kPasses, one_step(1.0, 10.0, 10)));
  EXPECT_EQ(text_of_file(shop.changed()), "old");
  // The folder holds the program and the old output, and no third file.
  const auto files = std::filesystem::directory_iterator(shop.folder());
  EXPECT_EQ(std::distance(begin(files), end(files)), 2) << "a half-written file is left";
}

TEST(Compensate, RefusesAnAxisOfWhichTheMachineHasNoRoomForANote) {
  Workshop shop;
  shop.settings.axes = shop.config.axes = "XYZAC";  // leaves B U V W: Z and Y
  EXPECT_TRUE(shop.compensate(kPasses, kGrowth));
  const auto refused = shop.compensate(kPasses, replaced(kGrowth, "{", R"({"axis": "X", )"));
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().what, HasSubstr("XYZAC"));
}

}  // namespace
}  // namespace steadyrest::nc::rewrite
