// SPDX-License-Identifier: Apache-2.0
// SINUMERIK 840D sl, "Job planning", "Subprograms": calls and their values.
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include <steadyrest/nc/read/sinumerik/test/sinumerik_program.hpp>

namespace steadyrest::nc::read {
namespace {

using test::SinumerikProgram;

TEST(SinumerikCall, HasItsNameAsWrittenAndItsValuesByPlace) {
  SinumerikProgram program;
  program.values.numbers = {{2, 7.5}};
  const Flow& flow = program.block("N10 Pocket(1, ,R2*2) ; rough").flow();
  EXPECT_EQ(flow.kind, FlowKind::call);
  EXPECT_EQ(flow.label.view(), "Pocket");
  ASSERT_EQ(flow.count, 3U);
  EXPECT_EQ(flow.given, 0b101U);  // the second is left out
  EXPECT_EQ(flow.values[0], 1.0);
  EXPECT_EQ(flow.values[2], 15.0);
  EXPECT_EQ(flow.repeats, 1.0);
  EXPECT_EQ(program.block("POCKET").flow().count, 0U);
  EXPECT_EQ(program.block("POCKET ( )").flow().count, 0U);
  EXPECT_EQ(program.block("POCKET(,)").flow().count, 2U);
  EXPECT_EQ(program.block("POCKET(,)").flow().given, 0U);
}

TEST(SinumerikCall, OfANumberKeepsItsZerosAndMayRepeat) {
  SinumerikProgram program;
  program.values.numbers = {{2, 7.5}};
  EXPECT_EQ(program.block("L0100").flow().label.view(), "L0100");
  EXPECT_EQ(program.block("L100 P9999").flow().repeats, 9999.0);
  EXPECT_EQ(program.block("L100 P = R2*2").flow().repeats, 15.0);
  EXPECT_EQ(program.block("L100").flow().repeats, 1.0);  // not those of the call before
  for (const char* line : {"L1 P0", "L1 P10000", "L1 P1.5", "L1 P-1"}) {
    EXPECT_EQ(program.fault(line), "out_of_range") << line;
  }
}

TEST(SinumerikCall, OfACycleMayBeModal) {
  SinumerikProgram program;
  EXPECT_EQ(program.block("CYCLE81(10,0,2,-5)").flow().kind, FlowKind::cycle);
  EXPECT_EQ(program.block("cycle81(10)").flow().kind, FlowKind::cycle);
  const Flow& modal = program.block("MCALL CYCLE83(110,,4,-80)").flow();
  EXPECT_EQ(modal.kind, FlowKind::modal_cycle);
  EXPECT_EQ(modal.label.view(), "CYCLE83");
  EXPECT_EQ(modal.given, 0b1101U);
  EXPECT_EQ(program.block("MCALL").flow().kind, FlowKind::modal_cycle);
  EXPECT_EQ(program.block("MCALL").flow().label.view(), "");  // its end
  EXPECT_EQ(program.block("MCALL POCKET(1)").flow().kind, FlowKind::modal_call);
}

TEST(SinumerikCall, HasItsBlockToItself) {
  SinumerikProgram program;
  const std::pair<const char*, const char*> cases[] = {{"X5 L1", "subprogram_call"},
                                                       {"L1 X5", "subprogram_call"},
                                                       {"R1=2 L1", "subprogram_call"},
                                                       {"L1 P2 P3", "subprogram_call"},
                                                       {"L1 P1 P3", "subprogram_call"},
                                                       {"CYCLE81(1) P2", "subprogram_call"},
                                                       {"X5 MCALL", "modal_call"},
                                                       {"POCKET(1", "unclosed_expression"},
                                                       {"POCKET(1 2)", "unclosed_expression"},
                                                       {"POCKET(\"A\")", "subprogram_call"},
                                                       {"POCKET(R9)", "unset_parameter"},
                                                       {"POCKET[1]", "unknown_word"}};
  for (const auto& [line, expected] : cases) {
    EXPECT_EQ(program.fault(line), expected) << line;
  }
}

TEST(SinumerikCall, TakesThirtyValuesAndNoMore) {
  SinumerikProgram program;
  std::string values = "1";
  for (int i = 1; i < 30; ++i) {
    values += ",1";
  }
  const Flow& flow = program.block("POCKET(" + values + ")").flow();
  EXPECT_EQ(flow.count, 30U);
  EXPECT_EQ(flow.given, 0x3fffffffU);
  EXPECT_EQ(program.fault("POCKET(" + values + ",1)"), "subprogram_call");
}

}  // namespace
}  // namespace steadyrest::nc::read
