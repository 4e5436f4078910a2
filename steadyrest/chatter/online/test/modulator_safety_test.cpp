// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <steadyrest/chatter/online/test/modulator_hunt.hpp>

namespace steadyrest::chatter::online::test {
namespace {

TEST(ModulatorSafety, NoChangeOfParametersLeavesTheLimitsOrMakesAnUnsafeWord) {
  // The same with 10⁹ changes: bench/chatter/modulator_hunt.
  const Hunt found = hunt(1, 400'000);
  EXPECT_EQ(found.outside, 0U) << found.first;
  EXPECT_EQ(found.phase_jumps, 0U) << found.first;
  EXPECT_EQ(found.speed_jumps, 0U) << found.first;
  EXPECT_EQ(found.feed_per_tooth, 0U) << found.first;
  EXPECT_EQ(found.invalid_codes, 0U) << found.first;
  EXPECT_EQ(found.words_outside, 0U) << found.first;
  EXPECT_GT(found.wishes, found.changes / 4) << "too little of it modulates";
  EXPECT_GT(found.words, found.changes / 20) << "too few words change";
}

}  // namespace
}  // namespace steadyrest::chatter::online::test
