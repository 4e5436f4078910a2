// SPDX-License-Identifier: Apache-2.0
#include <sstream>
#include <string>

#include "program.hpp"
#include "scratch.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace steadyrest::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

const std::string kSimulate =
    "chatter simulate examples/processes/slot-922hz.toml --speed-rpm 5000";

json answer_to(const std::string& line) {
  const Finished finished = run_line(line + " --json");
  EXPECT_EQ(finished.code, 0) << finished.err;
  return json::parse(finished.out);
}

// 0.396 mm is 3 % below the published border, 0.5 mm above it.
TEST(ChatterSimulate, TellsStableFromChatterOnBothSidesOfTheBorder) {
  // Border 0.4086 mm; μ at 0.5 mm is −0.505 ± 0.948i: lines at (k ± 0.328)·166.67 Hz.
  const json below = answer_to(kSimulate + " --depth-mm 0.396 --seconds 0.5");
  EXPECT_TRUE(below["stable"].get<bool>());
  EXPECT_LT(below["growth_per_tooth"].get<double>(), 1.0);
  EXPECT_TRUE(below["chatter_frequency_hz"].is_null());
  const json above = answer_to(kSimulate + " --depth-mm 0.5 --seconds 0.5");
  EXPECT_FALSE(above["stable"].get<bool>());
  EXPECT_NEAR(above["growth_per_tooth"].get<double>(), 1.07397559, 2e-3);
  EXPECT_NEAR(above["chatter_frequency_hz"].get<double>(), 935.0, 40.0);
  EXPECT_GT(above["peak_um"].get<double>(), below["peak_um"].get<double>());
}

// One row per step; the slot needs more than 500 in 20 ms.
TEST(ChatterSimulate, WritesItsSteps) {
  const Scratch scratch;
  const std::string out = scratch.at("out.csv");
  const json answer = answer_to(kSimulate + " --depth-mm 0.3 --seconds 0.02 -o " + out);
  std::istringstream table(text_of_file(out));
  std::string line;
  std::getline(table, line);
  EXPECT_EQ(line, "t_s,angle_rad,speed_rpm,x_mm,y_mm,fx_N,fy_N,torque_Nm,power_W,chip_mm");
  std::size_t rows = 0;
  while (std::getline(table, line)) {
    ++rows;
  }
  EXPECT_EQ(answer["rows"], rows);
  EXPECT_GT(rows, 500U);
}

TEST(ChatterSimulate, AModulationStopsWhatGrowsAtConstantSpeed) {
  // Slot, 1 mm: 1.406 a tooth; sine RVA 0.2, RVF 0.1: ρ = 0.0446 over 20 teeth.
  const json sine =
      answer_to(kSimulate + " --depth-mm 1 --law sine --rva 0.2 --rvf 0.1 --seconds 0.1");
  EXPECT_TRUE(sine["stable"].get<bool>());
  EXPECT_TRUE(sine["forced_um"].is_null());
}

TEST(ChatterSimulate, KnowsTheFrequencyUnderModulationToo) {
  // Square law: ρ = 12.7 over 20 teeth.
  const json square =
      answer_to(kSimulate + " --depth-mm 1 --law square --rva 0.2 --rvf 0.1 --seconds 0.1");
  EXPECT_FALSE(square["stable"].get<bool>());
  EXPECT_NEAR(square["chatter_frequency_hz"].get<double>(), 940.0, 60.0);
}

TEST(ChatterSimulate, RefusesWhatCannotBeCut) {
  for (const std::string bad : {" --depth-mm 0", " --depth-mm 1 --seconds 0", " --depth-mm nan",
                                " --depth-mm 1 --law sine --rva 1", " --depth-mm 1 --law wave",
                                " --depth-mm 1 --law sine --rvf 0"}) {
    EXPECT_EQ(run_line(kSimulate + bad).code, 2) << bad;
  }
  const Finished missing = run_line("chatter simulate none.toml --speed-rpm 5000 --depth-mm 1");
  EXPECT_EQ(missing.code, 2);
  EXPECT_THAT(missing.err, HasSubstr("none.toml"));
}

}  // namespace
}  // namespace steadyrest::test
