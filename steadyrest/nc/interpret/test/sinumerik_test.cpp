// SPDX-License-Identifier: Apache-2.0
// Variables, expressions, subprograms and cycles of the dialect `sinumerik`.
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <unistd.h>

#include <steadyrest/nc/interpret/test/moves.hpp>

namespace steadyrest::nc::interpret {
namespace {

using testing::ElementsAre;

Config sinumerik() {
  Config config;
  config.dialect = read::Dialect::sinumerik;
  return config;
}

std::vector<double> along(std::size_t axis, const std::string& text,
                          const Config& config = sinumerik()) {
  return ends_along(axis, text, config);
}
std::vector<double> sinumerik_x_of(const std::string& text, const Config& config = sinumerik()) {
  return ends_along(0, text, config);
}
double r_value_of(const std::string& expression) {
  return sinumerik_x_of("R1=" + expression + "\nG0 X=R1\nM30\n").at(0);
}
std::string reason_of_block(const std::string& text) {
  return reason_of(text + "\nM30\n", sinumerik());
}

/// A folder with subprograms, gone at the end.
class Folder {
 public:
  Folder() { std::filesystem::create_directory(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  ~Folder() { std::filesystem::remove_all(path_); }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name) << text;
  }
  [[nodiscard]] Config config() const {
    Config config = sinumerik();
    config.subprogram_folders = {path_.string()};
    return config;
  }

 private:
  std::filesystem::path path_ =
      std::filesystem::temp_directory_path() / ("nc-sinumerik-" + std::to_string(::getpid()));
};

// SINUMERIK 840D sl "Job planning", "Priority of the operations".
TEST(SinumerikValues, HaveThePrioritiesOfTheManual) {
  EXPECT_EQ(r_value_of("1+2*3"), 7.0);
  EXPECT_EQ(r_value_of("(1+2)*3"), 9.0);
  EXPECT_EQ(r_value_of("7 DIV 2*2"), 6.0);
  EXPECT_EQ(r_value_of("8-2-1"), 5.0);
  EXPECT_EQ(r_value_of("1+2==3"), 1.0);            // comparisons are the weakest
  EXPECT_EQ(r_value_of("1 B_OR 2 B_AND 2"), 3.0);  // B_AND before B_OR
  EXPECT_EQ(r_value_of("4 B_OR 1+2"), 7.0);        // + before the bits
  EXPECT_EQ(r_value_of("1 OR 0 AND 0"), 1.0);
  EXPECT_EQ(r_value_of("NOT 0 AND 0"), 0.0);
  EXPECT_EQ(r_value_of("-2+5"), 3.0);
  EXPECT_EQ(r_value_of("-(2+5)"), -7.0);
}

// The same manual, "Arithmetic operations": 3/4=0.75, 3 DIV 4=0, 3 MOD 4=3;
// ATAN2(30.5,80.1)=20.8455.
TEST(SinumerikValues, AreThoseThatTheManualPrints) {
  EXPECT_EQ(r_value_of("3/4"), 0.75);
  EXPECT_EQ(r_value_of("3 DIV 4"), 0.0);
  EXPECT_EQ(r_value_of("3 MOD 4"), 3.0);
  EXPECT_NEAR(r_value_of("ATAN2(30.5,80.1)"), 20.8455, 5e-5);
  EXPECT_EQ(r_value_of("POT(5)"), 25.0);
  EXPECT_EQ(r_value_of("TRUNC(-2.7)+ROUND(2.5)"), 1.0);
  EXPECT_EQ(r_value_of("SQRT(POT(3)+POT(4))"), 5.0);
  EXPECT_EQ(r_value_of("-0.1EX-5*1EX6"), -1.0);
  EXPECT_EQ(r_value_of("BOUND(1,5,9)+MINVAL(1,2)+MAXVAL(1,2)"), 8.0);
  EXPECT_NEAR(r_value_of("ACOS(0.5)"), 60.0, 1e-12);
}

// The manual's example of TRUNC: R1=61.01 R2=61.02 R3=0.01, its comparison is not fulfilled.
TEST(SinumerikValues, CompareWithARelativeTolerance) {
  EXPECT_EQ(sinumerik_x_of("R1=61.01 R2=61.02 R3=0.01\nR4=ABS((R2-R1)/R3-1)>10EX-5\n"
                           "G0 X=R4\nM30\n")
                .at(0),
            0.0);
  EXPECT_EQ(sinumerik_x_of("R1=0.1+0.2\nR2=R1==0.3\nG0 X=R2\nM30\n").at(0), 1.0);
}

TEST(SinumerikValues, StandInEveryAddress) {
  const auto moves = moves_of(
      "DEF REAL WIDTH=20, FEED\nDEF INT COUNT=2.6\nDEF BOOL _ON=7\nFEED=WIDTH*10\nR[1+1]=COUNT\n"
      "G1 X=WIDTH/2 Y=AC(R2) Z=IC(-_ON) F=FEED\nG2 X=WIDTH CR=WIDTH/4\nG4 F=R2/2\n"
      "G3 X=IC(-10) I=AC(WIDTH-5) J=0 TURN=COUNT\nM30\n",
      sinumerik());
  ASSERT_EQ(moves.size(), 4U);
  // 20/2; INT rounds 2.6 to 3; BOOL 7 is 1; 20·10 mm/min; TURN=3 is four turns in all.
  EXPECT_EQ(moves[0].end[0], 10.0);
  EXPECT_EQ(moves[0].end[1], 3.0);
  EXPECT_EQ(moves[0].end[2], -1.0);
  EXPECT_DOUBLE_EQ(moves[0].feed_mm_s, 200.0 / 60.0);
  EXPECT_EQ(moves[1].centre_mm[0], 15.0);
  EXPECT_EQ(moves[2].dwell_s, 1.5);
  EXPECT_EQ(moves[3].turns, 4);
}

TEST(SinumerikValues, AreRefusedWhereTheyAreNotKnown) {
  EXPECT_EQ(reason_of_block("G0 X=R1"), "unset_parameter");
  EXPECT_EQ(reason_of_block("G0 X=WIDTH"), "variable");
  EXPECT_EQ(reason_of_block("WIDTH=5"), "variable");
  EXPECT_EQ(reason_of_block("R1000=5"), "no_such_parameter");
  EXPECT_EQ(reason_of_block("R1=5 R2=R1"), "order_of_assignments");
  EXPECT_EQ(reason_of_block("R1=5 X1"), "assignment_and_words");
  EXPECT_EQ(reason_of_block("G0 X1 R1=5"), "assignment_and_words");
  EXPECT_EQ(reason_of_block("DEF REAL AREA[3]"), "array");
  EXPECT_EQ(reason_of_block("DEF STRING[5] NOTE"), "definition");
  EXPECT_EQ(reason_of_block("DEF REAL WIDTH\nDEF INT WIDTH"), "definition");
  EXPECT_EQ(reason_of_block("R1=-3 MOD 2"), "out_of_domain");
}

TEST(SinumerikValues, AreNotSetInBlocksThatAreLeftOut) {
  Config config = sinumerik();
  config.block_delete = true;
  EXPECT_THAT(sinumerik_x_of("R1=1\n/R1=2\nG0 X=R1\nM30\n", config), ElementsAre(1));
}

// "Job planning", "Parameter transfer": a value left out is 0; its example has three parameters.
TEST(SinumerikCalls, TakeValuesByTheirPlace) {
  const Folder folder;
  folder.write("SUB_PROG.SPF",
               "PROC SUB_PROG (REAL X, REAL Y, REAL Z) ; Formal parameters\nN10 G0 X=X Y=Y Z=Z\n"
               "N100 RET\n");
  const std::string text =
      "PROC MAIN_PROG\nSUB_PROG(15.3,20.2,5)\nSUB_PROG(15.3,,5)\nSUB_PROG()\nM30\n";
  EXPECT_THAT(along(0, text, folder.config()), ElementsAre(15.3, 15.3, 0.0));
  EXPECT_THAT(along(1, text, folder.config()), ElementsAre(20.2, 0.0, 0.0));
  EXPECT_THAT(along(2, text, folder.config()), ElementsAre(5.0, 5.0, 0.0));
  EXPECT_EQ(reason_of("SUB_PROG(1,2,3,4)\nM30\n", folder.config()), "subprogram_call");
}

TEST(SinumerikCalls, RepeatASubprogramWithVariablesOfItsOwn) {
  const Folder folder;
  folder.write("L100.SPF", "DEF REAL STEP=2\nG91 G0 X=STEP\nSTEP=7\nM17\n");
  folder.write("L0100.SPF", "G91 G0 X100\nM17\n");
  // Leading zeros of L count: L0100 is another program.
  folder.write("inner.spf", "%_N_INNER_SPF\nR1=R1+1\nL100\nG90 X=R1 M17\n");
  EXPECT_THAT(sinumerik_x_of("DEF REAL STEP=50\nL100 P3\nG90 X=STEP\nM30\n", folder.config()),
              ElementsAre(2, 4, 6, 50));
  EXPECT_THAT(sinumerik_x_of("R1=1\nINNER\nM30\n", folder.config()), ElementsAre(2, 2));
  EXPECT_THAT(sinumerik_x_of("R1=2\nL100 P=R1\nL0100\nM30\n", folder.config()),
              ElementsAre(2, 4, 104));
}

TEST(SinumerikCalls, AreRefusedWhereAControlWouldStop) {
  const Folder folder;
  folder.write("LOOP1.SPF", "LOOP1\nM17\n");
  folder.write("OPEN.SPF", "G0 X1\n");
  folder.write("ENDS.SPF", "G0 X1\nM30\n");
  folder.write("REFERS.SPF", "PROC REFERS(VAR REAL A)\nM17\n");
  EXPECT_EQ(reason_of("LOOP1\nM30\n", folder.config()), "calls_too_deep");
  EXPECT_EQ(reason_of("OPEN\nM30\n", folder.config()), "o_word_without_end");
  EXPECT_EQ(reason_of("ENDS\nM30\n", folder.config()), "subprogram_end");
  EXPECT_EQ(reason_of("REFERS(R1)\nM30\n", folder.config()), "unset_parameter");
  EXPECT_EQ(reason_of("REFERS(1)\nM30\n", folder.config()), "definition");
  EXPECT_EQ(reason_of("NOWHERE\nM30\n", folder.config()), "no_such_program");
  EXPECT_EQ(reason_of("G0 X1 OPEN\nM30\n", folder.config()), "unknown_word");
  EXPECT_EQ(reason_of("RET\n", folder.config()), "subprogram_end");
}

// Manual "Cycles", CYCLE81: G0 to reference plane and safety clearance, G1 to the depth, G0 out.
TEST(SinumerikCycles, DrillAsTheManualOrdersIt) {
  const std::string head = "G17 G90 G0 X40 Y120 Z150 F200 S300 M3\n";
  EXPECT_THAT(along(2, head + "CYCLE81(110,100,2,35)\nM30\n"), ElementsAre(150, 102, 35, 110));
  // The depth by DPR: 102 − 65 = 37.
  EXPECT_THAT(along(2, head + "CYCLE81(110,102,,,65)\nM30\n"), ElementsAre(150, 102, 37, 110));
  const auto moves = moves_of(head + "CYCLE82(110,102,4,75,,2)\nX50\nM30\n", sinumerik());
  ASSERT_EQ(moves.size(), 6U);
  EXPECT_EQ(moves[3].dwell_s, 2.0);
  EXPECT_EQ(moves[5].kind, MoveKind::rapid);  // the modal words are those before the cycle
}

TEST(SinumerikCycles, FollowEachMoveWhileMcallIsOn) {
  EXPECT_THAT(
      along(2, "G0 X0 Y0 Z50 F100\nMCALL CYCLE81(10,0,2,-5)\nX1\nF50\nY1\nMCALL\nX5\nM30\n"),
      // MCALL drills after X1 and after Y1, but not after F50; X5 comes behind its end.
      ElementsAre(50, 50, 2, -5, 10, 10, 2, -5, 10, 10));
}

// CYCLE85: out at its own feed to the safety clearance; CYCLE86: aside with the spindle stopped.
TEST(SinumerikCycles, ReamAndBore) {
  const std::string head = "G18 G0 Z70 X50 Y105 F100\n";
  const auto ream = moves_of(head + "CYCLE85(105,102,2,,25,,300,450)\nM30\n", sinumerik());
  ASSERT_EQ(ream.size(), 5U);
  // 102 − 25 = 77 and 102 + 2 = 104; 300 and 450 mm/min are 5 and 7.5 mm/s.
  EXPECT_EQ(ream[2].end[1], 77.0);
  EXPECT_DOUBLE_EQ(ream[2].feed_mm_s, 5.0);
  EXPECT_EQ(ream[3].end[1], 104.0);
  EXPECT_DOUBLE_EQ(ream[3].feed_mm_s, 7.5);
  EXPECT_EQ(ream[4].end[1], 105.0);
  const auto bore = moves_of(
      "G17 G0 X70 Y50 Z112 F200 S300\nCYCLE86(112,110,,77,0,2,3,-1,-1,1,45)\nM30\n", sinumerik());
  ASSERT_EQ(bore.size(), 7U);
  EXPECT_EQ(bore[2].end[2], 77.0);
  EXPECT_DOUBLE_EQ(bore[2].spindle_rev_s, 5.0);
  EXPECT_EQ(bore[4].end[0], 69.0);
  EXPECT_EQ(bore[4].end[2], 78.0);
  EXPECT_EQ(bore[4].spindle_rev_s, 0.0);
  EXPECT_EQ(bore[6].end[0], 70.0);
  EXPECT_EQ(bore[6].end[2], 112.0);
}

// CYCLE84 with the manual's values: M5 (pitch 0.8 by ISO 261), 200 rpm in, 500 rpm out.
TEST(SinumerikCycles, TapWithTheSpindlesPitch) {
  const auto moves =
      moves_of("G0 G90 X30 Y35 Z40\nCYCLE84(40,36,2,,30,,3,5,,90,200,500)\nM30\n", sinumerik());
  ASSERT_EQ(moves.size(), 5U);
  EXPECT_EQ(moves[2].kind, MoveKind::thread);
  // 36 − 30 = 6 and 36 + 2 = 38; the sign of the speed turns on the way out.
  EXPECT_EQ(moves[2].end[2], 6.0);
  EXPECT_DOUBLE_EQ(moves[2].feed_mm_s, 0.8);
  EXPECT_DOUBLE_EQ(moves[2].spindle_rev_s, 200.0 / 60.0);
  EXPECT_EQ(moves[3].end[2], 38.0);
  EXPECT_DOUBLE_EQ(moves[3].spindle_rev_s, -500.0 / 60.0);
}

TEST(SinumerikCycles, AreRefusedByName) {
  EXPECT_EQ(reason_of_block("F100\nCYCLE81(10,0,2,-5,4)"), "cycle_depth");
  EXPECT_EQ(reason_of_block("F100\nCYCLE81(1,0,2,-5)"), "cycle_planes");
  EXPECT_EQ(reason_of_block("CYCLE81(10,0,2,-5)"), "feed_missing");
  EXPECT_EQ(reason_of_block("F100\nCYCLE81(10,0,2,-5,,0,10,1,11)"), "cycle_value");
  EXPECT_EQ(reason_of_block("F100\nCYCLE81(10,0,2)"), "cycle_word_missing");
  EXPECT_EQ(reason_of_block("CYCLE832(0.01,1)"), "cycle_not_interpreted");
  EXPECT_EQ(reason_of_block("CYCLE800(1)"), "transformation");
  EXPECT_EQ(reason_of_block("MCALL L10"), "modal_call");
  EXPECT_EQ(reason_of_block("SETMS(2)"), "spindle_selection");
}

TEST(SinumerikSpindle, OfNumberOneIsTheMaster) {
  const auto moves = moves_of("S1=600 M1=4\nG1 X1 F100\nM30\n", sinumerik());
  // M1=4 turns the spindle backwards: 600 rev/min are −10 rev/s.
  EXPECT_DOUBLE_EQ(moves.at(0).spindle_rev_s, -10.0);
  EXPECT_EQ(reason_of_block("S2=600"), "extended_address");
  EXPECT_EQ(reason_of_block("M2=3"), "extended_address");
}

/// Machine position at the end of a move.
std::pair<double, double> machine(const Move& move) {
  const Axes at = machine_of(move, move.end);
  return {at[0], at[1]};
}

// "Fundamentals", TRANS and ROT: TRANS counts from the settable offset, ATRANS along the turned
// axes.
TEST(SinumerikFrames, ShiftAndTurnOnTopOfTheSettableOffset) {
  Config config = sinumerik();
  config.work_offset[0] = {100.0, 50.0, 20.0};
  const auto moves = moves_of(
      "G54\nTRANS X10 Y20 Z5\nG0 X1 Y2 Z3\nAROT Z90\nX1 Y2\nATRANS X5\nX1 Y2\nROT RPL=-90\n"
      "X1 Y2\nTRANS\nX1 Y2 Z3\nM30\n",
      config);
  ASSERT_EQ(moves.size(), 5U);
  const auto near = [](double x, double y) {
    return testing::Pair(testing::DoubleNear(x, 1e-9), testing::DoubleNear(y, 1e-9));
  };
  EXPECT_THAT(machine(moves[0]), near(111, 72));
  EXPECT_EQ(machine_of(moves[0], moves[0].end)[2], 28.0);
  EXPECT_THAT(machine(moves[1]), near(108, 71));  // (1, 2) turned by 90° is (-2, 1)
  EXPECT_THAT(machine(moves[2]), near(108, 76));  // X of the turned frame is Y
  EXPECT_THAT(machine(moves[3]), near(102, 49));  // ROT deletes the shift
  EXPECT_THAT(machine(moves[4]), near(101, 52));
}

TEST(SinumerikFrames, LeaveTheMachineWhereItIs) {
  const auto moves = moves_of("G0 X10 Y5\nTRANS X3\nROT Z30\nG0 Z1\nSUPA X7\nM30\n", sinumerik());
  // A frame changes where the axes are in work coordinates; in the machine's they must not move.
  EXPECT_NEAR(machine(moves.at(1)).first, 10.0, 1e-9);
  EXPECT_NEAR(machine(moves.at(1)).second, 5.0, 1e-9);
  EXPECT_NEAR(machine(moves.at(2)).first, 7.0, 1e-9);
  EXPECT_NEAR(machine(moves.at(2)).second, 5.0, 1e-9);
}

TEST(SinumerikFrames, AreRefusedWhereASettingOfTheControlDecides) {
  EXPECT_EQ(reason_of_block("ROT X30"), "frame_rotation");
  EXPECT_EQ(reason_of_block("G18\nROT RPL=30"), "frame_rotation");
  EXPECT_EQ(reason_of_block("G0 TRANS X30"), "frame");
  EXPECT_EQ(reason_of_block("ATRANS"), "missing_value");
  EXPECT_EQ(reason_of_block("TRANS X5\nG55"), "frame_and_offset");
  EXPECT_EQ(reason_of_block("TRANS X5\nG0 X=IC(3)"), "frame_incremental");
  EXPECT_EQ(reason_of_block("G91\nTRANS X5\nG0 X3"), "frame_incremental");
  EXPECT_EQ(reason_of_block("ROT Z5\nG0 X3"), "frame_axis");
  EXPECT_EQ(reason_of_block("SCALE X2"), "frame");
}

TEST(SinumerikFlow, IsRefusedByName) {
  for (const char* const text : {"IF R1>5 GOTOF END", "GOTOB MARK1", "FOR I=1 TO 5", "WHILE R1<5",
                                 "LOOP", "REPEAT", "CASE R1 OF 1 GOTOF A1", "ELSE", "ENDLOOP"}) {
    EXPECT_EQ(reason_of_block(text), "flow_control") << text;
  }
}

}  // namespace
}  // namespace steadyrest::nc::interpret
