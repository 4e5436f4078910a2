// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <utility>
#include <vector>

#include "expectations.hpp"
#include "program.hpp"
#include "scratch.hpp"
#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

// Moves that the machine cannot make are reported by line, alike by the three verbs that have both
// the program and its machine.
namespace steadyrest::test {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const std::string kMill = "examples/machines/linuxcnc-mill.toml";  // ±500 mm, 12 m/min, S24000

/// G54 at X450, turned by 30°: so a move in programmed X ends elsewhere in machine X.
std::string variables(const Scratch& scratch) {
  std::string out;
  for (const auto& [number, value] : {std::pair{5161, 0},
                                      {5162, 0},
                                      {5163, 0},
                                      {5181, 0},
                                      {5182, 0},
                                      {5183, 0},
                                      {5210, 0},
                                      {5211, 0},
                                      {5212, 0},
                                      {5213, 0},
                                      {5220, 1},
                                      {5221, 450},
                                      {5222, 0},
                                      {5223, 0},
                                      {5230, 30},
                                      {5241, 0},
                                      {5250, 0}}) {
    out += fmt::format("{} {}\n", number, value);
  }
  return scratch.file("g54.var", out);
}

/// `LINE: text` of each warning.
std::vector<std::string> warned(const json& answer) {
  std::vector<std::string> out;
  for (const json& w : answer["warnings"]) {
    out.push_back(fmt::format("{}: {}", w["line"].get<int>(), w["text"].get<std::string>()));
  }
  EXPECT_EQ(answer["warning_count"], out.size());
  return out;
}

// Line 5 ends at 450 + 100·cos 30° = 536.603 mm; arcs must be checked along the way, not only at
// their ends.
TEST(ProgramWarnings, AreThoseOfEachVerbThatHasTheMachine) {
  const Scratch scratch;
  const std::string program = scratch.file("part.ngc",
                                           "G21 G90 G17 G94 G54\n"
                                           "G0 X10 Y0 Z0\n"
                                           "G1 X20 F3000\n"
                                           "S30000 M3\n"
                                           "G1 X100 F20000\n"
                                           "G0 X49\n"
                                           "G2 X49 Y0 I-49 J0 F3000\n"
                                           "G0 X44 Y-2\n"
                                           "G2 X20 Y-50 I-24 J-18 F3000\n"
                                           "G53 G0 X501 Y0\n"
                                           "G53 G0 X490 Y0\n"
                                           "M2\n");
  for (const std::string verb : {"program check ", "program time ", "cut --quick "}) {
    SCOPED_TRACE(verb);
    const std::string line = verb + program + " --machine " + kMill;
    EXPECT_THAT(
        warned(answer_of(line + " --variables " + variables(scratch))),
        ElementsAre(HasSubstr("3: cuts with the spindle stopped: no S"),
                    HasSubstr("4: S30000 is outside the spindle's 0 … 24000 rev/min"),
                    HasSubstr("5: the move takes X to 536.603 mm, outside its travel -500 … 500"),
                    HasSubstr("5: the feed of 20000 mm/min is more than the axes can do here"),
                    HasSubstr("9: the move takes X to 507.321 mm"),
                    HasSubstr("10: a rapid takes X to 501.000 mm")))
        << "the circle of line 7 reaches X499, the arc of line 9 bulges beyond its ends";
    EXPECT_THAT(warned(answer_of(line)),
                ElementsAre(HasSubstr("3: cuts with"), HasSubstr("4: S30000"),
                            HasSubstr("5: the feed"), HasSubstr("10: a rapid takes X")))
        << "without the work offset only machine coordinates are known";
    EXPECT_THAT(run_line(line).out, HasSubstr("warning: line 10: a rapid takes X to 501.000 mm"));
  }
}

// 500 inch/min are 12 700 mm/min; 19.7 inch are 500.380 mm.
TEST(ProgramWarnings, OfInchesAreTheSame) {
  const Scratch scratch;
  const std::string program = scratch.file("inch.ngc",
                                           "G20 G90 G17 G94 G54\n"
                                           "S1000 M3\n"
                                           "G0 X1 Y1 Z0\n"
                                           "G1 X2 F472\n"
                                           "X3 F500\n"
                                           "G53 G0 X19.6\n"
                                           "G53 G0 X19.7\n"
                                           "M2\n");
  for (const std::string verb : {"program check ", "program time ", "cut --quick "}) {
    SCOPED_TRACE(verb);
    EXPECT_THAT(warned(answer_of(verb + program + " --machine " + kMill)),
                ElementsAre(HasSubstr("5: the feed of 12700 mm/min is more than the axes"),
                            HasSubstr("7: a rapid takes X to 500.380 mm")));
  }
}

// F60000 on axes of 12 m/min: 99.5 % of it changes nothing.
TEST(ProgramWarnings, CutSaysWhenTheOverrideHasNoEffect) {
  const Scratch scratch;
  std::string text = text_of_file(project_file("examples/machines/linuxcnc-mill.toml"));
  const std::string clips = "clips_programmed_feed = true";
  text.replace(text.find(clips), clips.size(), "clips_programmed_feed = false");
  const std::string unclipped = scratch.file("unclipped.toml", text);
  const auto cut = [&](int feed_mm_min, const std::string& machine) {
    const std::string program = scratch.file(
        "fast.ngc",
        fmt::format("G21 G90 G17\nS1000 M3\nG0 X0 Y0\nG1 X200 F{}\nX10\nM2\n", feed_mm_min));
    return warned(answer_of("cut " + program + " --quick --machine " + machine));
  };
  EXPECT_THAT(cut(60000, unclipped),
              ElementsAre(HasSubstr("4: the next step of the feed override, 99.5 %, "
                                    "changes nothing for 100 % of the cut"),
                          HasSubstr("4: the feed of 60000 mm/min")));
  // LinuxCNC's override multiplies what the axes permit of F.
  EXPECT_THAT(cut(60000, kMill), ElementsAre(HasSubstr("4: the feed of 60000 mm/min")));
  EXPECT_THAT(cut(6000, unclipped), IsEmpty());
}

// The examples must not warn about themselves.
TEST(ProgramWarnings, SayNothingOfTheExamples) {
  for (const char* fits :
       {"programs/rib-pocket.ngc --machine examples/machines/linuxcnc-mill.toml",
        "programs/circle-r10.ngc --machine examples/machines/linuxcnc-mill.toml",
        "programs/rib-pocket.mpf --machine examples/machines/vmc-840d.toml",
        "programs/circle-r10.mpf --machine examples/machines/vmc-840d.toml",
        "programs/circle-r10.mpf --machine examples/machines/ideal-k50.toml",
        "programs/slot.mpf --machine examples/machines/vmc-840d.toml",
        "thermal/spindle-test.ngc --machine examples/machines/linuxcnc-mill.toml",
        "thermal-batch/plate.ngc --machine examples/thermal-batch/machine.toml",
        "plans/rib-pocket-compensated.ngc --machine "
        "examples/machines/linuxcnc-mill.toml"}) {
    SCOPED_TRACE(fits);
    EXPECT_THAT(warned(answer_of("program check examples/" + std::string(fits))), IsEmpty());
  }
}

}  // namespace
}  // namespace steadyrest::test
