// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/nc/rewrite/test/pockets.hpp>
#include <steadyrest/nc/rewrite/test/workshop.hpp>

// A changed program must leave no correction in what the control keeps afterwards.
namespace steadyrest::nc::rewrite {
namespace {

using test::fault;
using test::kHead;
using test::kThreeSteps;
using test::pockets;
using test::replaced;
using test::text_of_file;
using test::Workshop;
using ::testing::HasSubstr;

class Kept : public ::testing::Test {
 protected:
  Kept() {
    shop_.config.start_known = true;
    shop_.config.tools.emplace();
    for (std::int32_t number = 1; number < 10; ++number) {
      shop_.config.tools->push_back({.number = number, .offset = {0.0, 0.0, 0.5 * number}});
    }
  }
  Workshop shop_;
};

TEST_F(Kept, NoCorrectionStaysInWhatTheControlKeeps) {
  const struct {
    const char* lines;
    const char* where;
  } cases[] = {
      {"N121 G28.1\n", "G28.1"},
      {"N121 G30.1\n", "G30.1"},
      {"N121 G[59.3-31.2]\n", "G28.1"},
      {"N121 G53 G0 Z0\nN122 G10 L10 P5 Z0\nN123 G0 Z15\n", "tool 5"},
      {"N121 G10 L11 P5 Z0\n", "tool 5"},
      {"N121 #100=#<_abs_z>\n", "#100"},
      {"N121 #<_mine>=#<_abs_z>\n", "#<_mine>"},
      {"N121 #5161=#5223\n", "G28"},
      {"N121 #5230=[#<_abs_z>]\n", ""},
      {"N121 G10 L1 P5 Z#<_abs_z>\n", "tool 5"},
      {"N121 G53 G0 Z0\nN122 G92 Z0\nN123 G0 Z15\n", ""},
      {"N121 #5223=[#5223+1]\n", ""},
      {"N121 G10 L20 P2 Z0\n", "another work offset"},
      {"N121 G38.2 Z0 F50\nN122 G0 Z15\n", "probes"},
  };
  for (const auto& one : cases) {
    const std::string what = fault(shop_, pockets(one.lines));
    EXPECT_NE(what, "") << one.lines;
    EXPECT_THAT(what, HasSubstr(one.where)) << one.lines;
  }
}

TEST_F(Kept, WhatHoldsNoCorrectionMayBeKept) {
  for (const char* line : {"N121 #100=3", "N121 #100=#<_z>", "N121 G10 L1 P5 Z3", "N121 G92.1",
                           "N121 G10 L2 P3 Z5", "N121 G10 L10 P5 Z0"}) {
    EXPECT_EQ(fault(shop_, pockets(std::string{line} + "\n")), "") << line;
  }
  // Before the first correction everything may be stored.
  const std::string head = kHead + "G0 X0 Y0 Z40\nG28.1\nG30.1\nG10 L11 P5 Z0\n#100=#<_abs_z>\n";
  EXPECT_EQ(fault(shop_, pockets("", head)), "");
}

// Set by number, they lie dormant until the control takes them up with the next correction.
TEST_F(Kept, OffsetsInForceThatAreSetByTheirNumbersAreRefusedByTheLine) {
  const auto expect_refused = [&](const std::string& program, std::uint32_t line) {
    const auto done = shop_.compensate(program, kThreeSteps);
    ASSERT_FALSE(done) << program;
    EXPECT_THAT(done.error().what, HasSubstr("by its numbers")) << program;
    EXPECT_EQ(done.error().line, line) << program;
  };
  for (const char* lines :
       {"N121 #5223=[#5223+1]\n", "N121 #5221=1\n", "#5213=0\n", "#[5200+13]=1\n", "/#5213=1\n",
        "#5230=0\n", "#5230=30\nG54\n", "G54 #5230=30\n", "/#5230=30\n/G54\n", "G55 #5223=1\nG54\n",
        "G55 #5243=1\nG54\n", "#5211=0\nG92.1\n", "#5219=1\nG92.3\n"}) {
    expect_refused(pockets(lines), 13U);
  }
  for (const char* lines : {"#1=5213\n##1=1\n", "G92 Z5\n#5213=1\n", "G55\n#5250=30\nG55\nG54\n",
                            "G92 Z5\n#5213=1\nG92.1\n"}) {
    expect_refused(pockets(lines), 14U);
  }
  expect_refused("#5221=1\n" + pockets(""), 1U);
  expect_refused("#5213=1\n" + pockets(""), 1U);
  expect_refused("o1 sub\n#5213=1\no1 endsub\n" + pockets("o1 call\n"), 2U);
  for (const char* lines : {"N121 #5243=1\n", "N121 #5161=1\n", "#5250=30\nG55\nG54\n"}) {
    EXPECT_EQ(fault(shop_, pockets(lines)), "") << lines;
  }
  shop_.config.g92_on = true;
  shop_.config.g92[2] = 0.7;
  expect_refused(pockets("#5213=1\n"), 13U);
}

TEST_F(Kept, VerifyRefusesWhatIsSetByItsNumbersToo) {
  ASSERT_EQ(fault(shop_, pockets("(HERE)\n")), "");
  const std::string text = text_of_file(shop_.changed());
  for (const char* line : {"#5213=0\n", "#5230=0\n", "/#5213=0\n"}) {
    test::write_file(shop_.original(), pockets(line));
    EXPECT_THAT(shop_.fault(kThreeSteps, replaced(text, "(HERE)\n", line)),
                HasSubstr("by its numbers"))
        << line;
  }
}

TEST_F(Kept, TheNotesAreNotTheProgramsToUse) {
  for (const char* line : {"#5229=0", "#1=# 52 48", "(DEBUG,#5388)"}) {
    EXPECT_THAT(fault(shop_, pockets(std::string{line} + "\n")), HasSubstr("noted")) << line;
  }
  EXPECT_EQ(fault(shop_, pockets("#1=#5222\n#2=#5400\n")), "") << "of nothing";
}

// A refusal of the proof names the user's own program and line.
TEST_F(Kept, WhatTheProofRefusesIsNamedByTheLineOfTheOriginal) {
  for (const char* lines :
       {"G38.2 Z0 F50\n", "G10 L11 P5 Z0\n", "o1 if [#<_abs_z> GT 15.45]\nG4 P1\no1 endif\n"}) {
    const auto done = shop_.compensate(pockets(lines), kThreeSteps);
    ASSERT_FALSE(done) << lines;
    EXPECT_EQ(done.error().file, shop_.original()) << lines;
    EXPECT_GE(done.error().line, 13U) << done.error().what;
    EXPECT_LE(done.error().line, 14U) << done.error().what;
    EXPECT_THAT(done.error().to_do, Not(HasSubstr("again"))) << lines;
  }
}

TEST_F(Kept, FanucVariablesHoldNoCorrection) {
  Workshop shop;
  shop.config.dialect = read::Dialect::fanuc;
  shop.settings.method = Method::fanuc;
  const std::string program = replaced(pockets("N121 #500=#5003\n"), "N990 M2", "N990 M30");
  EXPECT_EQ(fault(shop, program), "");
  for (const char* read : {"#5023", "#5043"}) {
    EXPECT_THAT(fault(shop, replaced(program, "#5003", read)), HasSubstr(read));
  }
}

TEST_F(Kept, TheParametersOfTheInsertedLinesAreNotTheProgramsToUse) {
  for (const char* line : {"#<_steadyrest_z>=0", "#1=EXISTS[#<_Steady rest_z>]"}) {
    EXPECT_THAT(fault(shop_, pockets(std::string{line} + "\n")), HasSubstr("_steadyrest")) << line;
  }
}

}  // namespace
}  // namespace steadyrest::nc::rewrite
