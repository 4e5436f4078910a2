// SPDX-License-Identifier: Apache-2.0
// The vocabulary of blocks: codes, letters, planes.
#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/nc/interpret/state/state.hpp>
#include <steadyrest/nc/interpret/state/step.hpp>

namespace steadyrest::nc::interpret {
namespace {

// RS274/NGC: a code may be off its tenth by 0.0001. In binary 59.1·10 is not 591.
TEST(GCode, IsTheTenthWithinAThousandthOfIt) {
  for (int code = 0; code < 1000; ++code) {
    const double number = std::stod(std::to_string(code / 10) + '.' + std::to_string(code % 10));
    EXPECT_EQ(g::code_of(number), code);
    EXPECT_EQ(g::code_of(number + 0.00009), code);
    EXPECT_EQ(g::code_of(number + 0.00011), -1);
    EXPECT_EQ(g::code_of(number - 0.00011), -1);
  }
  EXPECT_EQ(g::code_of(-1.0), -1);
  EXPECT_EQ(g::code_of(10000.0), -1);
  EXPECT_EQ(g::code_of(1e300), -1);
}

// LinuxCNC's list of canned cycles: G73, G74, G81 to G89. G76 and G80 are none of them.
TEST(Cycle, IsOneOfElevenCodes) {
  const std::vector<int> cycles = {73, 74, 81, 82, 83, 84, 85, 86, 87, 88, 89};
  for (int code = 0; code < 100; ++code) {
    EXPECT_EQ(is_cycle(10 * code), std::ranges::find(cycles, code) != cycles.end()) << code;
  }
}

// The first axis times the second is the normal: e₁ × e₂ = e₃, in cyclic order.
TEST(Plane, HasRightHandedAxes) {
  for (const Plane plane : {Plane::xy, Plane::zx, Plane::yz}) {
    const auto [first, second, normal] = axes_of(plane);
    std::array<double, 3> a{};
    std::array<double, 3> b{};
    a[first] = 1.0;
    b[second] = 1.0;
    EXPECT_EQ(a[(normal + 1) % 3] * b[(normal + 2) % 3] - a[(normal + 2) % 3] * b[(normal + 1) % 3],
              1.0);
  }
  EXPECT_EQ(axes_of(Plane::xy).normal, 2U);
  EXPECT_EQ(axes_of(Plane::zx).normal, 1U);
  EXPECT_EQ(axes_of(Plane::yz).normal, 0U);
}

TEST(Step, HasABitForEachLetterAndForNothingElse) {
  std::uint32_t all = 0;
  for (char letter = 'A'; letter <= 'Z'; ++letter) {
    EXPECT_EQ(all & Step::bit(letter), 0U) << letter;
    all |= Step::bit(letter);
  }
  EXPECT_EQ(all, (std::uint32_t{1} << 26U) - 1);
  for (const char other : {'@', '[', 'a', '\0', '^'}) {
    EXPECT_EQ(Step::bit(other), 0U);
  }
  EXPECT_EQ(kAxisMask & kCentreMask, 0U);
}

TEST(Step, FindsAnAxisByItsLetterAndKnowsTheRotaryOnes) {
  const std::string letters = "XYZABCUVW";
  for (std::size_t i = 0; i < letters.size(); ++i) {
    EXPECT_EQ(kAxisOfLetter[static_cast<std::size_t>(letters[i] - 'A')], i) << letters[i];
    EXPECT_NE(kAxisMask & Step::bit(letters[i]), 0U) << letters[i];
    EXPECT_EQ(is_rotary(i), letters[i] >= 'A' && letters[i] <= 'C') << letters[i];
  }
}

TEST(Step, KeepsNothingOfTheBlockBefore) {
  read::Block block;
  block.reset(8);
  Step step{};
  step.reset(block);
  step.set('X', 4.0);
  step.g[static_cast<std::size_t>(GGroup::motion)] = g::kLinear;
  step.m[static_cast<std::size_t>(MGroup::spindle)] = m::kClockwise;
  step.exact_stop = step.machine_frame = step.others = true;
  step.rounding_mm = 0.5;
  EXPECT_TRUE(step.has('X'));
  EXPECT_EQ(step['X'], 4.0);
  block.reset(9);
  step.reset(block);
  EXPECT_EQ(step.line, 9U);
  EXPECT_FALSE(step.has('X'));
  EXPECT_EQ(step.code(GGroup::motion), kNoCode);
  EXPECT_EQ(step.code(MGroup::spindle), kNoCode);
  EXPECT_FALSE(step.exact_stop || step.machine_frame || step.others);
  EXPECT_LT(step.rounding_mm, 0.0);
}

}  // namespace
}  // namespace steadyrest::nc::interpret
