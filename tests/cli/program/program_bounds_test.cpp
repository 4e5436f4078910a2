// SPDX-License-Identifier: Apache-2.0
// What is refused before the servo model is run at all.
#include <fstream>
#include <string>

#include "examples.hpp"
#include "expectations.hpp"
#include "program.hpp"
#include "scratch.hpp"
#include <gtest/gtest.h>

namespace steadyrest::test {
namespace {

const std::string kOnLinuxCnc = " --machine examples/machines/linuxcnc-mill.toml";

struct Bounded {
  Scratch scratch;

  [[nodiscard]] std::string line(const std::string& verb, const std::string& moves,
                                 const std::string& more = "") const {
    std::ofstream(scratch.at("part.ngc")) << "G21 G90 G94 G17 G64\n" << moves << "M2\n";
    return "program " + verb + " " + scratch.at("part.ngc") + kOnLinuxCnc + more + " -o " +
           scratch.at("changed.ngc");
  }
};

TEST(ProgramBounds, RefuseWhatTakesDays) {
  const Bounded part;
  const std::string slow = "G0 X0 Y0\nG1 X10 F0.001\nG1 X20 F1000\n";
  expect_refused(part.line("predistort", slow),
                 "part.ngc:3: the program takes 6.94 days at its own feeds, 6.94 days of them in "
                 "this line; allowed: up to 8 h");
  expect_refused(part.line("feeds", slow, " --max-error-mm 0.02"), "allowed: up to 24 h");
  expect_refused(part.line("correct", slow, " --max-error-mm 0.02"), "allowed: up to 8 h");
  expect_refused(part.line("predistort", "G0 X0\nG1 X10 F1000\nG4 P50000\nG1 X20\n"),
                 "part.ngc:4: the program takes 13.9 h");
}

// The travel is 1000 mm; where the part is clamped does not matter.
TEST(ProgramBounds, RefuseWhatNoTravelHolds) {
  const Bounded part;
  const std::string far = "G0 X0 Y0\nG1 X400000 F3000\n";
  const std::string why = "part.ngc:3: the program covers 400000.000 mm of X";
  expect_refused(part.line("predistort", far), why);
  expect_refused(part.line("feeds", far, " --max-error-mm 0.02"), why);
  expect_refused(part.line("predistort", "G0 X0 Y0\nG1 G53 X600 F3000\n"),
                 "part.ngc:3: the move takes X to 600.000 mm, outside its travel");
}

}  // namespace
}  // namespace steadyrest::test
