// SPDX-License-Identifier: Apache-2.0
// Subprograms by number: FANUC's M98 and the files that it finds.
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include <steadyrest/kernel/file/testing/own_folder.hpp>
#include <steadyrest/nc/interpret/test/moves.hpp>

namespace steadyrest::nc::interpret {
namespace {

using testing::ElementsAre;

class NumberedPrograms : public testing::Test {
 protected:
  NumberedPrograms() {
    config_.dialect = read::Dialect::fanuc;
    config_.subprogram_folders = {folder_.path().string()};
  }
  /// X of each move of a program with this call.
  [[nodiscard]] std::vector<double> x_after(const std::string& text) const {
    return ends_along(0, text, config_);
  }
  kernel::file::testing::OwnFolder folder_;
  Config config_;
};

TEST_F(NumberedPrograms, TheProgramsOwnFileComesBeforeTheFolder) {
  folder_.file("O0002.nc", "O0002\nG0 X20.\nM99\n");
  EXPECT_THAT(x_after("M98 P2\nM30\nO2\nG0 X1.\nM99\n"), ElementsAre(1));
  EXPECT_THAT(x_after("M98 P2\nM30\nO3\nG0 X1.\nM99\n"), ElementsAre(20));
}

TEST_F(NumberedPrograms, OfTwoWithOneNumberTheFirstCounts) {
  EXPECT_THAT(x_after("M98 P2\nM30\nO2\nG0 X1.\nM99\nO0002\nG0 X2.\nM99\n"), ElementsAre(1));
}

// Controls write four digits; CAM systems leave the zeros out, or write another extension.
TEST_F(NumberedPrograms, AFileWithFourDigitsComesBeforeOneWithout) {
  folder_.file("12.nc", "G0 X1.\nM99\n");
  EXPECT_THAT(x_after("M98 P12\nM30\n"), ElementsAre(1));
  folder_.file("o12.tap", "G0 X2.\nM99\n");
  EXPECT_THAT(x_after("M98 P12\nM30\n"), ElementsAre(2));
  folder_.file("O0012", "G0 X3.\nM99\n");
  EXPECT_THAT(x_after("M98 P12\nM30\n"), ElementsAre(3));
}

TEST_F(NumberedPrograms, WhatStandsBehindTheClosingPercentIsNoProgram) {
  EXPECT_THAT(x_after("%\nM98 P2\nM30\n:2 (two)\nG0 X1.\nM99\n%\n"), ElementsAre(1));
  EXPECT_EQ(reason_of("%\nM98 P2\nM30\n%\nO2\nG0 X1.\nM99\n", config_), "no_such_program");
}

TEST_F(NumberedPrograms, ReturnToTheBlockAfterTheCallFromEachDepth) {
  EXPECT_THAT(x_after("G91\nM98 P2 L2\nG0 X100.\nM30\nO2\nM98 P30003\nG0 X10.\nM99\nO3\nG0 X1.\n"
                      "M99\n"),
              ElementsAre(1, 2, 3, 13, 14, 15, 16, 26, 126));
}

TEST_F(NumberedPrograms, NestTenDeep) {
  std::string text = "M98 P1\nM30\n";
  for (int number = 1; number < 10; ++number) {
    text += "O" + std::to_string(number) + "\nM98 P" + std::to_string(number + 1) + "\nM99\n";
  }
  EXPECT_THAT(x_after(text + "O10\nG0 X5.\nM99\n"), ElementsAre(5));
  EXPECT_EQ(reason_of(text + "O10\nM98 P11\nM99\nO11\nG0 X5.\nM99\n", config_), "calls_too_deep");
}

TEST_F(NumberedPrograms, ARefusalInAFileNamesIt) {
  folder_.file("O0007.nc", "G0 X1.\nG0 X#5\nM99\n");
  Kept kept;
  const auto report = run_text("M98 P7\nM30\n", config_, kept);
  ASSERT_TRUE(report && !report->refused.empty());
  EXPECT_EQ(report->refused.front().reason, "vacant_variable");
  EXPECT_EQ(report->refused.front().file, folder_.at("O0007.nc"));
  EXPECT_EQ(report->refused.front().line, 2U);
}

}  // namespace
}  // namespace steadyrest::nc::interpret
