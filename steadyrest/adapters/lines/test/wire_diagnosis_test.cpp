// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <functional>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/adapters/lines/wire_diagnosis.hpp>
#include <steadyrest/kernel/override/gray.hpp>

namespace steadyrest::adapters::lines {
namespace {

using Kind = WireFault::Kind;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// The 23 words of a SINUMERIK's feed switch through a wiring.
std::vector<WordPair> words(const std::function<std::uint32_t(std::uint32_t)>& wiring) {
  std::vector<WordPair> all;
  for (std::size_t i = 0; i < 23; ++i) {
    const std::uint32_t sent = kernel::override::sinumerik_code(i);
    all.push_back({.sent = sent, .seen = wiring(sent)});
  }
  return all;
}

TEST(WireDiagnosis, FindsNothingInARightWiring) {
  EXPECT_THAT(diagnose(words([](auto word) { return word; }), 5), IsEmpty());
}

TEST(WireDiagnosis, NamesSwappedWires) {
  const auto swapped = words([](std::uint32_t word) {
    return (word & ~0b01010U) | (word >> 2U & 0b00010U) | (word << 2U & 0b01000U);
  });
  EXPECT_THAT(diagnose(swapped, 5),
              ElementsAre(WireFault{1, Kind::swapped, 3}, WireFault{3, Kind::swapped, 1}));
}

TEST(WireDiagnosis, NamesInvertedWires) {
  EXPECT_THAT(diagnose(words([](auto word) { return word ^ 0b00100U; }), 5),
              ElementsAre(WireFault{2, Kind::inverted, 2}));
  EXPECT_EQ(diagnose(words([](auto word) { return word ^ 0b11111U; }), 5).size(), 5U);
}

TEST(WireDiagnosis, NamesStuckWires) {
  EXPECT_THAT(diagnose(words([](auto word) { return word & ~1U; }), 5),
              ElementsAre(WireFault{0, Kind::stuck_off, 0}));
  EXPECT_THAT(diagnose(words([](auto word) { return word | 16U; }), 5),
              ElementsAre(WireFault{4, Kind::stuck_on, 4}));
}

TEST(WireDiagnosis, NamesWiresThatTouch) {
  const auto touching = words([](std::uint32_t word) {
    const bool on = (word & 0b00110U) != 0;
    return (word & ~0b00110U) | (on ? 0b00110U : 0U);
  });
  EXPECT_THAT(diagnose(touching, 5),
              ElementsAre(WireFault{1, Kind::bridged, 2}, WireFault{2, Kind::bridged, 1}));
}

TEST(WireDiagnosis, ALooseContactIsUnclear) {
  auto loose = words([](auto word) { return word; });
  loose[7].seen ^= 2U;
  EXPECT_THAT(diagnose(loose, 5), ElementsAre(WireFault{1, Kind::unclear, 1}));
}

// Every pair of wires of the 23-step table, swapped, and each inverted.
TEST(WireDiagnosis, NoTwoFaultsOfThisTableLookAlike) {
  for (std::uint32_t a = 0; a < 5; ++a) {
    for (std::uint32_t b = a + 1; b < 5; ++b) {
      const auto faults = diagnose(words([&](std::uint32_t word) {
                                     const std::uint32_t differ = (word >> a ^ word >> b) & 1U;
                                     return word ^ (differ << a) ^ (differ << b);
                                   }),
                                   5);
      EXPECT_THAT(faults,
                  ElementsAre(WireFault{a, Kind::swapped, b}, WireFault{b, Kind::swapped, a}));
    }
  }
}

}  // namespace
}  // namespace steadyrest::adapters::lines
