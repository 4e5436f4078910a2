// SPDX-License-Identifier: Apache-2.0
// Variables, expressions, subprograms and cycles of the dialect `sinumerik`.
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>

#include <gmock/gmock.h>
#include <unistd.h>

#include <steadyrest/nc/interpret/test/moves.hpp>
#include <steadyrest/nc/interpret/test/sinumerik.hpp>

namespace steadyrest::nc::interpret {
namespace {

using test::along;
using test::reason_of_block;
using test::sinumerik;
using test::sinumerik_x_of;
using testing::ElementsAre;

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

TEST(SinumerikSpindle, OfNumberOneIsTheMaster) {
  const auto moves = moves_of("S1=600 M1=4\nG1 X1 F100\nM30\n", sinumerik());
  // M1=4 turns the spindle backwards: 600 rev/min are −10 rev/s.
  EXPECT_DOUBLE_EQ(moves.at(0).spindle_rev_s, -10.0);
  // Another spindle: the moves follow the master.
  const auto beside = moves_of("S1=600 M1=4\nS2=90 M2=3\nG1 X1 F100\nM30\n", sinumerik());
  EXPECT_DOUBLE_EQ(beside.at(0).spindle_rev_s, -10.0);
  EXPECT_EQ(reason_of_block("M2=7"), "unknown_m_code");
  EXPECT_EQ(reason_of_block("X1=600"), "extended_address");
  EXPECT_EQ(reason_of_block("H2=3"), "extended_address");
}

/// Machine position at the end of a move.
std::pair<double, double> machine(const Move& move) {
  const Axes at = machine_of(move, move.end);
  return {at[0], at[1]};
}

// "Fundamentals", TRANS and ROT: TRANS starts from the settable offset, ATRANS goes along the
// rotated axes.
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
  // A frame changes the axes' work coordinates; in machine coordinates they must not move.
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
