// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/chatter/offline/cycle/pass_disc.hpp>
#include <steadyrest/chatter/offline/test/cuts.hpp>

namespace steadyrest::chatter::offline {
namespace {

using DiscXi = PassDisc::Complex;

constexpr double kDiscSpeed_rev_s = 5000.0 / 60.0;

/// Of one mode, or of two that move across each other.
Process disc_cut(bool two) {
  Process p = test::benchmark_cut(1.0, Direction::up);
  if (two) {
    p.modes.push_back({{0.6, 0.8}, 700.0, 0.03, 0.06});
  }
  return p;
}

/// `count` numbers on a circle about 0.
std::vector<DiscXi> circle(double radius, std::size_t count) {
  std::vector<DiscXi> out;
  for (std::size_t i = 0; i < count; ++i) {
    const double share = (static_cast<double>(i) + 0.3) / static_cast<double>(count);
    out.push_back(std::polar(radius, 2.0 * std::numbers::pi * share));
  }
  return out;
}

// z = a·(1 − ξ) with |ξ| ≤ 0.9 is within 0.9·a of a: 20 numbers take one block of 16 and one lane.
TEST(PassDisc, GivesWhatTheProductOfAllPiecesGives) {
  for (const bool two : {false, true}) {
    const PassMatrix pass(disc_cut(two), kDiscSpeed_rev_s, 2.0, 0.0);
    const auto disc = PassDisc::make(pass, 1.0, 1.0, 8);
    ASSERT_TRUE(disc.has_value());
    for (const double depth_mm : {0.6, 1.0}) {
      for (const double radius : {0.1, 0.9}) {
        const std::vector<DiscXi> xi = circle(radius, 20);
        ASSERT_TRUE(disc->holds(depth_mm, depth_mm * radius));
        std::vector<DiscXi> found(xi.size());
        disc->g(xi, depth_mm, found);
        for (std::size_t i = 0; i < xi.size(); ++i) {
          EXPECT_LT(std::abs(found[i] - pass.g(xi[i], depth_mm)), 1e-10) << two << xi[i];
        }
      }
    }
  }
}

TEST(PassDisc, NeedsTheSameTermsWhateverWasGuessed) {
  const PassMatrix pass(disc_cut(false), kDiscSpeed_rev_s, 2.0, 0.0);
  const auto few = PassDisc::make(pass, 1.0, 1.0, 1);
  const auto many = PassDisc::make(pass, 1.0, 1.0, 40);
  ASSERT_TRUE(few && many);
  EXPECT_NEAR(static_cast<double>(few->terms()), static_cast<double>(many->terms()), 1.0);
  EXPECT_GT(few->terms(), 8U);
  EXPECT_LT(few->terms(), 40U);
  const auto small = PassDisc::make(pass, 1.0, 0.1, 1);
  ASSERT_TRUE(small);
  EXPECT_LT(small->terms(), few->terms()) << "a small disc is nearly straight";
}

TEST(PassDisc, HoldsTheCirclesWithinIt) {
  const PassMatrix pass(disc_cut(false), kDiscSpeed_rev_s, 2.0, 0.0);
  const auto disc = PassDisc::make(pass, 1.0, 0.5, 16);
  ASSERT_TRUE(disc);
  EXPECT_TRUE(disc->holds(1.0, 0.5));
  EXPECT_FALSE(disc->holds(1.0, 0.51));
  EXPECT_TRUE(disc->holds(1.25, 0.25));
  EXPECT_TRUE(disc->holds(0.75, 0.25));
  EXPECT_FALSE(disc->holds(0.75, 0.26));
  EXPECT_FALSE(disc->holds(2.0, 0.0));
}

// At 30 mm a tooth stiffens the mode so much that the rim has numbers beyond any rounding.
TEST(PassDisc, IsNotMadeWhereItsRoundingWouldShow) {
  const PassMatrix pass(disc_cut(false), kDiscSpeed_rev_s, 60.0, 0.0);
  EXPECT_FALSE(PassDisc::make(pass, 30.0, 30.0, 16).has_value());
  EXPECT_TRUE(PassDisc::make(pass, 1.0, 0.5, 16).has_value());
}

}  // namespace
}  // namespace steadyrest::chatter::offline
