// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <string>

#include <gtest/gtest.h>

#include <steadyrest/kernel/machine/nearest.hpp>

namespace steadyrest::kernel::machine {
namespace {

constexpr std::array<std::string_view, 3> kWords = {"coding", "percent", "codes"};

TEST(Nearest, FindsSwappedMissingAndWrongLetters) {
  EXPECT_EQ(nearest("codign", kWords), "coding");
  EXPECT_EQ(nearest("prcent", kWords), "percent");
  EXPECT_EQ(nearest("bercent", kWords), "percent");
  EXPECT_EQ(nearest("code", kWords), "codes");
}

TEST(Nearest, SuggestsNothingForAnotherWord) {
  EXPECT_EQ(nearest("colour_of_paint", kWords), "");
  EXPECT_EQ(nearest("", kWords), "");
  EXPECT_EQ(nearest(std::string(100000, 'c'), kWords), "");
}

}  // namespace
}  // namespace steadyrest::kernel::machine
