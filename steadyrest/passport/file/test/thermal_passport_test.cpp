// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <steadyrest/passport/edit/thermal_edit.hpp>
#include <steadyrest/passport/edit/thermal_text.hpp>
#include <steadyrest/passport/file/thermal_passport.hpp>
#include <steadyrest/passport/text/text_file.hpp>

// The thermal passport alone: read, written, and put into a machine file.
namespace steadyrest::passport {
namespace {

using kernel::machine::Thermal;
using kernel::machine::ThermalAxis;
using kernel::machine::ThermalMode;

// Every key at a value of its own.
constexpr std::string_view kFull = R"([thermal]
enabled = true
shares = [0.9, 0.8]
level = 1
max_offset_um = 55
slope_um_min = 6
retract_slope_um_min = 60
state_s = 700
[[thermal.axis]]
name = "Z"
noise_um = 1.5
drift_um = 2.5
drift_tau_min = 3
max_speed_rpm = 6000
covariance = [1, 2, 3, 4, 5, 6]
[[thermal.axis.mode]]
tau_min = 10
rest_tau_min = 11
speeds_rpm = [60, 120]
levels_um = [4, -5]
cutting_percent = 125
coolant_percent = 50
feed_um_m_min = 2
tau_sd_percent = 12
state_um = 13
[[thermal.axis.ambient]]
sensor = "t16_c"
tau_min = 14
gain_um_k = 15
reference_c = 21
state_c = 22
[[thermal.axis]]
name = "ch5"
[[thermal.axis.mode]]
tau_min = 16
polynomial_um = [7, 8]
)";

// µm to mm, minutes to s, rev/min to rev/s, % to ratio, each by its own key.
TEST(ThermalPassport, EveryKeyReachesItsField) {
  const auto thermal = parse_thermal_passport(kFull, "passport.toml");
  ASSERT_TRUE(thermal) << kernel::outcome::text(thermal.error());
  EXPECT_TRUE(thermal->enabled);
  EXPECT_EQ(thermal->share, (std::vector<double>{0.9, 0.8}));
  EXPECT_EQ(thermal->level, 1U);
  EXPECT_DOUBLE_EQ(thermal->max_offset_mm, 0.055);
  EXPECT_DOUBLE_EQ(thermal->slope_mm_s, 1e-4);
  EXPECT_DOUBLE_EQ(thermal->retract_slope_mm_s, 1e-3);
  EXPECT_DOUBLE_EQ(thermal->state_s, 700.0);
  ASSERT_EQ(thermal->axis.size(), 2U);
  const ThermalAxis& z = thermal->axis[0];
  EXPECT_EQ(z.name, "Z");
  EXPECT_DOUBLE_EQ(z.noise_mm, 0.0015);
  EXPECT_DOUBLE_EQ(z.drift_mm, 0.0025);
  EXPECT_DOUBLE_EQ(z.drift_tau_s, 180.0);
  EXPECT_DOUBLE_EQ(z.max_speed_rev_s, 100.0);
  EXPECT_EQ(z.covariance, (std::vector<double>{1, 2, 3, 4, 5, 6}));
  ASSERT_EQ(z.mode.size(), 1U);
  const ThermalMode& mode = z.mode[0];
  EXPECT_DOUBLE_EQ(mode.tau_s, 600.0);
  EXPECT_DOUBLE_EQ(mode.rest_tau_s, 660.0);
  EXPECT_EQ(mode.speed_rev_s, (std::vector<double>{1, 2}));
  EXPECT_EQ(mode.level_mm, (std::vector<double>{0.004, -0.005}));
  EXPECT_DOUBLE_EQ(mode.cutting_ratio, 1.25);
  EXPECT_DOUBLE_EQ(mode.coolant_ratio, 0.5);
  // The feed term is a time: mm of displacement per mm/s of feed.
  EXPECT_DOUBLE_EQ(mode.feed_s * 1000.0 / 60.0, 0.002) << "2 µm at 1 m/min";
  EXPECT_DOUBLE_EQ(mode.tau_sd_ratio, 0.12);
  EXPECT_DOUBLE_EQ(mode.state_mm, 0.013);
  ASSERT_EQ(z.ambient.size(), 1U);
  EXPECT_EQ(z.ambient[0].sensor, "t16_c");
  EXPECT_DOUBLE_EQ(z.ambient[0].tau_s, 840.0);
  EXPECT_DOUBLE_EQ(z.ambient[0].gain_mm_k, 0.015);
  EXPECT_DOUBLE_EQ(z.ambient[0].reference_c, 21.0);
  EXPECT_DOUBLE_EQ(z.ambient[0].state_c, 22.0);
  // Two levels of the table and one ambient gain are linear; time constants are not. The
  // covariance's lower triangle then has 3·4/2 = 6 entries.
  EXPECT_EQ(z.parameters(), 3U);
  EXPECT_EQ(thermal->axis[1].mode[0].polynomial_mm, (std::vector<double>{0.007, 0.008}));
}

// Write, read, write: the second text must be the first, so no digit is lost after the first
// rounding.
TEST(ThermalPassport, IsWrittenAsItIsRead) {
  const auto thermal = parse_thermal_passport(kFull, "passport.toml");
  ASSERT_TRUE(thermal);
  const std::string text = thermal_text(*thermal);
  const auto again = parse_thermal_passport(text, "written.toml");
  ASSERT_TRUE(again) << kernel::outcome::text(again.error()) << text;
  EXPECT_EQ(thermal_text(*again), text);
  EXPECT_NE(text.find("tau_min = 10\n"), std::string::npos) << text;
  EXPECT_NE(text.find("levels_um = [4, -5]"), std::string::npos) << text;
  EXPECT_NEAR(again->axis[0].mode[0].feed_s, thermal->axis[0].mode[0].feed_s, 1e-13);
}

// A sensor that acts on two axes is one sensor.
TEST(ThermalPassport, NamesEachSensorOnceInTheOrderOfTheFile) {
  Thermal thermal;
  EXPECT_TRUE(thermal.sensors().empty());
  thermal.axis.resize(2);
  thermal.axis[0].ambient = {{.sensor = "spindle"}, {.sensor = "room"}};
  thermal.axis[1].ambient = {{.sensor = "room"}, {.sensor = "bed"}};
  EXPECT_EQ(thermal.sensors(), (std::vector<std::string>{"spindle", "room", "bed"}));
}

// The comment before the next section and the blank line must survive; the comment inside the old
// section must go with it.
TEST(ThermalEdit, ReplacesTheThermalSectionsAndNothingElse) {
  const auto thermal = parse_thermal_passport(kFull, "passport.toml");
  ASSERT_TRUE(thermal);
  const auto mill = read_text(STEADYREST_SOURCE_DIR "/examples/machines/linuxcnc-mill.toml");
  ASSERT_TRUE(mill);
  const std::string before = *mill + "\n# heat\n";
  const std::string after = "\n# noise\n[simulation] # alone\nseed = 2\n";
  const std::string old =
      "[thermal] # old\nlevel = 1\n[[thermal.axis]]\nname = \"Z\"\n# a mode\n"
      "[[thermal.axis.mode]]\ntau_min = 1\nspeeds_rpm = [0,\n 10]\nlevels_um = [0, 1]\n";
  const auto out = with_thermal(before + old + after, "mill.toml", *thermal);
  ASSERT_TRUE(out) << kernel::outcome::text(out.error());
  EXPECT_EQ(*out, before + thermal_text(*thermal) + after);
  const auto twice = with_thermal(*out, "mill.toml", *thermal);
  ASSERT_TRUE(twice);
  EXPECT_EQ(*twice, *out);
  // No [thermal] yet: at the end of the file.
  const auto added = with_thermal(before, "mill.toml", *thermal);
  ASSERT_TRUE(added);
  EXPECT_EQ(*added, before + "\n" + thermal_text(*thermal));
}

// A broken file, and a [thermal] that is written inline.
TEST(ThermalEdit, RefusesWhatItCannotReplace) {
  const auto thermal = parse_thermal_passport(kFull, "passport.toml");
  ASSERT_TRUE(thermal);
  EXPECT_FALSE(with_thermal("name = ", "broken.toml", *thermal));
  EXPECT_FALSE(with_thermal("thermal = {level = 1}\n", "inline.toml", *thermal));
}

TEST(ThermalPassport, OfAFileWithoutOneIsRefused) {
  const auto none = parse_thermal_passport("[thermal]\n", "empty.toml");
  ASSERT_FALSE(none);
  EXPECT_NE(kernel::outcome::text(none.error()).find("[[thermal.axis]]"), std::string::npos);
  EXPECT_FALSE(parse_thermal_passport("nonsense = ", "broken.toml"));
}

}  // namespace
}  // namespace steadyrest::passport
