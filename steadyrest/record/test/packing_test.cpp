// SPDX-License-Identifier: Apache-2.0
#include <limits>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <steadyrest/record/packing.hpp>

namespace steadyrest::record {
namespace {

TEST(Packing, GivesEveryColumnBack) {
  EXPECT_TRUE(rc::check([](const std::vector<std::uint64_t>& values) {
    const auto packed = pack(values);
    RC_ASSERT(unpack(packed, values.size()) == values);
  }));
}

TEST(Packing, AColumnThatDoesNotChangeIsSmall) {
  const std::vector<std::uint64_t> same(1000, 0x3FF0000000000000U);
  EXPECT_LT(pack(same).size(), 100U);
}

TEST(Packing, AnotherCountIsRefused) {
  const auto packed = pack(std::vector<std::uint64_t>{1, 2, 3});
  EXPECT_FALSE(unpack(packed, 2));
  EXPECT_FALSE(unpack(packed, 4));
  EXPECT_FALSE(unpack(packed, std::numeric_limits<std::size_t>::max() / 16));
  EXPECT_FALSE(unpack({}, 1));
}

TEST(Packing, EveryDamagedByteIsFound) {
  const std::vector<std::uint64_t> values = {7, 1U << 31U, 99, 12345};
  const auto packed = pack(values);
  for (std::size_t i = 0; i < packed.size(); ++i) {
    auto damaged = packed;
    damaged[i] ^= std::byte{0x10};
    const auto read = unpack(damaged, values.size());
    // The first two bytes hold a hint on the effort of packing, which changes no value.
    EXPECT_TRUE(!read || *read == values) << i;
  }
}

}  // namespace
}  // namespace steadyrest::record
