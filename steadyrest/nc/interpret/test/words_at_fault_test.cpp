// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include <steadyrest/nc/interpret/test/moves.hpp>

namespace steadyrest::nc::interpret {
namespace {

using read::Dialect;

/// The word that the refusal of a block shows, under the modes of a usual first block.
std::string word_at_fault(const std::string& block, Dialect dialect) {
  Config config;
  config.dialect = dialect;
  const std::string head = dialect == Dialect::sinumerik ? "G17 G71 G90 G94 G54\nG0 X0 Y0 Z5\n"
                                                         : "G17 G21 G90 G94 G54\nG0 X0 Y0 Z5\n";
  Kept kept;
  const auto report = run_text(head + block + "\nM30\n", config, kept);
  if (!report || report->refused.empty()) {
    return "accepted";
  }
  EXPECT_EQ(report->refused.front().line,
            3U + static_cast<unsigned>(std::count(block.begin(), block.end(), '\n')))
      << block;
  return report->refused.front().word;
}

// Other words follow and precede: neither the first nor the last of the block is to blame.
TEST(WordAtFault, IsNamedWhereSinumerikHasANameOfItsOwn) {
  const std::pair<const char*, const char*> cases[] = {{"OVR G1 X10 F500", "OVR"},
                                                       {"X10 OVR F500", "OVR"},
                                                       {"POLY", "POLY"},
                                                       {"POS=90 X1", "POS"},
                                                       {"G1 X5 AR=30 F500", "AR=30"},
                                                       {"X5 AP=30 F500", "AP=30"},
                                                       {"G1 X5 I1=3 F500", "G1"},
                                                       {"X1 A3=0.5", "A3"},
                                                       {"G2 X10 Y0 I5 J0 CR=5 F500", "CR=5"},
                                                       {"G2 X10 CR=5 I5 F500", "CR=5"},
                                                       {"G2 X10 CR=3 F500", "CR=3"},
                                                       {"G2 X0 Y0 CR=3 F500", "CR=3"},
                                                       {"G2 X10 K1 I5 F500", "K1"},
                                                       {"G1 X5 CR=5 F500", "CR=5"},
                                                       {"G1 X5 TURN=2 F500", "TURN=2"},
                                                       {"X1 TURN=0.5 G2 I5 F500", "TURN=0.5"},
                                                       {"G1 X5 F500 ADIS=-1 Y2", "ADIS=-1"},
                                                       {"X1 G505 G54 F5", "G54"},
                                                       {"X1 G70 G710 F5", "G710"},
                                                       {"X1 G64 G641 F5", "G641"},
                                                       {"G91 G1 SUPA X5 F5", "SUPA"},
                                                       {"X5 RPL=30 F5", "RPL=30"},
                                                       {"X5 D1 F9 D2", "D2"},
                                                       {"G96 X5 F5", "G96"},
                                                       {"TRANS X5\nX0 G55 Y0", "G55"},
                                                       {"TRANS X5\nY0 G500 X0", "G500"},
                                                       {"TRANS X5\nG91 Y0 X1", "X1"},
                                                       {"TRANS X5 F100 Y1", "F100"},
                                                       {"ROT X30", "X30"},
                                                       {"ROT Z30\nG0 Y5", "Y5"},
                                                       {"L1 X5", "X5"},
                                                       {"POCKET_7 X5 Y3", "POCKET_7"},
                                                       {"CYCLE81(10,0,2,-5) X5 Y3", "X5"}};
  for (const auto& [block, word] : cases) {
    EXPECT_EQ(word_at_fault(block, Dialect::sinumerik), word) << block;
  }
}

TEST(WordAtFault, IsNamedInTheOtherDialects) {
  const std::pair<const char*, const char*> fanuc[] = {{"G81 X1. K0.5 Z-1. R2. F60", "K0.5"},
                                                       {"G1 X1. P5 F60", "P5"},
                                                       {"G91 G30 P7 Z0", "P7"},
                                                       {"X5. G92 S0 F1", "S0"},
                                                       {"G84 X1. Z-5. Q1. R2. F60", "Q1."}};
  for (const auto& [block, word] : fanuc) {
    EXPECT_EQ(word_at_fault(block, Dialect::fanuc), word) << block;
  }
  const std::pair<const char*, const char*> linuxcnc[] = {{"M3 $1 S100", "$1"},
                                                          {"G1 X5 $0 F100", "$0"},
                                                          {"G18\nG0 @5 ^30", "@5"},
                                                          {"M3 $0 S9 $0", "$0"}};
  for (const auto& [block, word] : linuxcnc) {
    EXPECT_EQ(word_at_fault(block, Dialect::linuxcnc), word) << block;
  }
}

// rs274 2.9 takes and refuses these.
TEST(SpindleNumber, IsTheFirstOne) {
  for (const std::string block :
       {"M3 $0 S100", "S100 $0", "M4 $0", "M5 $0", "M19 R0 $0", "M3 S9\nG33 Z-1 K1 $0",
        "G96 D100 S50 $0", "G97 S5 $0", "M3 $[1-1] S4", "M3 $0.0 S1", "M3 $ 0 S1", "M5 $-1",
        "M4 $-1 S1", "S1 $-1", "M3 S9\nG33.1 Z-1 K1 $0"}) {
    EXPECT_EQ(word_at_fault(block, Dialect::linuxcnc), "accepted") << block;
  }
  for (const std::string block :
       {"G21 $0", "G0 X1 $0", "G4 P1 $0", "M6 T1 $0", "M48 $0", "M53 $0", "G95 $0", "$0",
        "M3 $-2 S1", "M19 R0 $-1", "G96 S50 $-1", "M51 P1 $0", "M50 P1 $0"}) {
    EXPECT_EQ(word_at_fault(block, Dialect::linuxcnc)[0], '$') << block;
  }
}

}  // namespace
}  // namespace steadyrest::nc::interpret
