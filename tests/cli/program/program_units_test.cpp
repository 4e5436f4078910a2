// SPDX-License-Identifier: Apache-2.0
#include <string>

#include "expectations.hpp"
#include "program.hpp"
#include "scratch.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

// A program that leaves its unit to the control: 1 is 1 mm or 25.4 mm.
namespace steadyrest::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

const std::string kMachine = " --machine examples/machines/vmc-840d.toml";

/// 20 of path, cut; corners, so that predistort and feeds find something to do.
std::string square(const std::string& units) {
  return units +
         "G90 G17 G94 G54\nS1000 M3\nG0 X0 Y0 Z1.\nG1 Z0. F400.\nX5. F2000.\nY5.\nX0.\nY0.\nM30\n";
}

/// The example's machine with a setting of its control.
std::string machine_with(const Scratch& scratch, const std::string& dialect,
                         const std::string& units) {
  std::string text = text_of_file(project_file("examples/machines/vmc-840d.toml"));
  const std::string sinumerik = "dialect = \"sinumerik\"";
  text.replace(text.find(sinumerik), sinumerik.size(),
               "dialect = \"" + dialect + "\"\nunits = \"" + units + "\"");
  return " --machine " + scratch.file(dialect + units + ".toml", text);
}

TEST(ProgramUnits, AreNamedByEachVerbThatAssumesThem) {
  const Scratch scratch;
  const std::string program = scratch.file("part.nc", square("")) + " --dialect fanuc";
  for (const std::string verb :
       {"program check ", "program moves ", "program time ", "cut --quick "}) {
    SCOPED_TRACE(verb);
    const std::string line = verb + program + (verb == "program moves " ? "" : kMachine);
    const json answer = answer_of(line);
    ASSERT_EQ(answer["assumed"].size(), 1U);
    EXPECT_EQ(answer["assumed"][0]["line"], 3);
    EXPECT_EQ(answer["assumed"][0]["what"], "units");
    EXPECT_THAT(answer["assumed"][0]["text"].get<std::string>(), HasSubstr("assumed: mm"));
    const auto shown = run_line(line);
    EXPECT_THAT(shown.out + shown.err, HasSubstr("assumed: line 3: no G20 or G21"));
    EXPECT_EQ(answer_of(line + " --units mm")["assumed"].size(), 0U);
  }
  EXPECT_THAT(run_line("program moves " + program).out, Not(HasSubstr("assumed")))
      << "stdout is the table";
}

TEST(ProgramUnits, ComeFromTheOptionOrTheMachineFile) {
  const Scratch scratch;
  const std::string time = "program time " + scratch.file("part.nc", square("")) + " ";
  const auto cut_mm = [&](const std::string& rest) {
    return answer_of(time + rest)["cut_mm"].get<double>();
  };
  EXPECT_NEAR(cut_mm("--dialect fanuc" + kMachine), 21.0, 1e-9);
  EXPECT_NEAR(cut_mm("--dialect fanuc --units inch" + kMachine), 21.0 * 25.4, 1e-9);
  const std::string inches = machine_with(scratch, "fanuc", "inch");
  EXPECT_NEAR(cut_mm(inches), 21.0 * 25.4, 1e-9);
  EXPECT_NEAR(cut_mm("--units mm" + inches), 21.0, 1e-9) << "the option comes first";
  EXPECT_EQ(answer_of(time + inches)["assumed"].size(), 0U);
  // The setting is that of the control in the file.
  const json other = answer_of(time + "--dialect linuxcnc" + inches);
  EXPECT_NEAR(other["cut_mm"].get<double>(), 21.0, 1e-9);
  EXPECT_EQ(other["assumed"].size(), 1U);
  // What the program says comes before both.
  const std::string said = "program time " + scratch.file("said.nc", square("G21\n"));
  EXPECT_NEAR(answer_of(said + inches)["cut_mm"].get<double>(), 21.0, 1e-9);
}

TEST(ProgramUnits, ThatAreAssumedBarEveryRewrite) {
  const Scratch scratch;
  const std::string process = " --process examples/processes/slot-922hz.toml --depth-mm 1";
  for (const std::string dialect : {"linuxcnc", "fanuc", "sinumerik"}) {
    SCOPED_TRACE(dialect);
    const std::string program = scratch.file(dialect + ".nc", square(""));
    const std::string rest =
        " --dialect " + dialect + kMachine + " -o " + scratch.at(dialect + "-out.nc");
    for (const std::string verb : {"predistort", "feeds", "correct"}) {
      expect_refused("program " + verb + " " + program + rest + " --max-error-mm 0.01",
                     "its unit is assumed: mm");
    }
    expect_refused("program speeds " + program + rest + process, "its unit is assumed: mm");
  }
}

TEST(ProgramUnits, OfTheMachineFileAllowARewriteAndAreProvedWithoutIt) {
  const Scratch scratch;
  const std::string program = scratch.file("part.nc", square(""));
  const std::string changed = scratch.at("out.nc");
  answer_of("program predistort " + program + machine_with(scratch, "fanuc", "mm") +
            " --max-error-mm 0.01 --max-time-percent 10 -o " + changed);
  EXPECT_THAT(text_of_file(changed), HasSubstr("units mm"));
  EXPECT_TRUE(answer_of("program verify " + program + " " + changed)["proved"].get<bool>());
  expect_refused("program verify " + program + " " + changed + " --units inch", "--units");
}

}  // namespace
}  // namespace steadyrest::test
