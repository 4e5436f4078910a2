// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "examples.hpp"
#include "expectations.hpp"
#include "program.hpp"
#include "scratch.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace steadyrest::test {
namespace {

using testing::HasSubstr;
using List = std::vector<double>;

// Marusich 2012, eq. (1): R = {3;{18,27,15};{0,10,10}}, {3;{15,40,5};{0,10,10}}, 3 × {1;{60};{0}}.
TEST(ThermalPlan, IsThePapersExample) {
  const auto answer = answer_of("thermal plan" + kPaperWork + " --tolerance-um 10 --level 0");
  const auto rows = nlohmann::json::parse(R"([
    {"name": "stage 1", "n": 3, "t_min": [18.0, 27.0, 15.0], "delta_um": [0.0, 10.0, 10.0]},
    {"name": "stage 2", "n": 3, "t_min": [15.0, 40.0, 5.0], "delta_um": [0.0, 10.0, 10.0]},
    {"name": "stage 3", "n": 1, "t_min": [60.0], "delta_um": [0.0]},
    {"name": "stage 4", "n": 1, "t_min": [60.0], "delta_um": [0.0]},
    {"name": "stage 5", "n": 1, "t_min": [60.0], "delta_um": [0.0]}])");
  EXPECT_EQ(answer["transitions"], rows);
  EXPECT_NEAR(answer["axes"][0]["ratio"].get<double>(), 4.9, 0.05) << "almost five times";
  EXPECT_EQ(answer["k"], 1.0);
}

// The shares are 1, 0.7, …, 0.35 of 10 µm; without rounding the residual is the band itself.
TEST(ThermalPlan, AHigherLevelIsStricter) {
  const auto at = [](int level) {
    return answer_of("thermal plan" + kPaperWork +
                     " --tolerance-um 10 --resolution-min 0 --level " +
                     std::to_string(level))["axes"][0];
  };
  double before = 1e9;
  for (int level = 0; level < 4; ++level) {
    const double residual = at(level)["residual_um"].get<double>();
    EXPECT_LT(residual, before);
    before = residual;
  }
  EXPECT_NEAR(before, 3.5, 1e-6);
  expect_refused("thermal plan" + kPaperWork + " --tolerance-um 10 --level 4", "0 … 3");
}

// Rounded instants may leave more than the band; a plan that does says so and by how much.
TEST(ThermalPlan, WarnsOfWhatRoundedInstantsLeaveBeyondTheBand) {
  for (const auto& [options, band_um] : {std::pair{" --tolerance-um 10 --resolution-min 60", 10.0},
                                         {" --tolerance-um 10 --resolution-min 0", 10.0}}) {
    const std::string line = "thermal plan" + kPaperWork + options + " --level 0";
    const auto answer = answer_of(line);
    const auto& axis = answer["axes"][0];
    const double over_um = axis["residual_um"].get<double>() - band_um;
    EXPECT_NEAR(axis["over_band_um"].get<double>(), std::max(over_um, 0.0), 1e-5);
    const bool warns = over_um > 1e-3;
    EXPECT_EQ(answer["warnings"].size(), warns ? 1U : 0U) << options;
    EXPECT_EQ(run_line(line).out.find("outside its band") != std::string::npos, warns);
    EXPECT_THAT(run_line(line).out, HasSubstr("without / band"));
  }
}

// From forecast to proven program: as many insertions as the plan has corrections.
TEST(ThermalPlan, GoesIntoAProgramAndIsProved) {
  const Scratch scratch;
  const std::string machine = scratch.file(
      "mill.toml", text_of_file(project_file("examples/machines/linuxcnc-mill.toml")) +
                       "\n[[thermal.axis]]\nname = \"Z\"\n[[thermal.axis.mode]]\ntau_min = "
                       "1\nspeeds_rpm = [0, 6000]\nlevels_um = [0, 20]\n");
  const std::string program = "examples/programs/rib-pocket.ngc";
  const auto plan =
      answer_of("thermal plan --machine " + machine + " --program " + project_file(program) +
                " --tolerance-um 4 -o " + scratch.at("plan.json"));
  const auto done = answer_of("program compensate " + program + " --plan " +
                              scratch.at("plan.json") + " -o " + scratch.at("out.ngc"));
  EXPECT_EQ(done["insertions"].size(), plan["axes"][0]["corrections"].get<std::size_t>());
  EXPECT_GE(done["insertions"].size(), 2U);
}

// Instants of two axes that no decimal holds. Rounded one by one, intervals would end at different
// times, and the plan would be refused.
TEST(ThermalPlan, OfTwoAxesGoesIntoAProgramAndIsAdapted) {
  const Scratch scratch;
  std::string machine = text_of_file(project_file("examples/machines/linuxcnc-mill.toml"));
  for (const auto& [axis, minutes] : {std::pair{"X", "1.3"}, {"Z", "0.7"}}) {
    machine += std::string("\n[[thermal.axis]]\nname = \"") + axis +
               "\"\n[[thermal.axis.mode]]\ntau_min = " + minutes +
               "\nspeeds_rpm = [0, 6000]\nlevels_um = [0, 20]\n";
  }
  const std::string passport = scratch.file("mill.toml", machine);
  const std::string program = project_file("examples/programs/rib-pocket.ngc");
  const std::string plan = scratch.at("plan.json");
  const std::string measured =
      scratch.file("measured.csv", "part,time_min,axis,deviation_um\n1,0.5,X,1\n1,0.5,Z,1\n");
  // X is corrected only where it is known that the work offset holds no rotation.
  const std::string variables = scratch.file("mill.var", "5220 1\n5221 0\n5230 0\n");
  for (const char* tolerance_um : {"2.5", "3", "3.5", "4", "4.5", "5"}) {
    answer_of("thermal plan --machine " + passport + " --program " + program + " --tolerance-um " +
              tolerance_um + " -o " + plan);
    const auto done = answer_of("program compensate " + program + " --plan " + plan +
                                " --variables " + variables + " -o " + scratch.at("out.ngc"));
    EXPECT_GE(done["insertions"].size(), 2U);
    const auto adapted = answer_of("thermal adapt " + plan + " --measured " + measured);
    EXPECT_EQ(adapted["axes"].size(), 2U);
    const auto written = nlohmann::json::parse(text_of_file(plan))["axes"];
    for (std::size_t i = 0; i < written["X"]["transitions"].size(); ++i) {
      const auto minutes_of = [&](const char* axis) {
        const List times = written[axis]["transitions"][i]["t_min"];
        return std::accumulate(times.begin(), times.end(), 0.0);
      };
      EXPECT_NEAR(minutes_of("X"), minutes_of("Z"), 1e-9) << "to the last written digit";
    }
  }
}

// A program with radius compensation: without the tool table it is refused, and so is its forecast.
TEST(ThermalPlan, TakesTheDataThatTheProgramNeeds) {
  const Scratch scratch;
  const std::string machine = scratch.file(
      "mill.toml", text_of_file(project_file("examples/machines/linuxcnc-mill.toml")) +
                       "\n[[thermal.axis]]\nname = \"Z\"\n[[thermal.axis.mode]]\ntau_min = "
                       "1\nspeeds_rpm = [0, 6000]\nlevels_um = [0, 20]\n");
  const std::string program =
      scratch.file("part.ngc",
                   "G21 G90 G17 G61\nT1 M6\nS6000 M3\nG0 X-20 Y-20\nG41 D1\nG1 X0 Y0 F300\nY50\n"
                   "o<dwell> call\nG40 G0 X-20\nM2\n");
  const std::string tools = scratch.file("tool.tbl", "T1 P1 D6 Z0\n");
  std::filesystem::create_directory(scratch.at("below"));
  ASSERT_FALSE(scratch.file("below/dwell.ngc", "o<dwell> sub\nG4 P60\no<dwell> endsub\n").empty());
  const std::string work = " --machine " + machine + " --program " + program;
  const std::string data = " --tools " + tools + " --subprograms " + scratch.at("below");
  EXPECT_GE(answer_of("thermal plan" + work + data + " --tolerance-um 4")["axes"][0]["corrections"]
                .get<std::size_t>(),
            2U);
  EXPECT_GT(answer_of("thermal forecast" + work + data)["max_um"].get<double>(), 10.0);
  expect_refused("thermal plan" + work + " --tolerance-um 4");
  expect_refused("thermal plan" + kPaperWork + " --tolerance-um 10 --tools " + tools, "--program");
}

}  // namespace
}  // namespace steadyrest::test
