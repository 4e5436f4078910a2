// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/chatter/offline/depth/border_line.hpp>
#include <steadyrest/chatter/offline/depth/limit_depth.hpp>
#include <steadyrest/chatter/offline/test/cuts.hpp>
#include <steadyrest/kernel/testing/cases.hpp>

namespace steadyrest::chatter::offline::test {
namespace {

using kernel::testing::cases;
using kernel::testing::kSanitized;
using online::Law;

BorderLineConfig of_rpm(std::vector<double> rpm, double most_depth_mm) {
  BorderLineConfig out;
  for (const double n : rpm) {
    out.speed_rev_s.push_back(n / 60.0);
  }
  out.most_depth_mm = most_depth_mm;
  return out;
}

/// The line at a speed; above the greatest depth where it has no border.
double at(const BorderLine& line, double speed_rev_s, double most_depth_mm) {
  const auto next = std::ranges::lower_bound(line.speed_rev_s, speed_rev_s);
  const auto i = std::clamp<std::size_t>(static_cast<std::size_t>(next - line.speed_rev_s.begin()),
                                         1, line.speed_rev_s.size() - 1);
  const double share =
      (speed_rev_s - line.speed_rev_s[i - 1]) / (line.speed_rev_s[i] - line.speed_rev_s[i - 1]);
  return (1.0 - share) * line.depth_mm[i - 1].value_or(most_depth_mm) +
         share * line.depth_mm[i].value_or(most_depth_mm);
}

/// How many of the random speeds are off by more than promised.
int off_by_more(const Process& process, const BorderLineConfig& config, const BorderLine& line,
                int draws) {
  draws = kSanitized ? std::min(draws, 5) : draws;
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> speeds(config.speed_rev_s.front(),
                                                config.speed_rev_s.back());
  const double most = config.most_depth_mm;
  int out = 0;
  for (int i = 0; i < draws; ++i) {
    const double speed = speeds(random);
    double low = most;
    double high = 0.0;
    // At a cusp or a jump the line may be off in speed by 3e-4 of a lobe; any depth between those
    // there counts as right.
    for (const double near : {1.0 - 2e-4, 1.0 - 1e-4, 1.0, 1.0 + 1e-4, 1.0 + 2e-4}) {
      const double depth =
          limit_depth_mm(process, speed * near, config.modulation, most).value().value_or(most);
      low = std::min(low, depth);
      high = std::max(high, depth);
    }
    const double here = at(line, speed, most);
    const double tolerance = 1e-2 * here + 5e-4 * most;
    out += here < low - tolerance || here > high + tolerance ? 1 : 0;
  }
  return out;
}

TEST(BorderLine, OfTwoSpeedsIsTheWholeBorder) {
  for (const double immersion : cases({1.0, 0.5, 0.05})) {
    const Process cut = benchmark_cut(immersion, Direction::down);
    const auto config = of_rpm({5000.0, 25000.0}, 10.0);
    const auto line = border_line(cut, config);
    ASSERT_TRUE(line.has_value());
    EXPECT_TRUE(line->settled);
    EXPECT_LE(off_by_more(cut, config, *line, 300), 1) << immersion;
    // From both sides: fewer points would miss lobes, more would mean that it never settles.
    EXPECT_LT(line->speed_rev_s.size(), 5000U);
    EXPECT_GT(line->speed_rev_s.size(), 100U);
  }
}

TEST(BorderLine, KeepsTheGivenSpeedsAndTheirBorders) {
  const auto config = of_rpm({5000.0, 10000.0, 25000.0}, 2.0);
  const auto line = border_line(benchmark_cut(1.0, Direction::up), config);
  ASSERT_TRUE(line.has_value());
  const auto border = [&](double rpm) {
    const auto found = std::ranges::find(line->speed_rev_s, rpm / 60.0);
    return line->depth_mm.at(static_cast<std::size_t>(found - line->speed_rev_s.begin()));
  };
  // The reference's table, to half of its last digit.
  EXPECT_NEAR(border(5000.0).value(), 0.4086, 0.51e-4);
  EXPECT_NEAR(border(10000.0).value(), 0.3224, 0.51e-4);
  EXPECT_FALSE(border(25000.0).has_value());
  EXPECT_TRUE(std::ranges::is_sorted(line->speed_rev_s));
}

/// The cusp between two lobes of turning in closed form: both have a = −1/(2·Kr·Re G(iω)), the
/// speeds are (ω/2π)/(k + ε/2π) with ε = 2π − 2·atan(…).
TEST(BorderLine, FindsTheCuspsOfTurning) {
  Process p;
  p.cut.operation = Operation::turning;
  p.cut.tangential_n_mm2 = 2000.0;
  p.cut.radial_n_mm2 = 1000.0;
  Mode mode;
  mode.frequency_hz = 250.0;
  mode.damping_ratio = 0.012;
  mode.mass_kg = 2.26e8 / std::pow(2.0 * std::numbers::pi * 250.0, 2);
  p.modes = {mode};
  const auto config = of_rpm({3000.0, 8000.0}, 60.0);
  const auto line = border_line(p, config);
  ASSERT_TRUE(line.has_value());
  EXPECT_LE(off_by_more(p, config, *line, 300), 1);
  // A cusp is a point of the line that exceeds both neighbours by more than a bow can.
  double highest = 0.0;
  for (const auto& depth : line->depth_mm) {
    highest = std::max(highest, depth.value_or(60.0));
  }
  double true_highest = 0.0;
  for (double rpm = 3000.0; rpm <= 8000.0; rpm += kSanitized ? 200.0 : 1.0) {
    true_highest =
        std::max(true_highest, limit_depth_mm(p, rpm / 60.0, {}, 60.0).value().value_or(60.0));
  }
  EXPECT_GE(highest, 0.99 * true_highest);
}

TEST(BorderLine, KeepsTheIslandsOfHelicalTeeth) {
  Process cut = benchmark_cut(0.05, Direction::down);
  cut.tool.diameter_mm = 8.0;
  cut.tool.helix_rad = std::numbers::pi / 4.0;
  const auto config = of_rpm({17000.0, 19000.0}, 3.0);
  const auto line = border_line(cut, config);
  ASSERT_TRUE(line.has_value());
  EXPECT_LE(off_by_more(cut, config, *line, 100), 1);
}

TEST(BorderLine, UnderALawStaysWithinItsWork) {
  const Process cut = benchmark_cut(1.0, Direction::up);
  auto config = of_rpm({5000.0, 5400.0}, 3.0);
  config.modulation = {Law::sine, 0.1, 0.5, 1};
  double last = 0.0;
  const auto line = border_line(cut, config, [&](double share) { last = share; });
  ASSERT_TRUE(line.has_value());
  EXPECT_LE(line->speed_rev_s.size(), 202U);
  EXPECT_EQ(last, 1.0);
  EXPECT_LE(off_by_more(cut, config, *line, 10), 1);
}

TEST(BorderLine, DoesNotDependOnTheThreads) {
  const Process cut = benchmark_cut(0.5, Direction::down);
  auto config = of_rpm({6000.0, 9000.0, 20000.0}, 3.0);
  config.threads = 1;
  const auto one = border_line(cut, config);
  config.threads = 3;
  const auto three = border_line(cut, config);
  EXPECT_EQ(one->speed_rev_s, three->speed_rev_s);
  EXPECT_EQ(one->depth_mm, three->depth_mm);
}

TEST(BorderLine, RefusesSpeedsThatDoNotRise) {
  const Process cut = benchmark_cut(1.0, Direction::up);
  EXPECT_FALSE(border_line(cut, of_rpm({}, 1.0)));
  EXPECT_FALSE(border_line(cut, of_rpm({5000.0, 5000.0}, 1.0)));
  EXPECT_FALSE(border_line(cut, of_rpm({-1.0, 5000.0}, 1.0)));
  EXPECT_FALSE(border_line(cut, of_rpm({5000.0}, 1e9)));
}

}  // namespace
}  // namespace steadyrest::chatter::offline::test
