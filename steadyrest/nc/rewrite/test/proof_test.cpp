// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/nc/rewrite/test/pockets.hpp>
#include <steadyrest/nc/rewrite/test/workshop.hpp>

// A changed program must be right for any start state that the program does not set.
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
  EXPECT_THAT(text_of_file(shop_.changed()), HasSubstr("N175 G54\n#<_steadyrest_z>=[1/"));
}

TEST_F(Start, AbsolutePositionsAreSaid) {
  EXPECT_THAT(fault_of(pockets("", replaced(kHead, "G90 ", ""))), HasSubstr("(G90)"));
  // A mode saved by M70 before the program set it comes back with M72.
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

// The text checks it too: it stops if the offset has been rotated since, or in G7.
TEST_F(Start, XAndYAreCorrectedAlongTheMachinesAxesAlone) {
  shop_.config.start_known = true;
  const std::string in_x = replaced(kThreeSteps, R"({"tr)", R"({"axis": "X", "tr)");
  ASSERT_EQ(fault(shop_, pockets(""), in_x), "");
  const std::string text = text_of_file(shop_.changed());
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

// The axis is no longer where the program sent it.
TEST_F(Start, RestatesNothingBehindATool) {
  shop_.settings.window_s = 6.0;
  const std::string plan =
      R"({"transitions": [{"n": 2, "t_min": [0.62, 0.62], "delta_um": [0, 50]}]})";
  const std::string program =
      kHead + "G0 X0 Y0 Z10\nG1 X50 F100\nG43 H2\nG0 X0 Y1\nG0 X1\nG1 X50\nG0 Z20\nM2\n";
  EXPECT_THAT(fault(shop_, program, plan), HasSubstr("no safe place"));
  EXPECT_EQ(fault(shop_, replaced(program, "G43 H2\n", ""), plan), "");
  // The length and the shift in force at the start are unknown, whatever the files say.
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

// A note holds as long as work offset plus G92 are unchanged.
TEST_F(Start, AShiftOfTheProgramIsNotedWhateverItWasBefore) {
  for (const char* line : {"G92.1", "G92.2", "G92.3", "G92 X0", "G52 Z0", "G52 X1"}) {
    ASSERT_EQ(fault_of(pockets("N121 " + std::string{line} + "\n")), "") << line;
    EXPECT_THAT(text_of_file(shop_.changed()),
                HasSubstr("set since)\nN121 " + std::string{line} + "\n#[5208"));
  }
}

// A note that is not renewed stops the program at its next change.
TEST_F(Start, TheProofSimulatesAShiftThatNoProgramKnows) {
  ASSERT_EQ(fault_of(pockets("N121 G92.1\n")), "");
  const std::string text = text_of_file(shop_.changed());
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

// G55 does nothing on a control already in G55.
TEST_F(Start, AnyWorkOffsetMayBeInForceUntilTheProgramSaysWhich) {
  EXPECT_THAT(fault_of("#5250=30\nG55\n" + pockets("")), HasSubstr("by its numbers"));
  EXPECT_EQ(fault_of("G54\n#5250=30\nG55\n" + pockets("")), "");
}

}  // namespace
}  // namespace steadyrest::nc::rewrite
