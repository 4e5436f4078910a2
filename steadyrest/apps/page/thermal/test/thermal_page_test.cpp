// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstddef>
#include <string>

#include <gtest/gtest.h>

#include <steadyrest/apps/page/thermal/fit_page.hpp>
#include <steadyrest/apps/page/thermal/thermal_page.hpp>

namespace steadyrest::apps::page {
namespace {

/// What the page reads: numbers that are not finite are null.
Json as_read(const Json& page) {
  return Json::parse(text_of(page));
}

/// Two transitions of an hour at 1000 and 2000 rpm; the file's name would end a script element.
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

/// Displacements of 2, 12 and 22 µm, so that counting from the start (0, 10, 20) shows.
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

// The zero of the part is set at the start; minutes, rpm and µm are the shop's units.
TEST(ThermalPage, CountsDisplacementsFromTheStartInTheUnitsOfTheShopFloor) {
  const Json page = as_read(forecast_page({{"max_um", 20.0}}, two_hours(), {course()}));
  EXPECT_EQ(page["kind"], "forecast");
  EXPECT_EQ(page["answer"]["max_um"], 20.0);
  EXPECT_EQ(page["transitions"][1]["start_min"], 60.0);
  EXPECT_EQ(page["transitions"][1]["speed_rpm"], 2000.0);
  EXPECT_EQ(page["courses"][0]["displacement_um"], Json({0.0, 10.0, 20.0}));
  EXPECT_EQ(page["courses"][0]["sd_um"], Json({0.0, 1.0, 2.0}));
  EXPECT_EQ(page["courses"][0]["t_min"], Json({0.0, 60.0, 120.0}));
}

// 5 µm in the first transition, 4 in the second: totals 5 and 9. With k = 0.5 the band is half the
// tolerance.
TEST(ThermalPage, AddsCorrectionsUpOverTheTransitions) {
  const Json one = as_read(plan_page({}, two_hours(), {course()}, 0.5))["courses"][0];
  ASSERT_EQ(one["corrections"].size(), 2U);
  EXPECT_EQ(one["corrections"][0], Json({{"t_min", 30.0}, {"delta_um", 5.0}, {"total_um", 5.0}}));
  EXPECT_EQ(one["corrections"][1], Json({{"t_min", 60.0}, {"delta_um", 4.0}, {"total_um", 9.0}}));
  EXPECT_EQ(
      one["bands"][1],
      Json({{"from_min", 60.0}, {"to_min", 120.0}, {"tolerance_um", 20.0}, {"band_um", 10.0}}));
}

// 100 hours: half of them at 1200 rpm, then rest; the second temperature is proportional to the
// displacement (1000 µm/K), the first is noise.
TEST(ThermalPage, OfAFitHasEachDisplacementOverEachTemperatureAndItsCourse) {
  thermal::offline::Log log;
  log.file = "made.csv";
  log.displacement = {{"x_um", {}}, {"z_um", {}}};
  log.temperature = {{"noise_c", {}}, {"head_c", {}}};
  FittedAxis axis{.axis = "Z", .channel = 1, .point = {}};
  for (int i = 0; i < 6000; ++i) {
    log.time_s.push_back(60.0 * i);
    log.speed_rev_s.push_back(i < 3000 ? 20.0 : 0.0);
    log.temperature[0].value.push_back(20.0 + i % 3);
    log.temperature[1].value.push_back(20.0 + 0.001 * i);
    log.displacement[0].value.push_back(0.0);
    log.displacement[1].value.push_back(0.001 * i);
    axis.point.push_back({.time_s = 60.0 * i,
                          .measured_mm = 0.001 * i,
                          .modelled_mm = 0.001 * i + 0.002,
                          .sd_mm = 0.003,
                          .fitted = i <= 4800});
  }
  const Json page = as_read(fit_page({{"rms_um", 2.0}}, log, {axis}));
  EXPECT_EQ(page["kind"], "fit");
  EXPECT_EQ(page["sensors"], Json({"noise_c", "head_c"}));
  ASSERT_EQ(page["regimes"].size(), 2U);
  EXPECT_EQ(page["regimes"][0]["speed_rpm"], 1200.0);
  EXPECT_EQ(page["regimes"][1]["start_h"], 50.0);
  const Json& one = page["axes"][0];
  EXPECT_EQ(one["channel"], "z_um");
  EXPECT_EQ(one["best_sensor"], 1);
  EXPECT_EQ(one["over"][1]["correlation"], 1.0);
  EXPECT_EQ(one["over"][1]["slope_um_k"], 1000.0);
  for (std::size_t r = 0; r < 2; ++r) {
    const std::size_t rows = page["regimes"][r]["t_h"].size();
    EXPECT_LE(rows, 200U);
    EXPECT_EQ(one["displacement_um"][r].size(), rows);
    EXPECT_EQ(page["regimes"][r]["temperature_c"][1].size(), rows);
  }
  // i ≤ 4800 minutes are fitted: 80 h.
  EXPECT_EQ(one["fitted_to_h"], 80.0);
  ASSERT_LE(one["t_h"].size(), 2000U);
  EXPECT_EQ(one["t_h"].size(), one["sd_um"].size());
  EXPECT_NEAR(one["modelled_um"].back().get<double>() - one["measured_um"].back().get<double>(),
              2.0, 1e-2);
}

// No point was fitted: the border between fit and forecast is the first point, and nothing before
// it may be read.
TEST(ThermalPage, OfALogThatIsAllForecastSaysSo) {
  thermal::offline::Log log;
  log.time_s = {0.0, 3600.0};
  log.speed_rev_s = {0.0, 20.0};
  const FittedAxis axis{.axis = "Z",
                        .channel = 0,
                        .point = {{.time_s = 3600.0,
                                   .measured_mm = std::nan(""),
                                   .modelled_mm = 0.002,
                                   .sd_mm = 0.001,
                                   .fitted = false}}};
  const Json page = as_read(replay_page({}, log, {axis}));
  EXPECT_EQ(page["kind"], "replay");
  EXPECT_EQ(page["speed"]["speed_rpm"], Json({0.0, 1200.0}));
  const Json& one = page["axes"][0];
  EXPECT_EQ(one["fitted_from_h"], one["fitted_to_h"]);
  EXPECT_TRUE(one["measured_um"][0].is_null());
  EXPECT_EQ(one["modelled_um"], Json({2.0}));
}

// No temperature and no course: the page shows less and does not fail.
TEST(ThermalPage, OfAFitWithoutTemperaturesHasTheCourseAlone) {
  thermal::offline::Log log;
  log.displacement = {{"z_um", {0.001}}};
  log.time_s = {0.0};
  log.speed_rev_s = {0.0};
  const FittedAxis axis{.axis = "Z", .channel = 0, .point = {}};
  const Json one = as_read(fit_page({}, log, {axis}))["axes"][0];
  EXPECT_TRUE(one["best_sensor"].is_null());
  EXPECT_TRUE(one["over"].empty());
  EXPECT_FALSE(one.contains("t_h"));
}

TEST(ThermalPage, NothingInTheDataLeavesItsScriptElement) {
  const std::string html = to_html(text_of(forecast_page({}, two_hours(), {course()})));
  EXPECT_EQ(html.find("work </script>"), std::string::npos);
  EXPECT_NE(html.find("steadyrest-thermal/1"), std::string::npos);
}

}  // namespace
}  // namespace steadyrest::apps::page
