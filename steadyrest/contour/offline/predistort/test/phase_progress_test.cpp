// SPDX-License-Identifier: Apache-2.0
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/contour/offline/predistort/phase_progress.hpp>

namespace steadyrest::contour::offline {
namespace {

struct Told {
  double share = 0.0;
  std::string what;
};

TEST(PhaseProgress, CountsRunsAndTheirShares) {
  std::vector<Told> told;
  const std::function<void(double, std::string_view)> report =
      [&](double share, std::string_view what) { told.push_back({share, std::string(what)}); };
  PhaseProgress progress(report, 10);
  progress.phase("one", 2);
  progress.run(0.5);
  progress.ran();
  progress.run(0.5);
  // It ends early: the next begins where it would have ended.
  progress.phase("two", 8);
  progress.run(2.0);
  ASSERT_EQ(told.size(), 5U);
  EXPECT_EQ(told[0].what, "one");
  EXPECT_DOUBLE_EQ(told[1].share, 0.05);
  EXPECT_DOUBLE_EQ(told[2].share, 0.15);
  EXPECT_EQ(told[3].what, "two");
  EXPECT_DOUBLE_EQ(told[3].share, 0.2);
  EXPECT_DOUBLE_EQ(told[4].share, 0.3);
}

TEST(PhaseProgress, NeverSaysThatItIsDone) {
  double last = 0.0;
  const std::function<void(double, std::string_view)> report =
      [&](double share, std::string_view /*what*/) { last = share; };
  PhaseProgress progress(report, 2);
  for (int i = 0; i < 5; ++i) {
    progress.phase("again", 2);
    progress.ran();
    progress.run(1.0);
  }
  EXPECT_DOUBLE_EQ(last, 0.99);
}

}  // namespace
}  // namespace steadyrest::contour::offline
