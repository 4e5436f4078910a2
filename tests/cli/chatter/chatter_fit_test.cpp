// SPDX-License-Identifier: Apache-2.0
#include <string>

#include "examples.hpp"
#include "expectations.hpp"
#include "program.hpp"
#include "scratch.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace steadyrest::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

const std::string kTool =
    "[tool]\nteeth = 2\n[cut]\nradial_immersion = 1.0\n"
    "tangential_N_mm2 = 600.0\nradial_N_mm2 = 200.0\n";

// The example's tap test was generated from 922 Hz, 1.1 % and 0.03993 kg, with noise, so the truth
// is known.
TEST(ChatterFit, FindsTheModeThatTheTapTestWasMadeOf) {
  const json fit = answer_of("chatter fit " + kTapTest + " --axis x");
  ASSERT_EQ(fit["order"], 1);
  const json mode = fit["modes"][0];
  EXPECT_EQ(mode["axis"], "x");
  EXPECT_NEAR(mode["frequency_hz"], 922.0, 0.2);
  EXPECT_NEAR(mode["damping_ratio"], 0.011, 3e-4);
  EXPECT_NEAR(mode["mass_kg"], 0.03993, 1e-3);
  EXPECT_GT(fit["residual"], 0.0);
  EXPECT_LT(fit["residual"], 0.1);
  EXPECT_EQ(answer_of("chatter fit " + kTapTest + " --axis y")["modes"][0]["axis"], "y");
}

// Round trip: fitted modes in a process file give the published radius of the slot (0.81974278) as
// far as noise allows.
TEST(ChatterFit, WritesSectionsThatAProcessFileTakes) {
  const Scratch scratch;
  const std::string out = scratch.at("modes.toml");
  EXPECT_EQ(run_line("chatter fit " + kTapTest + " --axis x -o " + out).code, 0);
  const std::string modes = text_of_file(out);
  EXPECT_THAT(modes, HasSubstr("chatter fit: 1 mode, residual"));
  const std::string process = scratch.file("fitted.toml", kTool + modes);
  const json point = answer_of("chatter radius " + process + " --speed-rpm 5000 --depth-mm 0.2");
  EXPECT_NEAR(point["spectral_radius"], 0.81974278, 5e-3);
}

// The same, but the process names the measured response and fits it itself.
TEST(ChatterFit, AProcessTakesTheResponseItself) {
  const json tapped = answer_of(
      "chatter radius examples/processes/slot-tapped.toml --speed-rpm 5000 --depth-mm 0.2");
  EXPECT_NEAR(tapped["spectral_radius"], 0.81974278, 5e-3);
}

TEST(ChatterFit, RefusesBadUsage) {
  const Scratch scratch;
  expect_refused("chatter fit");
  expect_refused("chatter fit " + kTapTest);
  expect_refused("chatter fit " + kTapTest + " --axis z");
  expect_refused("chatter fit no/such.uff --axis x", "no/such.uff");
  expect_refused("chatter fit " + kTapTest + " --axis x --modes 0");
  expect_refused("chatter fit " + kTapTest + " --axis x --modes 17");
  expect_refused("chatter fit " + kTapTest + " --axis x --from-hz 5000", "points in the band");
  expect_refused("chatter fit " + kTapTest + " " + kTapTest + " --axis x",
                 kTapTest + ": the same response twice; give each measurement once");
  EXPECT_EQ(run_line("chatter fit " + kTapTest + " --axis x -o no/such/modes.toml").code, 1);
}

// Line numbers in the corpus's files, of both formats.
TEST(ChatterFit, SaysFileAndLineOfABadResponse) {
  const std::string corpus = STEADYREST_SOURCE_DIR "/tests/refused/frf/";
  expect_refused("chatter fit " + corpus + "unit-inches-per-pound.csv --axis x",
                 "unit-inches-per-pound.csv:2: units \"in/lbf\"");
  expect_refused("chatter fit " + corpus + "end-delimiter-missing.uff --axis x",
                 "end-delimiter-missing.uff:17: the file ends within a dataset");
  expect_refused("chatter fit " + corpus + "empty.csv --axis x", "has 0 points");
}

TEST(ChatterFit, SaysWhereAProcessNamesABadResponse) {
  const Scratch scratch;
  const auto refused = [&](const std::string& section, const std::string& why) {
    const std::string file = scratch.file("bad.toml", kTool + section);
    expect_refused("chatter radius " + file + " --speed-rpm 5000 --depth-mm 1", why);
  };
  refused("[[frf]]\nfile = \"none.csv\"\naxis = \"x\"\n", "bad.toml:8: [[frf]]");
  const std::string tap = scratch.file("tap.csv", "frequency_khz,real_um_N,imag_um_N\n");
  EXPECT_FALSE(tap.empty());
  refused("[[frf]]\nfile = \"tap.csv\"\naxis = \"x\"\n", "tap.csv:1: frequency in \"khz\"");
  refused("[[frf]]\nfile = \"tap.csv\"\n", "axis");
  const std::string own = "[[frf]]\nfile = \"" + project_file(kTapTest) + "\"\naxis = \"x\"\n";
  refused(own + own, "a second time; name each response once for an axis");
  refused("[[frf]]\naxis = \"x\"\n", "file");
  refused("[[frf]]\nfile = \"tap.csv\"\naxis = \"z\"\n", "axis = \"z\"");
  refused("[frf]\nfile = \"tap.csv\"\naxis = \"x\"\n", "frf");
}

}  // namespace
}  // namespace steadyrest::test
