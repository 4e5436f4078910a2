// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <string_view>

#include <steadyrest/nc/interpret/blocks/interpreter.hpp>
#include <steadyrest/nc/interpret/test/moves.hpp>

namespace steadyrest::nc::interpret {
namespace {

Config with_modulation(read::Dialect dialect = read::Dialect::linuxcnc, int on = 38, int off = 39) {
  Config config;
  config.dialect = dialect;
  config.modulation_on = on;
  config.modulation_off = off;
  return config;
}

constexpr std::array kDialects{read::Dialect::linuxcnc, read::Dialect::fanuc,
                               read::Dialect::sinumerik};
constexpr std::string_view kProgram =
    "G90 G94 S1000 M3\nG1 X1 F100\nM38\nG1 X2\nG1 X3 M39\nM38 G1 X4\nM30\n";

TEST(SpeedModulation, TravelsWithTheMovesFromItsBlockOn) {
  for (const auto dialect : kDialects) {
    const auto moves = moves_of(kProgram, with_modulation(dialect));
    ASSERT_EQ(moves.size(), 4U);
    // M words act before the move of their block, so M39 in the block of X3 already applies to X3.
    EXPECT_FALSE(moves[0].speed_modulation);
    EXPECT_TRUE(moves[1].speed_modulation);
    EXPECT_FALSE(moves[2].speed_modulation);
    EXPECT_TRUE(moves[3].speed_modulation);
  }
}

TEST(SpeedModulation, TakesTheWordsThatTheMachineFileNames) {
  const auto config = with_modulation(read::Dialect::fanuc, 138, 139);
  // Named words only: M38 means nothing here.
  EXPECT_TRUE(moves_of("G1 X1 F100 M138\nM30\n", config).at(0).speed_modulation);
  EXPECT_EQ(reason_of("G1 X1 F100 M38\nM30\n", config), "unknown_m_code");
}

TEST(SpeedModulation, ItsWordsStayRefusedWhereTheMachineFileDoesNotNameThem) {
  for (const auto dialect : kDialects) {
    Config config;
    config.dialect = dialect;
    EXPECT_EQ(reason_of("M38\nM30\n", config), "unknown_m_code");
    EXPECT_EQ(reason_of("M39\nM30\n", config), "unknown_m_code");
  }
}

TEST(SpeedModulation, TwoOfItsWordsInOneBlockAreRefused) {
  for (const auto dialect : kDialects) {
    EXPECT_EQ(reason_of("M38 M39\nM30\n", with_modulation(dialect)), "same_modal_group");
  }
}

TEST(SpeedModulation, AWordThatHasAMeaningIsNotTaken) {
  EXPECT_FALSE(Interpreter::make(with_modulation(read::Dialect::fanuc, 8, 9)).has_value());
  EXPECT_FALSE(Interpreter::make(with_modulation(read::Dialect::fanuc, 38, -1)).has_value());
  EXPECT_TRUE(Interpreter::make(with_modulation()).has_value());
}

}  // namespace
}  // namespace steadyrest::nc::interpret
