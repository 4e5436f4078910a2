// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <sstream>
#include <string>

#include "expectations.hpp"
#include "program.hpp"
#include "scratch.hpp"
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace steadyrest::test {
namespace {

const std::string kLog = "examples/thermal/spindle-test.csv";

/// The first rows of the example's log, including the header.
std::string beginning(int rows) {
  std::istringstream all(text_of_file(project_file(kLog)));
  std::string out;
  std::string line;
  for (int i = 0; i <= rows && std::getline(all, line); ++i) {
    out += line + "\n";
  }
  return out;
}

// Truth: examples/thermal/make_spindle_test.py, 20 min with 2 µm and 110 min with 4.5 µm for each
// 1000 rpm, noise 0.3 µm RMS. The fit must find the time constants within three of its own standard
// deviations.
TEST(ThermalFit, FindsTheMachineOfTheExample) {
  const Scratch scratch;
  const auto fit =
      answer_of("thermal fit " + kLog + " --channel z_um=Z -o " + scratch.at("passport.toml"));
  ASSERT_EQ(fit["modes"].size(), 2U);
  for (const auto& mode : fit["modes"]) {
    const double tau_min = mode["tau_min"];
    const double off = std::abs(std::log(tau_min / (tau_min < 50.0 ? 20.0 : 110.0)));
    EXPECT_LT(100.0 * off, 3.0 * mode["tau_sd_percent"].get<double>());
    EXPECT_LT(off, 0.5);
  }
  EXPECT_EQ(fit["modes"][0]["axis"], "Z");
  EXPECT_NEAR(fit["rms_um"].get<double>(), 0.3, 0.1);
  EXPECT_GT(fit["axes"][0]["left_out_rms_um"].get<double>(), 0.2);
  const std::string passport = text_of_file(scratch.at("passport.toml"));
  EXPECT_NE(passport.find("[[thermal.axis]]\nname = \"Z\""), std::string::npos) << passport;

  const auto ahead =
      answer_of("thermal forecast --machine " + scratch.at("passport.toml") + " --log " + kLog +
                " --from-min 250 --rezero-min 60 -o " + scratch.at("curve.csv"));
  EXPECT_LT(ahead["axes"][0]["rms_um"].get<double>(), 1.0);
  EXPECT_GT(ahead["axes"][0]["coverage"].get<double>(), 0.9);
  EXPECT_TRUE(text_of_file(scratch.at("curve.csv"))
                  .starts_with("t_s,speed_rpm,Z_um,Z_sd_um,Z_measured_um\n"));
}

// The band must widen with the distance from the last reading.
TEST(ThermalForecast, OfALogWritesAPageToo) {
  const Scratch scratch;
  answer_of("thermal fit " + kLog + " --channel z_um=Z -o " + scratch.at("passport.toml"));
  const auto ahead = answer_of("thermal forecast --machine " + scratch.at("passport.toml") +
                               " --log " + kLog + " --from-min 250 --report " + scratch.at("page"));
  EXPECT_EQ(ahead["report"], scratch.at("page/report.html"));
  const auto page = nlohmann::json::parse(text_of_file(scratch.at("page/report.json")));
  EXPECT_EQ(page["kind"], "replay");
  const auto& axis = page["axes"][0];
  EXPECT_NEAR(60.0 * axis["fitted_to_h"].get<double>(), 250.0, 0.6);
  EXPECT_EQ(axis["t_h"].size(), axis["measured_um"].size());
  EXPECT_GT(axis["sd_um"].back().get<double>(), axis["sd_um"][500].get<double>())
      << "further ahead it is less certain";
}

// The RMS of the plotted residuals is the fit's.
TEST(ThermalFit, WritesAPageOfWhatTemperaturesTellAndWhatTheModelLeaves) {
  const Scratch scratch;
  const auto fit = answer_of("thermal fit " + kLog + " --channel z_um=Z --to-min 350 --report " +
                             scratch.at("page"));
  const std::string html = text_of_file(scratch.at("page/report.html"));
  EXPECT_EQ(fit["report"], scratch.at("page/report.html"));
  EXPECT_NE(html.find("steadyrest-thermal/1"), std::string::npos);
  const auto page = nlohmann::json::parse(text_of_file(scratch.at("page/report.json")));
  EXPECT_EQ(page["kind"], "fit");
  EXPECT_EQ(page["answer"]["rms_um"], fit["rms_um"]);
  EXPECT_EQ(page["sensors"], nlohmann::json({"room_c"}));
  EXPECT_EQ(page["regimes"].size(), 7U) << "of the test's program";
  const auto& axis = page["axes"][0];
  EXPECT_NEAR(60.0 * axis["fitted_to_h"].get<double>(), 350.0, 0.6);
  EXPECT_GT(axis["t_h"].back().get<double>(), 7.5) << "what follows is a forecast";
  double square = 0.0;
  double count = 0.0;
  for (std::size_t i = 0; i < axis["t_h"].size() && 60.0 * axis["t_h"][i].get<double>() <= 350.0;
       ++i) {
    const double off = axis["measured_um"][i].get<double>() - axis["modelled_um"][i].get<double>();
    square += off * off;
    count += 1.0;
  }
  EXPECT_NEAR(std::sqrt(square / count), fit["rms_um"].get<double>(), 0.05);
  expect_refused("thermal fit " + kLog + " --report /dev/null/here", "/dev/null");
}

// W is half of Z: one body, one set of time constants. The last digits differ, so the columns are
// not the same.
TEST(ThermalFit, TwoProbesOfOneBodyAreToldToShareItsTimeConstants) {
  const Scratch scratch;
  std::istringstream in(text_of_file(project_file(kLog)));
  std::string line;
  std::getline(in, line);
  std::string twice = line + ",w_um\n";
  for (int row = 0; std::getline(in, line); ++row) {  // half as far, with a last digit of its own
    const std::size_t at = line.find(',', line.find(',') + 1) + 1;
    twice += line + "," + std::to_string(0.5 * std::stod(line.substr(at)) + 0.1 * (row % 3)) + "\n";
  }
  const std::string log = scratch.file("twice.csv", twice);
  const auto fit = answer_of("thermal fit " + log + " --no-ambient");
  EXPECT_EQ(fit["shared_tau"].dump(), R"([["Z","W"]])");
  EXPECT_EQ(fit["modes"][0]["tau_min"], fit["modes"][2]["tau_min"]);
  EXPECT_TRUE(answer_of("thermal fit " + log + " --no-ambient --own-tau")["shared_tau"].empty());
}

// Empty, a second =, a quote, a line break and 33 characters.
TEST(ThermalFit, TakesNoNameOfAnAxisThatAPassportCannotHave) {
  for (const char* axis : {"", "Z=X", "a\"b", "Q\n[x]", "123456789012345678901234567890123"}) {
    const Finished finished =
        run({"thermal", "fit", kLog, "--channel", std::string{"z_um="} + axis});
    EXPECT_EQ(finished.code, 2) << axis;
    EXPECT_NE(finished.err.find("names no axis"), std::string::npos) << finished.err;
  }
}

// A band from these hours alone cannot know a warmer day.
TEST(ThermalFit, WarnsThatABandWithoutTemperaturesKnowsTheseDaysAlone) {
  EXPECT_TRUE(answer_of("thermal fit " + kLog)["warnings"].empty());
  const auto warnings = answer_of("thermal fit " + kLog + " --no-ambient")["warnings"];
  ASSERT_EQ(warnings.size(), 1U) << warnings;
  EXPECT_TRUE(warnings[0].get<std::string>().starts_with("Z: no temperature is an input, so"));
}

// Truth: the example's levels are in proportion to the speed, 6.5 µm for each 1000 rpm.
TEST(ThermalFit, GivesLevelsAsATableThatForecastTakes) {
  const Scratch scratch;
  const auto fit = answer_of("thermal fit " + kLog + " --channel z_um=Z --modes 2 --levels table " +
                             "-o " + scratch.at("passport.toml"));
  ASSERT_EQ(fit["modes"].size(), 2U);
  for (std::size_t k = 0; k < 4; ++k) {
    double sum_um = 0.0;
    for (const auto& mode : fit["modes"]) {
      ASSERT_EQ(mode["speeds_rpm"].size(), 4U);
      EXPECT_TRUE(mode["polynomial_um"].empty());
      sum_um += mode["levels_um"][k].get<double>();
    }
    const double rpm = fit["modes"][0]["speeds_rpm"][k];
    EXPECT_NEAR(rpm, k == 0 ? 0.0 : 1500.0 + 1500.0 * static_cast<double>(k), 1.0);
    EXPECT_NEAR(sum_um, 6.5e-3 * rpm, 2.0);
  }
  const auto ahead = answer_of("thermal forecast --machine " + scratch.at("passport.toml") +
                               " --log " + kLog + " --from-min 250 --rezero-min 60");
  EXPECT_LT(ahead["axes"][0]["rms_um"].get<double>(), 1.0);
  expect_refused("thermal fit " + scratch.file("short.csv", beginning(540)) + " --levels table",
                 "the log has 2: 3000, 6000 rpm");
}

TEST(ThermalFit, TheProgramOfTheTestIsAccepted) {
  const auto checked =
      answer_of("program check examples/thermal/spindle-test.ngc --dialect linuxcnc");
  EXPECT_TRUE(checked["refused"].empty());
  EXPECT_GE(checked["blocks"].get<int>(), 10);
}

// 90 rows are too short for a horizon of 4 h; the refusal must say how long is enough.
TEST(ThermalFit, SaysHowLongTheTestMustRun) {
  const Scratch scratch;
  const std::string short_log = scratch.file("short.csv", beginning(90));
  expect_refused("thermal fit " + short_log + " --modes 2",
                 "run at one speed for 120 min at least");
  expect_refused("thermal fit " + kLog + " --channel x_um=X", "no displacement x_um");
  expect_refused("thermal fit " + kLog + " --ambient t9_c", "no temperature t9_c");
  expect_refused("thermal fit " + project_file("tests/refused/thermal-log/clock-runs-back.csv"),
                 "runs backwards");
}

// The method's own premise: with known time constants a short window suffices, without it is
// refused.
TEST(ThermalFit, AnHourIsEnoughWithTheTimeConstantsOfALongerTest) {
  const Scratch scratch;
  answer_of("thermal fit " + kLog + " --channel z_um=Z -o " + scratch.at("long.toml"));
  const std::string morning = scratch.file("morning.csv", beginning(150));
  expect_refused("thermal fit " + morning + " --channel z_um=Z", "at one speed");
  const auto fit = answer_of("thermal fit " + morning + " --channel z_um=Z --tau-from " +
                             scratch.at("long.toml") + " -o " + scratch.at("today.toml"));
  EXPECT_EQ(fit["modes"].size(), 2U);
  const auto rest = answer_of("thermal forecast --machine " + scratch.at("today.toml") + " --log " +
                              kLog + " --channel z_um=Z");
  EXPECT_LT(rest["axes"][0]["rms_um"].get<double>(), 1.5);
  EXPECT_GT(rest["axes"][0]["points"].get<std::size_t>(), 700U) << "from the window's end on";
}

TEST(ThermalForecast, RefusesALogBesideACyclogram) {
  expect_refused("thermal forecast --machine examples/paper-thermal/machine.toml --log " + kLog +
                     " --cyclogram examples/paper-thermal/cyclogram.toml",
                 "already has the inputs");
}

}  // namespace
}  // namespace steadyrest::test
