// SPDX-License-Identifier: Apache-2.0
// A part that cannot teach is refused by the name of the file that is at fault.
#include <string>

#include <gtest/gtest.h>

#include <steadyrest/contour/offline/learn/learn_from.hpp>
#include <steadyrest/contour/offline/learn/test/recorded_part.hpp>
#include <steadyrest/kernel/file/testing/own_folder.hpp>

namespace steadyrest::contour::offline {
namespace {

/// A line that was cut as it is written, and a second part of which one thing is wrong.
struct WrongPart {
  WrongPart() : original(test::planned_moves(machine, moves)) {
    good = {.record = test::recorded_part(machine, original, 50.0),
            .program = folder.file("good.ngc", test::exact_program(moves))};
  }
  [[nodiscard]] kernel::outcome::Refusal refusal(const CutPart& wrong) {
    const auto learnt = learn_from({good, wrong}, {.machine = machine,
                                                   .config = {},
                                                   .original = original,
                                                   .model = servo_models(machine.axes)});
    EXPECT_FALSE(learnt.has_value());
    return learnt.has_value() ? kernel::outcome::Refusal{} : learnt.error();
  }
  std::string program(const std::string& text) { return folder.file("wrong.ngc", text); }

  kernel::file::testing::OwnFolder folder;
  kernel::machine::Machine machine = test::ideal_mill();
  std::string moves = "G0 X10 Y0\nG1 X90 F1200\nY60\n";
  nc::plan::PlannedPath original;
  CutPart good;
};

TEST(LearnFromRefuses, AProgramThatIsNotThere) {
  WrongPart part;
  const std::string missing = part.folder.at("missing.ngc");
  EXPECT_EQ(part.refusal({.record = part.good.record, .program = missing}).file, missing);
}

TEST(LearnFromRefuses, AProgramThatTheControlWouldNotRun) {
  WrongPart part;
  const std::string broken = part.program("G21 G90\nG1 X10 F1200\nG1 X1O\nM2\n");
  const auto refusal = part.refusal({.record = part.good.record, .program = broken});
  EXPECT_EQ(refusal.file, broken);
  EXPECT_EQ(refusal.line, 3U);
}

// learn() knows the path only; here the file that it was planned from is known.
TEST(LearnFromRefuses, AProgramOfAnotherPartByItsName) {
  WrongPart part;
  const std::string other = part.program(test::exact_program("G0 X10 Y0\nG1 X90 F1200\nG1 Y-60\n"));
  const auto refusal = part.refusal({.record = part.good.record, .program = other});
  EXPECT_EQ(refusal.file, other);
  EXPECT_NE(refusal.what.find("leaves the original"), std::string::npos) << refusal.what;
}

// It was 5 mm higher all the time.
TEST(LearnFromRefuses, ARecordOfAnotherPartByItsName) {
  WrongPart part;
  CutPart lifted = part.good;
  lifted.record.file = "lifted.csv";
  for (auto& command : lifted.record.command_mm) {
    command[2] += 5.0;
  }
  const auto refusal = part.refusal(lifted);
  EXPECT_EQ(refusal.file, "lifted.csv");
  EXPECT_NE(refusal.what.find("not on the program's path"), std::string::npos) << refusal.what;
}

}  // namespace
}  // namespace steadyrest::contour::offline
