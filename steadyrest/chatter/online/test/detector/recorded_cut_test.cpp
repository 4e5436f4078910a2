// SPDX-License-Identifier: Apache-2.0
// Cuts with the faults of real recordings: bench/chatter/stable_hunt.cpp has a thousand of them.
#include <random>

#include <gtest/gtest.h>

#include <steadyrest/chatter/online/detector.hpp>
#include <steadyrest/chatter/online/test/recorded_cut.hpp>
#include <steadyrest/kernel/testing/cases.hpp>

namespace steadyrest::chatter::online::test {
namespace {

/// When chatter was first told; −1: never.
double alarm_of(const RecordedCut& cut, const Recorded& recorded) {
  auto detector = Detector::make({.sample_rate_hz = cut.rate_hz,
                                  .teeth = cut.teeth,
                                  .speed_sd = 0.003,
                                  .folds = Detector::folds_at(cut.rate_hz)});
  EXPECT_TRUE(detector);
  for (std::size_t i = 0; i < recorded.value.size(); ++i) {
    if (detector->update({.value = recorded.value[i], .speed_rev_s = recorded.speed_rev_s[i]})
            .chatter) {
      return static_cast<double>(i) / cut.rate_hz;
    }
  }
  return -1.0;
}

RecordedCut short_cut(Spoiled how, std::mt19937_64& rng) {
  RecordedCut cut = spoiled_cut(how, rng);
  cut.seconds = 5.0;
  cut.exit_s = 4.0;
  return cut;
}

TEST(RecordedCut, AStableOneIsSilent) {
  for (const Spoiled how : kernel::testing::cases(kSpoiled)) {
    std::mt19937_64 rng(11);
    for (int i = 0; i < 3; ++i) {
      const RecordedCut cut = short_cut(how, rng);
      EXPECT_LT(alarm_of(cut, record(cut, rng())), 0.0)
          << kSpoiledNames[static_cast<std::size_t>(how)] << " " << i;
    }
  }
}

// In the gap between two orders, where no fold is.
TEST(RecordedCut, ChatterInItIsHeardInThreeTenthsOfASecond) {
  for (const Spoiled how : kernel::testing::cases(kSpoiled)) {
    std::mt19937_64 rng(12);
    RecordedCut cut = short_cut(how, rng);
    cut.rate_hz = std::max(cut.rate_hz, 5000.0);
    cut.filtered = true;
    cut.chatter_hz = (std::floor(900.0 / cut.speed_rev_s) + 0.37) * cut.speed_rev_s;
    cut.chatter_size = 1.0;
    cut.chatter_s = 2.5;
    const Recorded recorded = record(cut, rng());
    const double alarm_s = alarm_of(cut, recorded);
    EXPECT_GT(alarm_s, cut.chatter_s) << kSpoiledNames[static_cast<std::size_t>(how)];
    EXPECT_LT(alarm_s, recorded.stands_out_s + 0.3) << kSpoiledNames[static_cast<std::size_t>(how)];
  }
}

}  // namespace
}  // namespace steadyrest::chatter::online::test
