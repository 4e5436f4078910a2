// SPDX-License-Identifier: Apache-2.0
// SINUMERIK 840D sl, "Job planning": DEF, PROC, R-parameters and SETMS.
#include <map>
#include <string>
#include <utility>

#include <gmock/gmock.h>

#include <steadyrest/nc/read/sinumerik/test/sinumerik_program.hpp>

namespace steadyrest::nc::read {
namespace {

using test::SinumerikProgram;
using testing::ElementsAre;
using testing::Pair;

TEST(SinumerikDefinition, ActsInOrderAndStartsAtZero) {
  SinumerikProgram program;
  program.block("N5 DEF REAL Width=2, DEPTH = width*3 , _X1 ; three of them");
  program.block("def int count");
  EXPECT_THAT(program.values.names, ElementsAre(Pair("_x1", 0.0), Pair("count", 0.0),
                                                Pair("depth", 6.0), Pair("width", 2.0)));
}

// The manual: at most 31 characters, the first two letters or underscores.
TEST(SinumerikDefinition, NeedsANameThatIsNoOtherWord) {
  const std::string longest(31, 'A');
  SinumerikProgram program;
  program.block("DEF REAL " + longest);
  for (const std::string& name :
       {longest + 'B', std::string{"X"}, std::string{"X1"}, std::string{"A1B"}, std::string{"1AB"},
        std::string{"TURN"}, std::string{"while"}, std::string{}}) {
    EXPECT_EQ(program.fault("DEF REAL " + name), "bad_name") << name;
  }
  EXPECT_EQ(program.fault("DEF REAL ,WIDTH"), "bad_name");
  EXPECT_EQ(program.fault("DEF REAL LENGTH,,DEPTH"), "bad_name");
}

TEST(SinumerikDefinition, IsRefusedForWhatItDoesNotHold) {
  SinumerikProgram program;
  const std::pair<const char*, const char*> cases[] = {{"DEF STRING[0] NOTE", "definition"},
                                                       {"DEF AXIS DRIVE", "definition"},
                                                       {"DEF WIDTH", "definition"},
                                                       {"DEF REAL AREA[3.5]", "array"},
                                                       {"X1 DEF REAL WIDTH", "definition"},
                                                       {"DEF REAL WIDTH X1", "definition"},
                                                       {"DEF REAL WIDTH=", "missing_value"},
                                                       {"PROC", "definition"},
                                                       {"PROC SUB(REAL", "bad_name"},
                                                       {"PROC SUB(REAL A INT B)", "definition"},
                                                       {"PROC SUB(VAR REAL A)", "definition"},
                                                       {"PROC SUB(REAL E) SAVE", "definition"}};
  for (const auto& [line, expected] : cases) {
    EXPECT_EQ(program.fault(line), expected) << line;
  }
  EXPECT_EQ(program.fault("PROC SUB(REAL C, INT D=3) DISPLOF"), "");
  EXPECT_EQ(program.values.names["d"], 3.0);
}

TEST(SinumerikDefinition, AnRParameterMayBeCalculated) {
  SinumerikProgram program;
  program.block("R1=2 R[1+1]=3 R03=4");
  EXPECT_THAT(program.values.numbers, ElementsAre(Pair(1, 2.0), Pair(2, 3.0), Pair(3, 4.0)));
  const std::pair<const char*, const char*> cases[] = {
      {"R=5", "missing_value"},         {"R1", "bad_assignment"},
      {"R1.5=2", "missing_value"},      {"R-1=2", "missing_value"},
      {"R[1=2", "unclosed_expression"}, {"R[1.5]=2", "no_such_parameter"},
      {"R1=", "missing_value"},         {"R1=2 X1", "assignment_and_words"}};
  for (const auto& [line, expected] : cases) {
    EXPECT_EQ(program.fault(line), expected) << line;
  }
}

TEST(SinumerikDefinition, TheFirstSpindleIsTheMaster) {
  SinumerikProgram program;
  for (const char* line : {"SETMS", "SETMS()", "SETMS(1)", "setms ( 2-1 )"}) {
    EXPECT_EQ(program.fault(line), "") << line;
  }
  EXPECT_EQ(program.fault("SETMS(2)"), "spindle_selection");
  EXPECT_EQ(program.fault("SETMS(1"), "unclosed_expression");
}

}  // namespace
}  // namespace steadyrest::nc::read
