// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/thermal/offline/plan/forecast.hpp>
#include <steadyrest/thermal/offline/plan/replay.hpp>
#include <steadyrest/thermal/offline/test/synthetic_log.hpp>

namespace steadyrest::thermal::offline {
namespace {

using kernel::machine::ThermalAmbient;
using kernel::machine::ThermalAxis;
using kernel::machine::ThermalMode;
using test::KnownMachine;
using test::log_of;
using testing::HasSubstr;

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
const std::vector<std::pair<int, double>> kShift = {{120, 3000}, {60, 0}, {60, 1500}, {60, 0}};

KnownMachine machine_without_noise() {
  return {{{20.0, 4.0}, {120.0, 9.0}}, 0.0, 2.5, 45.0};
}

ThermalAxis its_passport() {
  ThermalAxis axis;
  for (const auto& known : machine_without_noise().mode) {
    ThermalMode mode;
    mode.tau_s = 60.0 * known.tau_min;
    mode.polynomial_mm = {1e-3 * known.um_per_krpm};
    axis.mode.push_back(mode);
  }
  ThermalAmbient ambient;
  ambient.sensor = "t1_c";
  ambient.tau_s = 2700.0;
  ambient.gain_mm_k = 2.5e-3;
  axis.ambient = {ambient};
  axis.max_speed_rev_s = 50.0;
  return axis;
}

std::vector<ReplayPoint> replayed(const ThermalAxis& axis, const Log& log,
                                  const ReplayRequest& request) {
  auto points = replay(axis, log, request);
  EXPECT_TRUE(points.has_value()) << points.error().what;
  return points ? *points : std::vector<ReplayPoint>{};
}

// Log and replay share the law but no code: log_of() has its own few lines for it.
TEST(Replay, TheTruePassportGivesTheLog) {
  const Log log = log_of(machine_without_noise(), kShift, 1);
  ReplayRequest request;
  request.channel = 0;
  request.state_s = -1e9;  // not known
  const auto points = replayed(its_passport(), log, request);
  ASSERT_EQ(points.size(), log.rows());
  for (const ReplayPoint& p : points) {
    // The lagged temperature began at 20 °C, which the log does not tell: its effect fades.
    EXPECT_NEAR(p.displacement_mm, p.measured_mm, 1e-9 + 0.3e-3 * std::exp(-p.time_s / 3600.0));
  }
}

TEST(Replay, GoesOnFromThePassportsStates) {
  const Log log = log_of(machine_without_noise(), kShift, 1);
  ThermalAxis axis = its_passport();
  ReplayRequest request;
  request.channel = 0;
  request.state_s = 0.0;
  const auto whole = replayed(axis, log, request);
  // Cut in the middle: the states there are those of the closed form after 120 min at 3000 rpm.
  // G·(1 − e^(−t/τ)) with G = 3 · 4 and 3 · 9 µm.
  axis.mode[0].state_mm = 12e-3 * (1.0 - std::exp(-120.0 / 20.0));
  axis.mode[1].state_mm = 27e-3 * (1.0 - std::exp(-120.0 / 120.0));
  axis.drift_state_mm = 5e-3;
  axis.drift_tau_s = 3600.0;
  axis.ambient[0].gain_mm_k = 0.0;
  request.state_s = 7200.0;
  const auto rest = replayed(axis, log, request);
  ASSERT_FALSE(rest.empty());
  EXPECT_NEAR(rest.front().time_s, 7260.0, 1e-9) << "from the next row on";
  axis.drift_state_mm = 0.0;
  const auto without = replayed(axis, log, request);
  EXPECT_NEAR(rest[59].displacement_mm - without[59].displacement_mm, 5e-3 * std::exp(-1.0), 1e-9)
      << "what the model did not know fades";
  EXPECT_NEAR(without.back().displacement_mm,
              12e-3 * (1.0 - std::exp(-6.0)) * std::exp(-179.0 / 20.0) +
                  6e-3 * (1.0 - std::exp(-3.0)) * std::exp(-59.0 / 20.0) +
                  27e-3 * (1.0 - std::exp(-1.0)) * std::exp(-179.0 / 120.0) +
                  13.5e-3 * (1.0 - std::exp(-0.5)) * std::exp(-59.0 / 120.0),
              2e-3)
      << "the closed form of the rest of the shift";
}

TEST(Replay, AProbeEveryHourSetsAWrongModelRight) {
  const Log log = log_of(machine_without_noise(), kShift, 1);
  ThermalAxis wrong = its_passport();
  // This mode gives 17 µm in two hours at 3000 rpm; a fifth of it is an error of 3.4 µm running
  // free.
  wrong.mode[1].polynomial_mm[0] *= 1.2;
  wrong.drift_mm = 3e-3;
  wrong.drift_tau_s = 4.0 * 3600.0;
  ReplayRequest request;
  request.channel = 0;
  request.from_s = 0.0;
  const auto free = score(replayed(wrong, log, request), 0.0);
  request.rezero_s = 3600.0;
  const auto probed = score(replayed(wrong, log, request), 0.0);
  EXPECT_LT(probed.rms_mm, 0.5 * free.rms_mm);
  EXPECT_GT(probed.rms_mm, 1e-5) << "between the readings it is a forecast";
  EXPECT_LT(probed.points, free.points) << "a reading that was used counts for nothing";
}

// d²·(1 − e^(−2t/τ_d)) since the last reading, here with a drift time of one hour.
TEST(Replay, TheBandGrowsFromReadingToReading) {
  const Log log = log_of(machine_without_noise(), kShift, 1);
  ThermalAxis axis = its_passport();
  axis.drift_mm = 3e-3;
  ReplayRequest request;
  request.channel = 0;
  request.from_s = 0.0;
  request.rezero_s = 3600.0;
  const auto points = replayed(axis, log, request);
  EXPECT_LT(points[61].sd_mm, points[119].sd_mm);
  EXPECT_LT(points[120].sd_mm, points[119].sd_mm) << "a reading";
  EXPECT_NEAR(points[59].sd_mm, 3e-3 * std::sqrt(1.0 - std::exp(-2.0 * 59.0 / 60.0)), 1e-6);
}

/// Two hours of work, ten unrecorded hours, and two more.
Log with_a_night(double speed_at_night_rpm) {
  Log log = log_of(machine_without_noise(), {{120, 3000}, {600, speed_at_night_rpm}, {120, 0}}, 1);
  const auto cut = [](auto& values) { values.erase(values.begin() + 120, values.begin() + 720); };
  cut(log.time_s);
  cut(log.speed_rev_s);
  cut(log.displacement[0].value);
  cut(log.temperature[0].value);
  log.gap = {120};
  return log;
}

TEST(Replay, TheMachineStandsThroughAGapOfTheLog) {
  const Log log = with_a_night(0.0);
  ReplayRequest request;
  request.channel = 0;
  request.state_s = -1e9;
  request.from_s = 7200.0;
  const auto points = replayed(its_passport(), log, request);
  ASSERT_EQ(points.size(), log.rows());
  EXPECT_GT(points[119].displacement_mm, 20e-3);
  // Ten hours leave e^-5 of 17 µm, and the lagged temperature is unknown when the log resumes.
  EXPECT_NEAR(points[120].displacement_mm, log.displacement[0].value[120], 1e-3);
  // The modes had 20 µm and more when the record broke off; as much may be wrong after it.
  EXPECT_GT(points[120].sd_mm, 20e-3) << "it may have done anything";
}

TEST(Replay, AfterAGapTheBandIsThatOfAnUnknownStateUntilAReading) {
  const Log log = with_a_night(3000.0);
  ThermalAxis axis = its_passport();
  axis.noise_mm = 0.1e-3;
  ReplayRequest request;
  request.channel = 0;
  request.state_s = -1e9;
  request.from_s = 7200.0;
  const auto points = replayed(axis, log, request);
  const double error = points[120].measured_mm - points[120].displacement_mm;
  EXPECT_GT(error, 20e-3) << "it has worked all night";
  EXPECT_LE(error, kBand * points[120].sd_mm);
  request.from_s = log.time_s[120];
  const auto read = replayed(axis, log, request);
  EXPECT_LT(read[120].sd_mm, 0.2e-3) << "the row's reading tells the state";
  EXPECT_NEAR(read[120].displacement_mm, read[120].measured_mm, 0.1e-3);
}

TEST(Replay, ALagThatIsShorterThanTheGapBeginsAnewBehindIt) {
  Log log = with_a_night(0.0);
  log.temperature[0].value.assign(120, 20.0);
  log.temperature[0].value.resize(log.rows(), 24.0);
  log.temperature[0].value[120] = kUnknown;
  ThermalAxis axis = its_passport();
  for (const double tau_s : {2700.0, 40'000.0}) {
    axis.ambient[0].tau_s = tau_s;
    ReplayRequest request;
    request.state_s = -1e9;
    const auto points = replayed(axis, log, request);
    const auto still = [&] {
      ThermalAxis without = axis;
      without.ambient[0].gain_mm_k = 0.0;
      return replayed(without, log, request);
    }();
    // The room's part alone, by the difference to a passport without its gain.
    const double room_mm = points[121].displacement_mm - still[121].displacement_mm;
    const double kelvin = room_mm / axis.ambient[0].gain_mm_k + axis.ambient[0].reference_c;
    EXPECT_NEAR(kelvin, tau_s < 36'000.0 ? 24.0 : 20.0, 0.05) << tau_s;
  }
}

TEST(Replay, RefusesWhatThePassportDoesNotKnow) {
  Log log = log_of(machine_without_noise(), kShift, 1);
  ThermalAxis axis = its_passport();
  axis.ambient[0].sensor = "t9_c";
  auto points = replay(axis, log, {});
  ASSERT_FALSE(points.has_value());
  EXPECT_THAT(points.error().what, HasSubstr("needs the temperature t9_c"));
  axis = its_passport();
  axis.max_speed_rev_s = 40.0;
  points = replay(axis, log, {});
  ASSERT_FALSE(points.has_value());
  EXPECT_THAT(points.error().what, HasSubstr("covers up to 2400 rpm"));
}

}  // namespace
}  // namespace steadyrest::thermal::offline
