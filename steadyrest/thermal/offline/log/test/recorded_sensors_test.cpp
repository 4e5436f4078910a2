// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/kernel/file/testing/recorded.hpp>
#include <steadyrest/thermal/offline/log/log.hpp>
#include <steadyrest/thermal/online/sensor_watch.hpp>

// The on-line watch applied to the sixteen sensors of a machine recorded for forty hours, five
// heatings and coolings.
namespace steadyrest::thermal::offline {
namespace {

using kernel::outcome::Reason;
using kernel::signal::kMaxTemperatures;
using online::SensorWatch;

/// The whole log if it is available, else every twentieth row of it.
Log recorded() {
  const auto whole = kernel::file::testing::shared_data() / "thermal/spindle_unit.csv.gz";
  return read_log((std::filesystem::exists(whole) ? whole
                                                  : kernel::file::testing::excerpt("spindle-unit"))
                      .string())
      .value();
}

/// Runs the log; `change` may falsify a sensor's reading.
template <class Change, class See>
void run(const Log& log, Change change, See see) {
  SensorWatch watch;
  const std::size_t sensors = std::min(log.temperature.size(), kMaxTemperatures);
  for (std::size_t row = 0; row < log.time_s.size(); ++row) {
    auto now = kernel::signal::unknown_temperatures();
    for (std::size_t i = 0; i < sensors; ++i) {
      now[i] = change(i, row, log.temperature[i].value[row]);
    }
    watch.update(row > 0 ? log.time_s[row] - log.time_s[row - 1] : 0.0, sensors, now);
    for (std::size_t i = 0; i < sensors; ++i) {
      see(i, row, watch.fault(i));
    }
  }
}

TEST(SensorWatch, BelievesEveryReadingOfAMachineThatWasRecorded) {
  const Log log = recorded();
  ASSERT_GE(log.temperature.size(), kMaxTemperatures);
  std::size_t doubted = 0;
  run(
      log, [](std::size_t, std::size_t, double value) { return value; },
      [&](std::size_t, std::size_t, Reason fault) { doubted += fault != Reason::none ? 1U : 0U; });
  EXPECT_EQ(doubted, 0U);
}

TEST(SensorWatch, FindsEachSensorOfTheRecordedMachineThatStopsInTheMiddle) {
  const Log log = recorded();
  const std::size_t from = log.time_s.size() / 2;
  for (std::size_t stopped = 0; stopped < kMaxTemperatures; ++stopped) {
    double at_s = 0.0;
    run(
        log,
        [&](std::size_t i, std::size_t row, double value) {
          return i == stopped && row > from ? log.temperature[i].value[from] : value;
        },
        [&](std::size_t i, std::size_t row, Reason fault) {
          ASSERT_TRUE(i == stopped || fault == Reason::none);
          if (at_s == 0.0 && fault != Reason::none) {
            EXPECT_EQ(fault, Reason::thermal_sensor_stuck);
            at_s = log.time_s[row] - log.time_s[from];
          }
        });
    EXPECT_GE(at_s, SensorWatch::kStuck_s) << log.temperature[stopped].name;
    // Two hours are the rule's minimum; the rest is for the other sensors to move twice.
    EXPECT_LE(at_s, 1.1 * SensorWatch::kStuck_s) << log.temperature[stopped].name;
  }
}

}  // namespace
}  // namespace steadyrest::thermal::offline
