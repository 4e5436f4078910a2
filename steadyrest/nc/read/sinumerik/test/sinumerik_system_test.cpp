// SPDX-License-Identifier: Apache-2.0
// The system variables by which a program corrects an axis. 840D sl, "System variables":
// $P_IFRAME[axis,FI], $P_UIFR[number,axis,FI], $SA_TEMP_COMP_ABS_VALUE[axis].
#include <string>

#include <gtest/gtest.h>

#include <steadyrest/nc/read/sinumerik/test/sinumerik_program.hpp>

namespace steadyrest::nc::read {
namespace {

using test::SinumerikProgram;

std::string stored(const std::string& axis) {
  return "$P_IFRAME[" + axis + ",FI]=$P_UIFR[$P_UIFRNUM," + axis + ",FI]";
}

/// The value of the one word of a line, for an axis.
double fine_value(const std::string& line, char axis) {
  SinumerikProgram program;
  program.values.numbers = {{1, 0.5}};
  const auto words = program.block(line).words();
  EXPECT_EQ(words.size(), 1U) << line;
  const Word word = words.empty() ? Word{} : words[0];
  EXPECT_EQ(word.letter, axis) << line;
  EXPECT_EQ(word.qualifier, Qualifier::fine) << line;
  EXPECT_TRUE(word.has_value) << line;
  return word.value;
}

TEST(SinumerikSystem, AFineOffsetIsWhatIsAddedToTheStoredOne) {
  EXPECT_EQ(fine_value(stored("Z") + "-0.01", 'Z'), -0.01);
  EXPECT_EQ(fine_value(stored("X") + "+0.025 ; warm", 'X'), 0.025);
  EXPECT_EQ(fine_value(stored("C") + "-R1*2", 'C'), -1.0);
  EXPECT_EQ(fine_value(stored("C") + "+R1*2", 'C'), 1.0);
  EXPECT_EQ(fine_value(stored("Y"), 'Y'), 0.0);  // the stored one alone
  EXPECT_EQ(fine_value("$p_iframe [ y , fi ] = $P_UIFR[ $P_UIFRNUM, Y ,FI] + 1", 'Y'), 1.0);
}

TEST(SinumerikSystem, AFrameInAnyOtherFormIsRefused) {
  SinumerikProgram program;
  for (const char* line :
       {"$P_IFRAME[X,FI]=$P_UIFR[$P_UIFRNUM,Y,FI]+1", "$P_IFRAME[X,TR]=$P_UIFR[$P_UIFRNUM,X,TR]+1",
        "$P_IFRAME[X,FI]=$P_UIFR[1,X,FI]+1", "$P_IFRAME[X1,FI]=$P_UIFR[$P_UIFRNUM,X1,FI]",
        "$P_IFRAME[X,FI]=0.01", "$P_IFRAME=$P_UIFR[1]", "$P_IFRAME[E,FI]=$P_UIFR[$P_UIFRNUM,E,FI]",
        "$P_IFRAME[X,FI]=$P_UIFR[$P_UIFRNUM,X,FI]*2", "$P_PFRAME[X,FI]=1", "$AA_OFF[X]=1"}) {
    EXPECT_EQ(program.fault(line), "parameter") << line;
  }
  EXPECT_EQ(program.fault(stored("X") + "+R7"), "unset_parameter");
}

TEST(SinumerikSystem, TheTemperatureValueMovesNoWord) {
  SinumerikProgram program;
  program.values.numbers = {{1, 0.5}};
  EXPECT_TRUE(program.block("$SA_TEMP_COMP_ABS_VALUE[X]=0.012").words().empty());
  EXPECT_TRUE(program.block("N5 $sa_temp_comp_abs_value[z] = -R1/2 ; up").words().empty());
  for (const char* line : {"$SA_TEMP_COMP_ABS_VALUE=1", "$SA_TEMP_COMP_ABS_VALUE[AX3]=1",
                           "$SA_TEMP_COMP_ABS_VALUE[X]", "$SA_TEMP_COMP_ABS_VALUE[]=1"}) {
    EXPECT_EQ(program.fault(line), "parameter") << line;
  }
  EXPECT_EQ(program.fault("$SA_TEMP_COMP_ABS_VALUE[X]="), "missing_value");
}

TEST(SinumerikSystem, ItsAssignmentHasItsBlockToItself) {
  SinumerikProgram program;
  EXPECT_EQ(program.fault("X1 " + stored("X")), "parameter");
  EXPECT_EQ(program.fault("L1 " + stored("X")), "parameter");
  EXPECT_EQ(program.fault("R1=2 " + stored("X")), "parameter");
  EXPECT_EQ(program.fault(stored("X") + " " + stored("Y")), "parameter");
  EXPECT_EQ(program.fault(stored("X") + "+1 Y1"), "assignment_and_words");
  EXPECT_EQ(program.fault("$SA_TEMP_COMP_ABS_VALUE[X]=1 Y1"), "assignment_and_words");
}

}  // namespace
}  // namespace steadyrest::nc::read
