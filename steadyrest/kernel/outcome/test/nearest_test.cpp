// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <string>

#include <gtest/gtest.h>

#include <steadyrest/kernel/outcome/nearest.hpp>

namespace steadyrest::kernel::outcome {
namespace {

constexpr std::array<std::string_view, 3> kWords = {"coding", "percent", "codes"};

// One swap, one missing letter, one wrong, one missing at the end.
TEST(Nearest, FindsSwappedMissingAndWrongLetters) {
  EXPECT_EQ(nearest("codign", kWords), "coding");
  EXPECT_EQ(nearest("prcent", kWords), "percent");
  EXPECT_EQ(nearest("bercent", kWords), "percent");
  EXPECT_EQ(nearest("code", kWords), "codes");
}

// A long garbage word must cost neither time nor memory.
TEST(Nearest, SuggestsNothingForAnotherWord) {
  EXPECT_EQ(nearest("colour_of_paint", kWords), "");
  EXPECT_EQ(nearest("", kWords), "");
  EXPECT_EQ(nearest(std::string(100000, 'c'), kWords), "");
}

TEST(Nearest, SaysWhatToWrite) {
  EXPECT_EQ(meant("codign", kWords, "remove it"), "write coding if that is what you mean");
  EXPECT_EQ(meant("colour_of_paint", kWords, "remove it"), "remove it");
}

}  // namespace
}  // namespace steadyrest::kernel::outcome
