// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include <steadyrest/nc/interpret/test/moves.hpp>

// Haas beside FANUC: the same decoder with Haas's tables. Haas mill operator's manual.
namespace steadyrest::nc::interpret {
namespace {

Config shop(read::Dialect dialect) {
  Config config;
  config.dialect = dialect;
  config.unit_known = true;
  return config;
}
const Config kHaasShop = shop(read::Dialect::haas);
const Config kFanucShop = shop(read::Dialect::fanuc);

const std::string kBegin = "%\nO01234 (PART)\nG20 G90 G17 G40 G49 G80 G50 G69 G15\n";

std::string haas_fault(const std::string& text) {
  return reason_of(kBegin + text + "\nM30\n%\n", kHaasShop);
}

TEST(Haas, ReadsTheQuietWordsOfItsPrograms) {
  EXPECT_EQ(
      haas_fault("G103 P1\nG187 P3 E0.002\nG5.1 Q1\nG8 P1\nG64\nG0 X1. Y1.\nM31\nM33\nM83\nM84\n"
                 "M88\nM89\nM80\nM81\nM10\nM11\nM12\nM13\nM41\nM42\nM104\nM105\nG103"),
      "");
  EXPECT_EQ(haas_fault("M19\nM19 P90.\nG0 G43 H1 D1 Z1.\nX1. M8"), "");
}

TEST(Haas, NamesWhatItDoesNotInterpret) {
  for (const char* text : {"G12 I1. Z-1. D1 F9.", "G150 P100", "G47 P0", "G234", "G254", "G36",
                           "G184", "G77 Z-1. R1. F9."}) {
    EXPECT_EQ(haas_fault(text), "g_code_not_interpreted") << text;
  }
  for (const char* text : {"M21", "M51", "M59 P1"}) {
    EXPECT_EQ(haas_fault(text), "machine_builders_code") << text;
  }
  EXPECT_EQ(haas_fault("M97 P100"), "flow_control");
  EXPECT_EQ(haas_fault("G65 P9810 Z1."), "macro_call");
  EXPECT_EQ(reason_of("G187 P1\nM30\n", kFanucShop), "unknown_g_code");
  EXPECT_EQ(reason_of("G103 P1\nM30\n", kFanucShop), "unknown_g_code");
}

TEST(Haas, SelectsAdditionalOffsetsByG154AndG110) {
  const auto offset_of = [](const std::string& words, const Config& config) {
    return moves_of("G90 G10 L20 P2 X10. Y20.\n" + words + "\nG0 X1. Y1.\nM30\n", config)
        .back()
        .offset[0];
  };
  EXPECT_EQ(offset_of("G154 P2", kHaasShop), 10.0);
  EXPECT_EQ(offset_of("G54.1 P2", kHaasShop), 10.0);
  EXPECT_EQ(offset_of("G111", kHaasShop), 10.0);
  EXPECT_EQ(offset_of("G54.1 P2", kFanucShop), 10.0);
  EXPECT_EQ(offset_of("G54.1 P1", kFanucShop), 0.0);
  EXPECT_EQ(offset_of("G54.1 P2\nG91 G10 L20 P2 X5.\nG90", kFanucShop), 15.0);
  EXPECT_EQ(offset_of("G54.1 P2\nG54", kFanucShop), 0.0);
  EXPECT_EQ(haas_fault("G154 P100"), "out_of_range");
  EXPECT_EQ(haas_fault("G154"), "out_of_range");
  EXPECT_EQ(reason_of("G54.1 P300\nM30\n", kFanucShop), "");
  EXPECT_EQ(reason_of("G10 L20 P301 X1.\nM30\n", kFanucShop), "g10_form");
}

TEST(Haas, KeepsG10P0ForG52AndFanucTheExternalOffset) {
  EXPECT_EQ(haas_fault("G10 L2 P0 X1."), "g10_form");
  EXPECT_EQ(reason_of("G10 L2 P0 X1.\nM30\n", kFanucShop), "");
}

TEST(Haas, TakesToolRegistersByG10) {
  Config config = kHaasShop;
  config.tools = std::vector<Tool>{{.number = 3, .offset = {0, 0, 50}}};
  const auto length_of = [&config](const std::string& text) {
    return moves_of(text + "\nG43 H3\nG0 Z1.\nM30\n", config).back().offset[2];
  };
  EXPECT_EQ(length_of("G10 L10 P3 R60."), 60.0);
  EXPECT_EQ(length_of("G91 G10 L10 P3 R5.\nG90"), 55.0);
  EXPECT_EQ(length_of("G44 H3\nG43 H3"), 50.0);
  EXPECT_EQ(moves_of("G44 H3\nG0 Z1.\nM30\n", config).back().offset[2], -50.0);
  EXPECT_EQ(reason_of("G10 L12 P3 R5.\nM30\n", config), "g10_form");
  EXPECT_EQ(haas_fault("G10 L12 P3 R5.\nG10 L13 P3 R0\nG10 L11 P3 R0"), "") << "no tool table";
  EXPECT_EQ(haas_fault("G10 L10 P3"), "g10_form");
}

TEST(Haas, MovesInMachineCoordinatesByTheMotionWordInForce) {
  const auto kinds = [](const std::string& text) {
    std::vector<MoveKind> out;
    for (const Move& move : moves_of(text, kHaasShop)) {
      out.push_back(move.kind);
    }
    return out;
  };
  EXPECT_THAT(kinds("G0 X1.\nG53 G1 Z0 F9.\nX2.\nM30\n"),
              testing::ElementsAre(MoveKind::rapid, MoveKind::linear, MoveKind::linear));
  EXPECT_THAT(kinds("G1 X1. F9.\nG0 G53 Z0\nX2.\nM30\n"),
              testing::ElementsAre(MoveKind::linear, MoveKind::rapid, MoveKind::rapid));
}

TEST(Haas, GoesHomeWithAllAxesByG28Alone) {
  EXPECT_EQ(haas_fault("G28"), "");
  EXPECT_EQ(reason_of("G28\nM30\n", kFanucShop), "axis_words_missing");
}

TEST(Haas, MirrorsByG101) {
  EXPECT_EQ(moves_of("G90 G101 X0\nG0 X5. Y1.\nM30\n", kHaasShop).back().end[0], -5.0);
  EXPECT_EQ(moves_of("G90 G101 X0\nG0 X5. Y1.\nG100\nX5.\nM30\n", kHaasShop).back().end[0], 5.0);
}

TEST(Haas, NamesALengthWithoutItsPointAsAssumed) {
  Kept kept;
  const auto assumed = [&kept](const std::string& text, const Config& config) {
    const auto report = run_text("G21 " + text + "\nM30\n", config, kept);
    return report && !report->assumed.empty() ? report->assumed.front().what : std::string{};
  };
  EXPECT_EQ(assumed("G0 X0 Y0 Z1.", kHaasShop), "");
  EXPECT_EQ(assumed("G0 X1", kHaasShop), "decimal_point");
  EXPECT_EQ(assumed("G0 X1", kFanucShop), "");
  Config increments = kHaasShop;
  increments.decimal_rule = DecimalRule::least_increment;
  EXPECT_EQ(assumed("G0 X1000", increments), "");
  EXPECT_EQ(kept.moves.back().end[0], 1.0);
}

TEST(Fanuc, ReadsInverseTimeAndTheBuildersClamps) {
  EXPECT_EQ(reason_of("G93 G1 X1. F2.\nG94\nM10\nM11\nM19\nG62 G5.1 Q0\nG5 P10000\nG5 P0\nM30\n",
                      kFanucShop),
            "");
  EXPECT_EQ(reason_of("M31\nM30\n", kFanucShop), "unknown_m_code");
}

}  // namespace
}  // namespace steadyrest::nc::interpret
