// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <string>

#include "examples.hpp"
#include "expectations.hpp"
#include "program.hpp"
#include "scratch.hpp"
#include <gtest/gtest.h>

namespace steadyrest::test {
namespace {

// Truth in closed form: one mode of a minute over two stretches of 60 s each, x = 20·(1 − e⁻¹) µm
// after the first.
TEST(ThermalForecast, TakesCoolantAndCuttingFromTheProgram) {
  const Scratch scratch;
  const std::string machine =
      text_of_file(project_file("examples/machines/linuxcnc-mill.toml")) +
      "\n[[thermal.axis]]\nname = \"Z\"\n[[thermal.axis.mode]]\ntau_min = 1\nspeeds_rpm = "
      "[0, 3000]\nlevels_um = [0, 20]\n";
  const std::string program =
      scratch.file("cool.ngc", "G21 G90 G61\nS3000 M3\nG4 P60\nM8\nG4 P60\nM9\nM2\n");
  const auto end_um = [&](const std::string& keys) {
    const std::string file = scratch.file("mill.toml", machine + keys);
    const auto answer = answer_of("thermal forecast --machine " + file + " --program " + program +
                                  " -o " + scratch.at("curve.csv"));
    return answer["axes"][0]["end_um"].get<double>();
  };
  const double left = std::exp(-1.0);
  const double dry = 20.0 * (1.0 - left);
  EXPECT_NEAR(end_um(""), 20.0 + (dry - 20.0) * left, 0.02);
  EXPECT_NEAR(end_um("coolant_percent = 40\n"), 8.0 + (dry - 8.0) * left, 0.02);
  EXPECT_NEAR(end_um("cutting_percent = 300\n"), 20.0 + (dry - 20.0) * left, 0.02)
      << "nothing is cut";
}

// Out at 30 mm/s and back as a rapid, dwells in between: about half of the time is cutting, and the
// level lies between those of running and cutting in that proportion.
TEST(ThermalForecast, OnlyFeedMovesHeatLikeCutting) {
  const Scratch scratch;
  const std::string machine =
      text_of_file(project_file("examples/machines/linuxcnc-mill.toml")) +
      "\n[[thermal.axis]]\nname = \"Z\"\n[[thermal.axis.mode]]\ntau_min = 1\nspeeds_rpm = "
      "[0, 3000]\nlevels_um = [0, 20]\ncutting_percent = 200\n";
  std::string text = "G21 G90 G61\nS3000 M3\n";
  for (int i = 0; i < 100; ++i) {
    text += "G1 X100 F1800\nG4 P3.3\nG0 X0\n";
  }
  const std::string file = scratch.file("mill.toml", machine);
  const std::string program = scratch.file("half.ngc", text + "M2\n");
  const auto time = answer_of("program time " + program + " --machine " + file);
  const auto& row = time["cyclogram"].back();
  const double share = row["cut_s"].get<double>() / row["seconds"].get<double>();
  EXPECT_GT(share, 0.4);
  EXPECT_LT(share, 0.6);
  const auto answer = answer_of("thermal forecast --machine " + file + " --program " + program +
                                " -o " + scratch.at("curve.csv"));
  EXPECT_NEAR(answer["max_um"].get<double>(), 20.0 * (1.0 + share), 0.05);
}

// Two exponentials with the example's A1, A2 and τ, at the end of the fifth stage.
TEST(ThermalForecast, WritesTheCurve) {
  const Scratch scratch;
  const auto answer = answer_of("thermal forecast" + kPaperWork + " -o " + scratch.at("curve.csv"));
  const double end_um =
      49.0785 + (35.2245 * (1.0 - std::exp(-60.0 / 53.475)) - 49.0785) * std::exp(-240.0 / 53.475);
  EXPECT_NEAR(answer["max_um"].get<double>(), end_um, 1e-6);
  const std::string csv = text_of_file(scratch.at("curve.csv"));
  EXPECT_TRUE(csv.starts_with("t_s,transition,speed_rpm,Z_um,Z_sd_um\n0.000,1,1000.0,0.0000,"));
  EXPECT_NE(csv.find("\n18000.000,5,2000.0,48.79"), std::string::npos);
}

// 1000 min at 2000 rpm settle at 49.0785 µm; after one τ at rest 1/e of it is left.
TEST(ThermalForecast, StartsFromWhatTheMachineHasDone) {
  const Scratch scratch;
  const std::string before =
      scratch.file("before.toml", "[[transition]]\nminutes = 1000\nspeed_rpm = 2000\n");
  const std::string rest =
      scratch.file("rest.toml", "[[transition]]\nminutes = 53.475\nspeed_rpm = 0\n");
  const auto answer =
      answer_of("thermal forecast --machine examples/paper-thermal/machine.toml --cyclogram " +
                rest + " --after " + before);
  EXPECT_NEAR(answer["axes"][0]["end_um"].get<double>(), 49.0785 / std::exp(1.0), 1e-4);
}

// A missing sensor is named; once given, the note disappears.
TEST(ThermalForecast, SaysWhichTemperaturesItTakesForGranted) {
  const Scratch scratch;
  const std::string work = scratch.file("work.toml", R"(
[[transition]]
minutes = 60
speed_rpm = 3000
)");
  const std::string passport = scratch.file("passport.toml", R"(
[[thermal.axis]]
name = "Z"
[[thermal.axis.mode]]
tau_min = 30
polynomial_um = [5]
[[thermal.axis.ambient]]
sensor = "motor_c"
gain_um_k = 1
)");
  const std::string line = "thermal forecast --machine " + passport + " --cyclogram " + work;
  const auto untold = answer_of(line);
  ASSERT_EQ(untold["notes"].size(), 1U);
  EXPECT_NE(untold["notes"][0].get<std::string>().find("motor_c is assumed to stay"),
            std::string::npos);
  EXPECT_TRUE(answer_of(line + " --ambient motor_c=21")["notes"].empty());
}

// 40 000 min in steps of 0.1 s would be 24 million rows.
TEST(ThermalForecast, RefusesMoreRowsThanMemoryHolds) {
  const Scratch scratch;
  const std::string work =
      scratch.file("long.toml", "[[transition]]\nminutes = 40000\nspeed_rpm = 1000\n");
  const std::string line =
      "thermal forecast --machine examples/paper-thermal/machine.toml --cyclogram " + work;
  expect_refused(line + " --step-s 0.1", "give --step-s 2 or more");
  answer_of(line + " --step-s 2");
}

TEST(ThermalForecast, OptionsOfALogNeedOne) {
  expect_refused("thermal forecast" + kPaperWork + " --rezero-min 60", "--log");
  expect_refused("thermal forecast" + kPaperWork + " --from-min 60", "--log");
  expect_refused("thermal forecast" + kPaperWork + " --channel z_um=Z", "--log");
}

// Beyond 1.2 times the fitted 2000 rpm, unknown axes and sensors, no tolerance.
TEST(Thermal, RefusesWhatItCannotForecast) {
  const Scratch scratch;
  const std::string machine = " --machine examples/paper-thermal/machine.toml";
  const std::string fast =
      scratch.file("fast.toml", "[[transition]]\nminutes = 10\nspeed_rpm = 2500\n");
  expect_refused("thermal forecast" + machine + " --cyclogram " + fast, "covers up to 2000 rpm");
  expect_refused("thermal forecast" + machine, "--cyclogram");
  expect_refused("thermal forecast" + kPaperWork + " --axis X", "no [[thermal.axis]] X");
  expect_refused("thermal forecast" + kPaperWork + " --ambient t1=20",
                 "no thermal axis has a sensor t1");
  expect_refused("thermal forecast" + kPaperWork + " --ambient t1", "SENSOR=");
  expect_refused(
      "thermal plan --machine examples/machines/vmc-840d.toml --cyclogram "
      "examples/paper-thermal/cyclogram.toml --tolerance-um 5",
      "[[thermal.axis]]");
  expect_refused("thermal plan" + kPaperWork, "no tolerance");
}

}  // namespace
}  // namespace steadyrest::test
