// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdlib>
#include <string>

#include <gtest/gtest.h>

#include <steadyrest/apps/thermal_page/hysteresis_page.hpp>
#include <steadyrest/apps/thermal_page/thermal_page.hpp>

namespace steadyrest::apps::thermal_page {
namespace {

thermal::offline::Cyclogram two_hours() {
  thermal::offline::Cyclogram cyclogram;
  cyclogram.file = "work </script>.toml";
  for (const double rpm : {1000.0, 2000.0}) {
    thermal::offline::Transition t;
    t.seconds = 3600.0;
    t.speed_rev_s = rpm / 60.0;
    cyclogram.transition.push_back(t);
  }
  return cyclogram;
}

Course course() {
  Course out;
  out.name = "Z";
  out.point = {{.time_s = 0.0, .displacement_mm = 0.002},
               {.time_s = 3600.0, .displacement_mm = 0.012, .sd_mm = 0.001},
               {.time_s = 7200.0, .transition = 1, .displacement_mm = 0.022, .sd_mm = 0.002}};
  out.corrections.transition = {
      {.name = "", .tolerance_mm = 0.01, .interval_s = {1800.0, 1800.0}, .delta_mm = {0.0, 0.005}},
      {.name = "", .tolerance_mm = 0.02, .interval_s = {3600.0}, .delta_mm = {0.004}}};
  return out;
}

TEST(ThermalPage, CountsDisplacementsFromTheStartInTheUnitsOfTheShopFloor) {
  const Json page = Json::parse(forecast_page({{"max_um", 20.0}}, two_hours(), {course()}));
  EXPECT_EQ(page["kind"], "forecast");
  EXPECT_EQ(page["answer"]["max_um"], 20.0);
  EXPECT_EQ(page["transitions"][1]["start_min"], 60.0);
  EXPECT_EQ(page["transitions"][1]["speed_rpm"], 2000.0);
  EXPECT_EQ(page["courses"][0]["displacement_um"], Json({0.0, 10.0, 20.0}));
  EXPECT_EQ(page["courses"][0]["sd_um"], Json({0.0, 1.0, 2.0}));
  EXPECT_EQ(page["courses"][0]["t_min"], Json({0.0, 60.0, 120.0}));
}

TEST(ThermalPage, AddsCorrectionsUpOverTheTransitions) {
  const Json one = Json::parse(plan_page({}, two_hours(), {course()}, 0.5))["courses"][0];
  ASSERT_EQ(one["corrections"].size(), 2U);
  EXPECT_EQ(one["corrections"][0], Json({{"t_min", 30.0}, {"delta_um", 5.0}, {"total_um", 5.0}}));
  EXPECT_EQ(one["corrections"][1], Json({{"t_min", 60.0}, {"delta_um", 4.0}, {"total_um", 9.0}}));
  EXPECT_EQ(
      one["bands"][1],
      Json({{"from_min", 60.0}, {"to_min", 120.0}, {"tolerance_um", 20.0}, {"band_um", 10.0}}));
}

// The recorded spindle unit: at one temperature the displacements differ by more than half of their
// range (reference: channel 5 moves by 39.1 um at one temperature).
TEST(Hysteresis, OfTheRecordedSpindleUnitIsThatOfThePapersFigure) {
  const char* data = std::getenv("STEADYREST_SHARED_DATA");
  if (data == nullptr) {
    GTEST_SKIP() << "STEADYREST_SHARED_DATA is not set";
  }
  const auto log = thermal::offline::read_log(std::string(data) + "/thermal/spindle_unit.csv.gz");
  ASSERT_TRUE(log) << log.error().what;
  const auto channels = hysteresis_of(*log);
  ASSERT_EQ(channels.size(), 5U);
  EXPECT_NEAR(channels[0].correlation, 0.48, 0.05);
  EXPECT_NEAR(std::abs(channels[2].correlation), 0.90, 0.03);
  EXPECT_NEAR(channels[4].spread_mm, 0.0391, 0.004);
  EXPECT_NEAR(channels[2].spread_mm, 0.0440, 0.006);
  ASSERT_EQ(channels[0].stretch.size(), 11U);  // a short rest, five speeds, a rest after each
  EXPECT_NEAR(channels[0].stretch[1].speed_rev_s, 1250.0 / 60.0, 0.5);
  EXPECT_NEAR(channels[0].stretch[1].seconds, 4.0 * 3600.0, 300.0);
}

TEST(Hysteresis, IsNothingWhereTheDisplacementFollowsTheTemperature) {
  thermal::offline::Log log;
  log.file = "made.csv";
  log.displacement = {{"z_um", {}}};
  log.temperature = {{"noise_c", {}}, {"head_c", {}}};
  for (int i = 0; i < 100; ++i) {
    log.time_s.push_back(60.0 * i);
    log.speed_rev_s.push_back(i < 50 ? 20.0 : 0.0);
    const double warmth_c = i < 50 ? 0.2 * i : 0.2 * (100 - i);
    log.temperature[0].value.push_back(20.0 + i % 3);
    log.temperature[1].value.push_back(20.0 + warmth_c);
    log.displacement[0].value.push_back(0.001 * warmth_c);
  }
  const auto channels = hysteresis_of(log, 10);
  ASSERT_EQ(channels.size(), 1U);
  EXPECT_EQ(channels[0].sensor, "head_c");
  EXPECT_NEAR(channels[0].correlation, 1.0, 1e-9);
  EXPECT_LT(channels[0].spread_mm, 0.00051);  // what half a kelvin is
  ASSERT_EQ(channels[0].stretch.size(), 2U);
  EXPECT_EQ(channels[0].stretch[1].temperature_c.size(), 10U);
  const Json page = Json::parse(hysteresis_page({}, log));
  EXPECT_EQ(page["channels"][0]["stretches"][0]["speed_rpm"], 1200.0);
  EXPECT_NEAR(page["channels"][0]["spread_um"].get<double>(), 0.5, 0.1);
}

TEST(ThermalPage, NothingInTheDataLeavesItsScriptElement) {
  const std::string html = to_html(forecast_page({}, two_hours(), {course()}));
  EXPECT_EQ(html.find("work </script>"), std::string::npos);
  EXPECT_NE(html.find("steadyrest-thermal/1"), std::string::npos);
}

}  // namespace
}  // namespace steadyrest::apps::thermal_page
