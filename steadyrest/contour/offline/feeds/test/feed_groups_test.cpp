// SPDX-License-Identifier: Apache-2.0
// Few feeds for the time that they may cost, on straight lines where that time is a division.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/contour/offline/feeds/feed_groups.hpp>
#include <steadyrest/contour/offline/feeds/test/search_scene.hpp>

namespace steadyrest::contour::offline {
namespace {

using test::SearchScene;

/// 30 mm at 10 mm/s in cells of 1 mm: at the ratio r a cell takes 0.1 s/r.
const char* const kSlowLine = "G4 P0.5\nG1 X30 F600\n";
const FeedRoom kCellsOf1mm{.kind = {}, .ends_mm = {}, .station_mm = 1.0};
constexpr double kNoneTooShort_s = 0.0;

std::vector<double> plateaus(const std::vector<std::pair<std::size_t, double>>& counts) {
  std::vector<double> ratio;
  for (const auto& [count, value] : counts) {
    ratio.insert(ratio.end(), count, value);
  }
  return ratio;
}

/// The groups of the cells once they have run at these feeds.
std::vector<std::uint32_t> grouped(SearchScene& scene, std::vector<double>& ratio,
                                   const FewFeeds& few) {
  EXPECT_EQ(ratio.size(), scene.cells.of.size());
  scene.search.set_ratios(ratio);
  scene.measured_s();
  return group_feeds(scene.cells, scene.search, few, ratio);
}

// 10 cells each at 1.0, 0.8 and 0.5 take 1, 1.25 and 2 s. The first two at 0.8 cost 0.25 s, all at
// 0.5 another 1.5 s.
TEST(FeedGroups, UniteWhatCostsLeastUntilTheLossIsSpent) {
  const auto groups_at = [](double most_loss_s) {
    SearchScene scene(kSlowLine, {.limit_mm = 1.0}, kCellsOf1mm);
    auto ratio = plateaus({{10, 1.0}, {10, 0.8}, {10, 0.5}});
    const auto group =
        grouped(scene, ratio, {.most_loss_s = most_loss_s, .shortest_s = kNoneTooShort_s});
    EXPECT_EQ(ratio.front(), group.back() == 2 ? 1.0 : group.back() == 1 ? 0.8 : 0.5);
    EXPECT_EQ(ratio.back(), 0.5);
    return group.back() + 1;
  };
  EXPECT_EQ(groups_at(0.2), 3U);
  EXPECT_EQ(groups_at(0.3), 2U);
  EXPECT_EQ(groups_at(1.7), 2U);
  EXPECT_EQ(groups_at(1.8), 1U);
}

TEST(FeedGroups, TakeTheLowestFeedAndNeverMoreTimeThanAllowed) {
  std::mt19937 random(20111);
  std::uniform_real_distribution<double> share(0.3, 1.0);
  SearchScene scene(kSlowLine, {.limit_mm = 1.0}, kCellsOf1mm);
  for (int run = 0; run < 20; ++run) {
    std::vector<double> own(scene.cells.of.size());
    std::ranges::generate(own, [&] { return share(random); });
    auto ratio = own;
    const double most_loss_s = share(random);
    const auto group =
        grouped(scene, ratio, {.most_loss_s = most_loss_s, .shortest_s = kNoneTooShort_s});
    std::vector<double> lowest(own.size(), 1.0);
    double loss_s = 0.0;
    for (std::size_t i = 0; i < own.size(); ++i) {
      EXPECT_LE(group[i], i);
      EXPECT_TRUE(i == 0 || group[i] == group[i - 1] || group[i] == group[i - 1] + 1);
      lowest[group[i]] = std::min(lowest[group[i]], own[i]);
      loss_s += 0.1 / ratio[i] - 0.1 / own[i];
    }
    for (std::size_t i = 0; i < own.size(); ++i) {
      EXPECT_EQ(ratio[i], lowest[group[i]]) << i;
    }
    EXPECT_LT(loss_s, 1.02 * most_loss_s);
    EXPECT_LT(group.back() + 1, own.size()) << "the loss was for something";
  }
}

}  // namespace
}  // namespace steadyrest::contour::offline
