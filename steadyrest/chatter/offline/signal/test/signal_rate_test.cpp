// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/chatter/offline/signal/signal_rate.hpp>

namespace steadyrest::chatter::offline::test {
namespace {

/// A tenth of a second of one tone, reduced.
RecordedSignal reduced_tone(double rate_hz, double frequency_hz) {
  RecordedSignal signal;
  signal.rate_hz = rate_hz;
  signal.start_s = 2.0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(rate_hz / 10.0); ++i) {
    const double t_s = static_cast<double>(i) / rate_hz;
    signal.value.push_back(std::sin(2.0 * std::numbers::pi * frequency_hz * t_s));
    signal.speed_rev_s.push_back(t_s);
  }
  reduce_rate(signal);
  return signal;
}

/// The largest |value − tone| away from the ends.
double most_off(const RecordedSignal& signal, double frequency_hz, double amplitude) {
  double out = 0.0;
  for (std::size_t i = 40; i + 40 < signal.value.size(); ++i) {
    const double t_s = static_cast<double>(i) / signal.rate_hz;
    const double tone = std::sin(2.0 * std::numbers::pi * frequency_hz * t_s);
    out = std::max(out, std::abs(signal.value[i] - amplitude * tone));
  }
  return out;
}

TEST(SignalRate, BringsEveryCommonRateBelowTheDetectors) {
  for (const auto& [recorded, wanted] :
       {std::pair{44100.0, 44100.0}, std::pair{50e3, 50e3}, std::pair{51200.0, 25600.0},
        std::pair{64e3, 32e3}, std::pair{96e3, 48e3}, std::pair{102400.0, 102400.0 / 3.0},
        std::pair{192e3, 48e3}, std::pair{204800.0, 40960.0}}) {
    const RecordedSignal signal = reduced_tone(recorded, 922.0);
    EXPECT_EQ(signal.recorded_hz, recorded);
    EXPECT_DOUBLE_EQ(signal.rate_hz, wanted);
    EXPECT_EQ(signal.start_s, 2.0);
    ASSERT_EQ(signal.speed_rev_s.size(), signal.value.size());
    EXPECT_NEAR(signal.speed_rev_s.back(),
                static_cast<double>(signal.value.size() - 1) / signal.rate_hz, 1e-12);
  }
}

TEST(SignalRate, KeepsWhatIsBelowTenKilohertzWhereItIs) {
  for (const double rate_hz : {51200.0, 96e3, 192e3}) {
    for (const double frequency_hz : {50.0, 922.0, 5000.0, 10000.0}) {
      const RecordedSignal signal = reduced_tone(rate_hz, frequency_hz);
      EXPECT_LT(most_off(signal, frequency_hz, 1.0), 1e-3) << rate_hz << ' ' << frequency_hz;
    }
  }
}

// 51.2 kHz is halved: 24 kHz would be heard at 1.6 kHz, in the midst of the chatter.
TEST(SignalRate, LetsNothingBeMirroredIntoThatBand) {
  for (const auto& [rate_hz, frequency_hz] :
       {std::pair{51200.0, 24e3}, std::pair{51200.0, 16e3}, std::pair{96e3, 47e3},
        std::pair{192e3, 49e3}, std::pair{192e3, 95e3}}) {
    EXPECT_LT(most_off(reduced_tone(rate_hz, frequency_hz), 0.0, 0.0), 2e-4)
        << rate_hz << ' ' << frequency_hz;
  }
}

TEST(SignalRate, LeavesADeadSensorDead) {
  RecordedSignal signal;
  signal.rate_hz = 96e3;
  signal.value.assign(9600, 0.1);
  reduce_rate(signal);
  EXPECT_TRUE(no_signal(signal, "a.wav").has_value());
}

}  // namespace
}  // namespace steadyrest::chatter::offline::test
