// SPDX-License-Identifier: Apache-2.0
// Where a corrected text really moves the axes: judged by the moves, not by what the plan wanted.
#include <algorithm>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/kernel/file/testing/own_folder.hpp>
#include <steadyrest/passport/file/machine_file.hpp>
#include <steadyrest/trial/batch/text_shifts.hpp>

namespace steadyrest::trial::batch {
namespace {

using testing::HasSubstr;

/// Passes of a minute each, with a retract between them; 4 min in all.
const std::string kPassesOfAMinute =
    "%\nG21 G90 G17 G54 G94\nG0 X0 Y0 Z20\nG0 Z5\nG1 Z-1 F600\nG1 X100 F100\nG0 Z5\nG0 X0 Y10\n"
    "G0 Z2\nG1 Z-1 F600\nG1 X100 F100\nG0 Z5\nG0 X0 Y20\nG0 Z2\nG1 Z-1 F600\nG1 X100 F100\n"
    "G0 Z5\nG0 X0 Y30\nG0 Z2\nG1 Z-1 F600\nG1 X100 F100\nG0 Z20\nM30\n%\n";

/// A program in a folder of its own, and the machine of the thermal example.
class TextOfAPart : public ::testing::Test {
 protected:
  TextOfAPart() {
    auto machine =
        passport::read(std::string(STEADYREST_SOURCE_DIR) + "/examples/thermal-batch/machine.toml");
    EXPECT_TRUE(machine);
    machine_ = *machine;
    config_.axes = "XYZ";
  }
  [[nodiscard]] std::string program(const std::string& text = kPassesOfAMinute) const {
    const std::string path = folder_.at("part.ngc");
    std::ofstream(path, std::ios::binary) << text;
    return path;
  }
  [[nodiscard]] Trace trace_of(const std::string& path) const {
    auto out = trace(path, config_, machine_);
    EXPECT_TRUE(out) << (out ? "" : out.error().what);
    return out ? *std::move(out) : Trace{};
  }

  kernel::file::testing::OwnFolder folder_;
  kernel::machine::Machine machine_;
  nc::interpret::Config config_;
};

TEST_F(TextOfAPart, HasTheEndAndTheStartOfEachMove) {
  const Trace moves = trace_of(program());
  ASSERT_EQ(moves.end.size(), 20U);
  ASSERT_EQ(moves.start_s.size(), moves.end.size());
  EXPECT_EQ(moves.end[3][0], 100.0);  // the first pass
  EXPECT_EQ(moves.end[3][2], -1.0);
  // A pass of 100 mm at 100 mm/min takes a minute.
  EXPECT_NEAR(moves.start_s[4] - moves.start_s[3], 60.0, 1.0);
  EXPECT_TRUE(std::ranges::is_sorted(moves.start_s));
  EXPECT_GE(moves.total_s, moves.start_s.back());
}

// A move on a line that the layer has written is timed, but it is none of the program's.
TEST_F(TextOfAPart, LeavesOutTheMovesOfInsertedLines) {
  const Trace plain = trace_of(program("G21 G90\nG0 X0 Y0 Z5\nG0 X10\nM2\n"));
  const Trace marked =
      trace_of(program("G21 G90\nG0 X0 Y0 Z5\nG0 Z20 (STEADYREST Z 10 um)\nG0 X10\nM2\n"));
  EXPECT_EQ(marked.end.size(), plain.end.size());
  EXPECT_GT(marked.total_s, plain.total_s);
}

// Growth of 10 µm planned for 65 s, of 25 µm for 130 s: the axis is moved the other way, whole
// sums, each from a safe place within its window on.
TEST_F(TextOfAPart, MovesTheAxisByTheSumsOfThePlan) {
  const std::string path = program();
  const Trace original = trace_of(path);
  nc::rewrite::Plan plan;
  plan.total_s = original.total_s;
  plan.axes.push_back({.letter = 'Z',
                       .index = 2,
                       .steps = {{.time_s = 65.0, .displacement_um = 10.0},
                                 {.time_s = 130.0, .displacement_um = 25.0}}});
  const auto shifted = shifted_program(path, original, plan, config_, machine_, {});
  ASSERT_TRUE(shifted) << shifted.error().what;
  EXPECT_GE(shifted->insertions, 2U);
  std::vector<double> z_mm;
  for (const Shift& shift : shifted->shift) {
    z_mm.push_back(shift.mm[2]);
    EXPECT_NEAR(shift.mm[0], 0.0, 1e-9);
    EXPECT_NEAR(shift.mm[1], 0.0, 1e-9);
  }
  ASSERT_GE(z_mm.size(), 2U);
  EXPECT_NEAR(z_mm[0], -0.010, 1e-6);
  EXPECT_NEAR(z_mm[1], -0.025, 1e-6);
  EXPECT_NEAR(shifted->shift[0].time_s, 65.0, 60.0);
  EXPECT_NEAR(shifted->shift[1].time_s, 130.0, 60.0);
  EXPECT_GT(shifted->shift[1].time_s, shifted->shift[0].time_s);
}

TEST_F(TextOfAPart, OfNothingToCorrectMovesNothing) {
  const std::string path = program();
  const Trace original = trace_of(path);
  nc::rewrite::Plan plan;
  plan.total_s = original.total_s;
  const auto shifted = shifted_program(path, original, plan, config_, machine_, {});
  ASSERT_TRUE(shifted) << shifted.error().what;
  EXPECT_TRUE(shifted->shift.empty());
  EXPECT_NEAR(shifted->total_s, original.total_s, 1e-6);
}

TEST_F(TextOfAPart, IsRefusedWithItsFileWhereItCannotBeRead) {
  const auto missing = trace(folder_.at("none.ngc"), config_, machine_);
  EXPECT_FALSE(missing);
  const auto faulty = trace(program("G21 G90\nG1 X5\nM2\n"), config_, machine_);
  ASSERT_FALSE(faulty);
  EXPECT_THAT(faulty.error().file, HasSubstr("part.ngc"));
  EXPECT_EQ(faulty.error().line, 2U);
  EXPECT_THAT(faulty.error().what, HasSubstr("feed"));
}

}  // namespace
}  // namespace steadyrest::trial::batch
