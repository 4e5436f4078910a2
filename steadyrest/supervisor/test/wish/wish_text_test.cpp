// SPDX-License-Identifier: Apache-2.0
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include <steadyrest/kernel/rt/testing/allocation_guard.hpp>
#include <steadyrest/supervisor/wish_text.hpp>

namespace steadyrest::supervisor {
namespace {

using chatter::online::Law;
using chatter::online::Modulation;

std::uint64_t bits(double value) {
  return std::bit_cast<std::uint64_t>(value);
}

/// Any bits of a number.
double any(std::mt19937_64& random) {
  for (;;) {
    if (const auto value = std::bit_cast<double>(random()); !std::isnan(value)) {
      return value;
    }
  }
}

TEST(WishText, AModulationComesBackBitForBit) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 2000; ++i) {
    const Modulation made{.law = static_cast<Law>(random() % 7),
                          .amplitude_ratio = any(random),
                          .amplitude_rev_s = any(random),
                          .period_s = any(random),
                          .mean_ratio = any(random),
                          .seed = random()};
    const auto text =
        text_of({.what = made, .author = ShortText<64>("otto (operator)")}, WishOutcome::taken);
    const auto read = wish_of(text.view());
    ASSERT_TRUE(read) << text.view();
    const auto& back = std::get<Modulation>(read->wish.what);
    ASSERT_EQ(back.law, made.law);
    ASSERT_EQ(bits(back.amplitude_ratio), bits(made.amplitude_ratio));
    ASSERT_EQ(bits(back.amplitude_rev_s), bits(made.amplitude_rev_s));
    ASSERT_EQ(bits(back.period_s), bits(made.period_s));
    ASSERT_EQ(bits(back.mean_ratio), bits(made.mean_ratio));
    ASSERT_EQ(back.seed, made.seed);
    ASSERT_EQ(read->wish.author.view(), "otto (operator)");
  }
}

TEST(WishText, AReadingComesBackBitForBit) {
  std::mt19937_64 random(2);
  for (int i = 0; i < 2000; ++i) {
    const Measured made{.axis = random() % 9,
                        .name = ShortText<16>("Z"),
                        .displacement_mm = i == 0 ? -0.0 : any(random),
                        .sd_mm = any(random)};
    const auto outcome = static_cast<WishOutcome>(random() % 6);
    const auto read = wish_of(text_of({.what = made, .author = {}}, outcome).view());
    ASSERT_TRUE(read);
    const auto& back = std::get<Measured>(read->wish.what);
    ASSERT_EQ(back.axis, made.axis);
    ASSERT_EQ(back.name.view(), "Z");
    ASSERT_EQ(bits(back.displacement_mm), bits(made.displacement_mm));
    ASSERT_EQ(bits(back.sd_mm), bits(made.sd_mm));
    ASSERT_EQ(read->outcome, outcome);
    ASSERT_EQ(read->wish.author.view(), "");
  }
}

// The longest of everything leaves the author whole.
TEST(WishText, TheLongestFits) {
  const double long_one = -std::numeric_limits<double>::min() * (1.0 - 1e-16);
  const std::string author(64, 'x');
  const auto text = text_of({.what = Modulation{.law = Law::constant,
                                                .amplitude_ratio = -2.2250738585072014e-308,
                                                .amplitude_rev_s = -2.2250738585072014e-308,
                                                .period_s = long_one,
                                                .mean_ratio = long_one,
                                                .seed = std::numeric_limits<std::uint64_t>::max()},
                             .author = ShortText<64>(author)},
                            WishOutcome::out_of_range);
  EXPECT_EQ(wish_of(text.view()).value().wish.author.view(), author);
}

TEST(WishText, AllocatesNothing) {
  const Wish wish{.what = Modulation{}, .author = ShortText<64>("otto (operator)")};
  const kernel::rt::testing::AllocationGuard guard;
  EXPECT_GT(text_of(wish, WishOutcome::taken).size, 20U);
  EXPECT_EQ(guard.allocations(), 0U);
}

TEST(WishText, IsReadableToo) {
  const Wish wish{.what = Modulation{.amplitude_ratio = 0.1, .mean_ratio = 0.95},
                  .author = ShortText<64>("page: otto (operator)")};
  EXPECT_EQ(text_of(wish, WishOutcome::taken).view(),
            "modulate triangle 0.1 0 2 0.95 1 taken page: otto (operator)");
}

TEST(WishText, RefusesWhatIsNone) {
  for (const char* const text :
       {"", "modulate", "act", "modulate zigzag 0.1 0 2 0.95 1 taken otto",
        "modulate sine 0.1 0 2 0.95 1 perhaps otto", "modulate sine 0.1 0 2 0.95 -1 taken otto",
        "modulate sine 0.1 0 2,5 0.95 1 taken otto", "modulate sine 0.1 0 2 1 taken otto",
        "modulate sine 0.1  2 0.95 1 taken otto", "modulate sine 0.1 0 2 1e999 1 taken otto",
        "measure -1 Z 0.1 0.1 taken otto", "measure 2 Z 0.1mm 0.1 taken otto",
        "measure 2 Z 0.1 taken otto", "measured 2 Z 0.1 0.1 taken otto"}) {
    EXPECT_FALSE(wish_of(text)) << text;
  }
  EXPECT_FALSE(wish_of(std::string(100000, ' ')));
  EXPECT_FALSE(wish_of("modulate " + std::string(100000, '9')));
}

}  // namespace
}  // namespace steadyrest::supervisor
