// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/chatter/offline/signal/engagement.hpp>

namespace steadyrest::chatter::offline {
namespace {

constexpr double kHop_s = 0.0125;
constexpr double kRev_s = 50.0;

struct Stretch {
  double begin_s = 0.0;
  double end_s = 0.0;
  double energy = 1.0;
};

/// 20 s at 50 rev/s: noise of 1e-3, and the stretches.
std::vector<ForcedLevel> levels(const std::vector<Stretch>& cuts) {
  std::mt19937_64 rng(2);
  std::uniform_real_distribution<double> of(0.7, 1.4);
  std::vector<ForcedLevel> out;
  for (double t = 0.0; t < 20.0; t += kHop_s) {
    double energy = 1e-3;
    for (const Stretch& cut : cuts) {
      energy = t >= cut.begin_s && t < cut.end_s ? cut.energy : energy;
    }
    out.push_back({.t_s = t, .energy = energy * of(rng), .speed_rev_s = kRev_s});
  }
  return out;
}

TEST(Engagement, NamesEachEntryAndExit) {
  const auto cuts = engagements(levels({{2.0, 8.0}, {9.0, 15.0, 0.3}}));
  ASSERT_EQ(cuts.size(), 2U);
  EXPECT_NEAR(cuts[0].begin_s, 2.0, kHop_s);
  EXPECT_NEAR(cuts[0].end_s, 8.0, kHop_s);
  EXPECT_NEAR(cuts[1].begin_s, 9.0, kHop_s);
  EXPECT_TRUE(cuts[0].entry && cuts[0].exit && cuts[1].entry && cuts[1].exit);
}

// 5 revolutions are 0.1 s.
TEST(Engagement, AMomentIsNeitherACutNorAGap) {
  const auto cuts = engagements(levels({{2.0, 8.0}, {5.0, 5.08, 1e-3}, {12.0, 12.08}}));
  ASSERT_EQ(cuts.size(), 1U);
  EXPECT_NEAR(cuts[0].end_s, 8.0, kHop_s);
}

TEST(Engagement, ARecordingThatBeginsOrEndsInTheCutHasNoEntryOrExit) {
  const auto whole = engagements(levels({{0.0, 8.0}, {12.0, 30.0}}));
  ASSERT_EQ(whole.size(), 2U);
  EXPECT_FALSE(whole[0].entry);
  EXPECT_TRUE(whole[0].exit);
  EXPECT_TRUE(whole[1].entry);
  EXPECT_FALSE(whole[1].exit);
  EXPECT_TRUE(engagements(levels({})).empty()) << "air";
  EXPECT_TRUE(engagements(levels({{0.0, 30.0}})).empty()) << "nothing to compare with";
  EXPECT_TRUE(engagements({}).empty());
}

TEST(Engagement, AStretchIsAtAnEdgeIfItEndsThere) {
  const std::vector<Engagement> cuts{{2.0, 8.0, true, true, 1.0}, {9.0, 20.0, true, false, 1.0}};
  const auto at = [&](double start_s, double end_s, double energy, double within_s = 0.2) {
    return place_of(cuts, {.start_s = start_s, .end_s = end_s, .energy = energy}, within_s);
  };
  EXPECT_EQ(at(2.05, 2.15, 1.0), CutPlace::entry);
  EXPECT_EQ(at(2.05, 2.3, 1.0), CutPlace::cut) << "chatter begins with the entry";
  EXPECT_EQ(at(7.9, 8.1, 1.0), CutPlace::exit);
  EXPECT_EQ(at(7.5, 8.1, 1.0), CutPlace::cut);
  EXPECT_EQ(at(5.0, 5.1, 1.0), CutPlace::cut);
  EXPECT_EQ(at(19.9, 20.0, 1.0), CutPlace::cut) << "the recording ends";
  EXPECT_EQ(at(2.05, 2.15, 1.0, 0.0), CutPlace::cut);
  EXPECT_EQ(at(1.0, 6.0, 0.01), CutPlace::air) << "a tone that was there before";
  EXPECT_EQ(at(8.5, 8.9, 0.01), CutPlace::air);
  EXPECT_EQ(at(8.5, 8.9, 0.5), CutPlace::cut) << "a light cut";
  EXPECT_EQ(place_of({}, {.start_s = 1.0, .end_s = 2.0}, 0.2), CutPlace::cut);
}

}  // namespace
}  // namespace steadyrest::chatter::offline
