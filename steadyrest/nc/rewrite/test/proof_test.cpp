// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/nc/rewrite/test/workshop.hpp>

// What a changed program must hold for: both positions of block delete, a start that the program
// does not say, and everything that the control keeps when the program is over.
namespace steadyrest::nc::rewrite {
namespace {

using test::kPasses;
using test::read_file;
using test::replaced;
using test::Workshop;
using ::testing::AllOf;
using ::testing::HasSubstr;

const std::string kHead = "N10 G17 G21 G90 G94 G54\nN20 T1 M6\nN30 G43 H1\nN40 S1000 M3\n";
/// Clearances between Z50 and a rapid to Z60; `/N90` leads to Z2 where it is not skipped.
const std::string kClamp =
    kHead +
    "N50 G0 X0 Y0 Z10\nN60 G1 Z-1 F200\nN70 G1 X50\nN80 G0 Z50\n/N90 G0 Z2\nN95 G4 P20\n"
    "N100 G0 X0 Y0\nN110 G0 X100 Y0\nN120 G0 X100 Y50\nN130 G4 P20\nN140 G1 X60 F100\n"
    "N160 G0 Z60\nN170 M2\n";
const std::string kOneStep =
    R"({"transitions": [{"n": 2, "t_min": [0.735, 0.70], "delta_um": [0, 50]}]})";
const std::string kThreeSteps =
    R"({"transitions": [{"n": 3, "t_min": [0.71, 0.71, 0.95], "delta_um": [0, 100, -150]}]})";

/// Three pockets; `between` follows the second. 2.4 min.
std::string pockets(const std::string& between, const std::string& head = kHead) {
  return head +
         "N50 G0 X0 Y0 Z10\nN60 G1 Z-1 F200\nN70 G1 X50\nN80 G0 Z20\nN90 G0 X0 Y10\n"
         "N100 G1 Z-2\nN110 G1 X50 F100\nN120 G0 Z15\n" +
         between +
         "N130 G0 X0 Y20\nN140 G0 X1 Y20\nN150 G1 Z-3\nN160 G1 X60 F100\nN170 G0 Z25\n"
         "N180 G0 X0\nN190 G1 Z-1\nN200 G1 X30\nN210 G0 Z30\nN990 M2\n";
}

std::string fault(const Workshop& shop, const std::string& program,
                  const std::string& plan = kThreeSteps) {
  const auto done = shop.compensate(program, plan);
  return done ? "" : done.error().what;
}

class Switch : public ::testing::Test {
 protected:
  Switch() { shop_.settings.window_s = 6.0; }
  Workshop shop_;
};

TEST_F(Switch, RestatesNoAxisThatStandsElsewhereWhenLinesAreSkipped) {
  EXPECT_THAT(fault(shop_, kClamp, kOneStep),
              AllOf(HasSubstr("no safe place"), HasSubstr("block delete on and off")));
  shop_.config.block_delete = true;
  EXPECT_THAT(fault(shop_, kClamp, kOneStep), HasSubstr("no safe place"));
  const std::string always = replaced(kClamp, "/N90", "N90");
  EXPECT_EQ(fault(shop_, always, kOneStep), "");
}

TEST_F(Switch, MovesOnToAPlaceThatIsOneInBothPositions) {
  const auto done =
      shop_.compensate(replaced(kClamp, "N110 G0 X100 Y0", "N110 G0 X100 Y0 Z50"), kOneStep);
  ASSERT_TRUE(done) << done.error().what;
  EXPECT_EQ(done->insertions.front().site, Site::rapid);
  EXPECT_THAT(read_file(shop_.changed()), HasSubstr("noted)\nN110 G0"));
}

TEST_F(Switch, ProvesForBothPositions) {
  const std::string always = replaced(kClamp, "/N90", "N90");
  ASSERT_TRUE(shop_.compensate(always, kOneStep));
  const std::string text = read_file(shop_.changed());
  test::write_file(shop_.original(), kClamp);
  EXPECT_THAT(shop_.fault(kOneStep, replaced(text, "\nN90", "\n/N90")), HasSubstr("no safe place"));
}

// Each switches what the lines behind it mean.
TEST_F(Switch, PlacesNothingWhoseMeaningTheSwitchChanges) {
  EXPECT_EQ(fault(shop_, replaced(kClamp, "/N90 G0 Z2\n", ""), kOneStep), "");
  for (const char* line : {"/G20", "/G91", "/G55", "/G10 L2 P1 Z3", "/G92 Z1", "/G41.1 D1 G1 X70",
                           "/G93", "/G81 X1 Z-1 R2", "/G7"}) {
    const std::string what =
        fault(shop_, replaced(kClamp, "/N90 G0 Z2\n", std::string{line} + "\n"), kOneStep);
    EXPECT_THAT(what, HasSubstr("no safe place")) << line << "\n" << read_file(shop_.changed());
  }
}

TEST_F(Switch, ASkippedLineSaysNothing) {
  shop_.settings.window_s = 60.0;
  const std::string program = replaced(kClamp, "/N90 G0 Z2\n", "");
  EXPECT_EQ(fault(shop_, program, kOneStep), "");
  EXPECT_THAT(fault(shop_, replaced(program, " G54", "\n/G54"), kOneStep),
              HasSubstr("which work offset"));
  EXPECT_THAT(fault(shop_, replaced(program, " G90", "\n/G90"), kOneStep), HasSubstr("G90"));
}

TEST_F(Switch, TheEndIsWhereBothPositionsEnd) {
  shop_.config.block_delete = true;
  EXPECT_THAT(fault(shop_, replaced(kClamp, "/N90 G0 Z2\n", "/M2\n"), kOneStep),
              HasSubstr("no safe place"));
  shop_.config.block_delete = false;
  shop_.settings.window_s = 60.0;
  EXPECT_THAT(fault(shop_, replaced(kPasses, "M30\n", "/M30\nG0 Z30\nM30\n"), test::kGrowth),
              HasSubstr("ends"));
}

TEST_F(Switch, RefusesWhatCannotBeRunWithTheLinesSkipped) {
  EXPECT_THAT(fault(shop_, replaced(kClamp, "N170 M2", "/N170 M2"), kOneStep),
              HasSubstr("with block delete (lines with / skipped)"));
}

TEST_F(Switch, HoldsOnEveryControl) {
  for (const read::Dialect dialect : {read::Dialect::fanuc, read::Dialect::sinumerik}) {
    Workshop shop;
    shop.config.dialect = dialect;
    const bool fanuc = dialect == read::Dialect::fanuc;
    shop.settings.method = fanuc ? Method::fanuc : Method::frame_fine;
    shop.settings.window_s = 6.0;
    std::string program = replaced(kClamp, "N30 G43 H1\n", fanuc ? "N30 G43 H1\n" : "N30 D1\n");
    const std::string dwell = fanuc ? "G4 P20000" : "G4 F20";
    program = replaced(replaced(program, "G4 P20", dwell), "G4 P20\n", dwell + "\n");
    program = replaced(replaced(program, "G21 ", fanuc ? "G21 " : "G71 "), "N170 M2", "N170 M30");
    EXPECT_THAT(fault(shop, program, kOneStep), HasSubstr("no safe place"));
    EXPECT_EQ(fault(shop, replaced(program, "/N90", "N90"), kOneStep), "");
  }
}

TEST(OptionalStop, ChangesNothing) {
  EXPECT_EQ(fault(Workshop{}, pockets("M1\n")), "");
}

class Start : public ::testing::Test {
 protected:
  [[nodiscard]] std::string fault_of(const std::string& program) const {
    return fault(shop_, program);
  }
  Workshop shop_;
};

TEST_F(Start, TheWorkOffsetIsSaidBeforeTheFirstPlace) {
  shop_.settings.window_s = 23.0;
  const std::string late =
      replaced(replaced(pockets(""), "G94 G54", "G94"), "N180", "N175 G54\nN180");
  EXPECT_THAT(fault_of(late), HasSubstr("has not said which work offset is active"));
  shop_.config.start_known = true;
  shop_.config.active_offset = 1;
  shop_.config.work_offset[1][2] = 5.0;
  ASSERT_EQ(fault_of(late), "");
  EXPECT_THAT(read_file(shop_.changed()), HasSubstr("N175 G54\n#<_steadyrest_z>=[1/"));
}

TEST_F(Start, AbsolutePositionsAreSaid) {
  EXPECT_THAT(fault_of(pockets("", replaced(kHead, "G90 ", ""))), HasSubstr("(G90)"));
  // What M70 has kept before it was said comes back with M72.
  const std::string head = replaced(replaced(kHead, "G90 ", ""), "N20", "M70\nG90\nN20");
  EXPECT_THAT(fault_of(pockets("", head)), HasSubstr("(G90)"));
}

TEST_F(Start, AStoredRotationIsKnownForWhatIsTurnedByIt) {
  const std::string in_x = replaced(kThreeSteps, R"({"tr)", R"({"axis": "X", "tr)");
  EXPECT_THAT(fault(shop_, pockets(""), in_x), HasSubstr("a rotation is stored"));
  EXPECT_EQ(fault(shop_, pockets(""), kThreeSteps), "") << "Z does not turn";
  shop_.config.start_known = true;
  EXPECT_EQ(fault(shop_, pockets(""), in_x), "");
  shop_.config.rotation_deg[0] = 30.0;
  EXPECT_THAT(fault(shop_, pockets(""), in_x), HasSubstr("no safe place"));
  EXPECT_EQ(fault(shop_, pockets(""), kThreeSteps), "") << "Z does not turn";
}

// The text checks it too: whoever has turned the offset since, or is in G7, is stopped.
TEST_F(Start, XAndYAreCorrectedAlongTheMachinesAxesAlone) {
  shop_.config.start_known = true;
  const std::string in_x = replaced(kThreeSteps, R"({"tr)", R"({"axis": "X", "tr)");
  ASSERT_EQ(fault(shop_, pockets(""), in_x), "");
  const std::string text = read_file(shop_.changed());
  EXPECT_THAT(text, HasSubstr("AND [[ABS[#[5210+20*#5220]]+#<_lathe_diameter_mode>] EQ 0]"));
  EXPECT_THAT(text, HasSubstr("o<steadyrest_x3> if [#<_lathe_diameter_mode> NE 0] (STEADYREST"));
  for (std::size_t at = 0, end = 0; at < text.size(); at = end + 1) {
    end = text.find('\n', at);
    EXPECT_LE(end - at, 250U) << "too long for LinuxCNC: " << text.substr(at, end - at);
  }
  EXPECT_THAT(fault(shop_, pockets("N121 G7\n"), in_x), HasSubstr("diameter"));
}

TEST_F(Start, ALatheSaysWhetherXIsARadius) {
  shop_.config.axes = "XZ";
  shop_.config.start_known = true;
  const std::string in_x = replaced(kThreeSteps, R"({"tr)", R"({"axis": "X", "tr)");
  const std::string turning =
      "G18 G21 G90 G94 G54\nG0 X50 Z5\nG1 X0 F40\nG0 X50\nG1 X10\nG0 X60\nM2\n";
  EXPECT_THAT(fault(shop_, turning, in_x), HasSubstr("G8"));
  EXPECT_EQ(fault(shop_, "G8 " + turning, in_x), "");
}

// The axis is no longer where the program has sent it.
TEST_F(Start, RestatesNothingBehindATool) {
  shop_.settings.window_s = 6.0;
  const std::string plan =
      R"({"transitions": [{"n": 2, "t_min": [0.62, 0.62], "delta_um": [0, 50]}]})";
  const std::string program =
      kHead + "G0 X0 Y0 Z10\nG1 X50 F100\nG43 H2\nG0 X0 Y1\nG0 X1\nG1 X50\nG0 Z20\nM2\n";
  EXPECT_THAT(fault(shop_, program, plan), HasSubstr("no safe place"));
  EXPECT_EQ(fault(shop_, replaced(program, "G43 H2\n", ""), plan), "");
  // The length and the shift that were in force at the start are not known, whatever files are.
  shop_.config.tools.emplace(2);
  shop_.config.tools->front().number = 1;
  shop_.config.tools->back().number = 2;
  for (const bool known : {false, true}) {
    shop_.config.start_known = known;
    for (const char* line :
         {"G43 H2", "G43.1 Z0", "G49", "M61 Q2", "G92.1", "G92.2", "G92.3", "G52 Z0", "G92 X0"}) {
      EXPECT_THAT(fault(shop_, replaced(program, "G43 H2", line), plan), HasSubstr("no safe place"))
          << line;
    }
  }
}

// A note holds as long as work offset plus G92 are what they were.
TEST_F(Start, AShiftOfTheProgramIsNotedWhateverItWasBefore) {
  for (const char* line : {"G92.1", "G92.2", "G92.3", "G92 X0", "G52 Z0", "G52 X1"}) {
    ASSERT_EQ(fault_of(pockets("N121 " + std::string{line} + "\n")), "") << line;
    EXPECT_THAT(read_file(shop_.changed()),
                HasSubstr("set since)\nN121 " + std::string{line} + "\n#[5208"));
  }
}

// A note that is not renewed stops the program at its next change.
TEST_F(Start, TheProofSimulatesAShiftThatNoProgramKnows) {
  ASSERT_EQ(fault_of(pockets("N121 G92.1\n")), "");
  const std::string text = read_file(shop_.changed());
  const auto line = text.find("N121");
  const auto note = text.find('\n', line) + 1;
  EXPECT_NE(shop_.fault(kThreeSteps, text.substr(0, note) + text.substr(text.find('\n', note) + 1)),
            "");
}

TEST_F(Start, RefusesValuesThatAreTheControlsOwn) {
  for (const char* line :
       {"#1=#100", "#1=#5221", "#1=#5161", "#1=#<_abs_z>", "#1=#5063", "#1=#5399",
        "#1=EXISTS[#<_mine>]", "#1=#<_feed_override>", "#1=#5403", "#1=#5211"}) {
    EXPECT_THAT(fault_of(pockets(std::string{line} + "\n")), HasSubstr("uses ")) << line;
  }
  for (const char* line :
       {"#100=1 #101=#100", "#100=1\n#101=#100", "#1=#<_z>", "#1=#5422", "#1=#<_metric>",
        "#1=#<_coord_system>", "#<_mine>=1\n#1=EXISTS[#<_mine>]"}) {
    const bool unset = std::string{line}.starts_with("#100=1 #");
    EXPECT_EQ(fault_of(pockets(std::string{line} + "\n")).empty(), !unset) << line;
  }
  EXPECT_THAT(fault_of("#1=#<_metric>\n" + pockets("")), HasSubstr("a mode of the control"));
  EXPECT_THAT(fault_of("#1=#<_z>\n" + pockets("")), HasSubstr("the position of Z"));
}

TEST_F(Start, KnowsWhatTheVariableFileHolds) {
  shop_.config.start_known = true;
  shop_.config.numbers = {{100, 7.0}};
  EXPECT_EQ(fault_of(pockets("#1=#100\n#2=#5221\n#3=#5161\n")), "");
  EXPECT_THAT(fault_of(pockets("#1=#101\n")), HasSubstr("uses #101"));
}

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

// By numbers alone they wait until the control takes them up, together with the next correction.
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

// G55 does nothing in a control that is in G55 already.
TEST_F(Start, AnyWorkOffsetMayBeInForceUntilTheProgramSaysWhich) {
  EXPECT_THAT(fault_of("#5250=30\nG55\n" + pockets("")), HasSubstr("by its numbers"));
  EXPECT_EQ(fault_of("G54\n#5250=30\nG55\n" + pockets("")), "");
}

TEST_F(Kept, VerifyRefusesWhatIsSetByItsNumbersToo) {
  ASSERT_EQ(fault(shop_, pockets("(HERE)\n")), "");
  const std::string text = read_file(shop_.changed());
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
