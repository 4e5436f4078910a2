// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/contour/online/test/closed_form.hpp>
#include <steadyrest/contour/online/test/closed_loop.hpp>
#include <steadyrest/contour/online/test/paths.hpp>

namespace steadyrest::contour::online {
namespace {

using kernel::signal::Motion;
using test::ClosedLoop;
using test::largest_step;
using test::LoopResult;
using test::Machine;
using test::PathSegment;
using test::pocket;

/// Time of an omniscient schedule: at each place the largest ratio that the closed form permits in
/// steady state, limited backwards by the fall and forwards by the rise that the slew allows, then
/// quantised. It pays nothing for speed changes or dead time.
double clairvoyant_s(const Machine& machine, const std::vector<PathSegment>& path) {
  struct Place {
    double length_mm, feed_mm_s, cap_mm_s, ratio;
    bool cutting;
  };
  std::vector<Place> places;
  for (const PathSegment& segment : path) {
    const int count = std::max(1, static_cast<int>(segment.length_mm / 0.05));
    for (int i = 0; i < count; ++i) {
      const double curvature = math::geometry::norm(
          math::geometry::station_at(segment, (i + 0.5) / count).curvature_1_mm);
      Place place{segment.length_mm / count, segment.feed_mm_s, segment.speed_limit_mm_s, 1.0,
                  segment.motion == Motion::feed};
      if (place.cutting && curvature > 0.0) {
        place.ratio =
            largest_step(machine, 1.0 / curvature, segment.feed_mm_s, machine.contour.limit_mm);
      }
      places.push_back(place);
    }
  }
  const auto seconds = [&](const Place& place) {
    double step = 0.0;
    for (const double ratio : machine.feed_override.ratio) {
      step = ratio <= place.ratio + 1e-9 ? ratio : step;
    }
    return place.length_mm /
           std::min(place.feed_mm_s * (place.cutting ? step : 1.0), place.cap_mm_s);
  };
  for (std::size_t i = places.size() - 1; i-- > 0;) {
    places[i].ratio =
        std::min(places[i].ratio,
                 places[i + 1].ratio + machine.envelope.feed_fall_1_s * seconds(places[i + 1]));
  }
  double time = 0.0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (i > 0) {
      places[i].ratio =
          std::min(places[i].ratio,
                   places[i - 1].ratio + machine.envelope.feed_rise_1_s * seconds(places[i - 1]));
    }
    time += seconds(places[i]);
  }
  return time;
}

struct PocketCase {
  double feed_mm_min;
  double gain_1_s;
  double dead_s;
  double scan_s;
};

class Pocket : public testing::TestWithParam<PocketCase> {};

// Bounds from both sides: at most 10 % slower than the omniscient schedule, with less than 0.1 % of
// the cutting above the limit. On slow machines, with long dead times and soft servos, a governor
// that reacts instead of forecasting fails.
TEST_P(Pocket, KeepsTheLimitAndLosesLittleTime) {
  const PocketCase& c = GetParam();
  Machine machine = test::mill(c.gain_1_s);
  machine.feed_override.dead_time_s = c.dead_s;
  machine.feed_override.scan_period_s = c.scan_s;
  const auto path = pocket(c.feed_mm_min / 60.0);
  ClosedLoop loop(machine, path);
  const LoopResult result = loop.run(0.010);
  EXPECT_LE(result.over_limit_share, 0.001);
  const double clairvoyant = clairvoyant_s(machine, path);
  EXPECT_LE(result.cycle_time_s, 1.10 * clairvoyant);
  // From below too: much faster than the steady state permits would be an error of this test.
  EXPECT_GE(result.cycle_time_s, 0.90 * clairvoyant);
  RecordProperty("over_clairvoyant", std::to_string(result.cycle_time_s / clairvoyant));
  RecordProperty("over_limit_share", std::to_string(result.over_limit_share));
}

INSTANTIATE_TEST_SUITE_P(Machines, Pocket,
                         testing::Values(PocketCase{2000, 50, 0.03, 0.01},
                                         PocketCase{3000, 50, 0.05, 0.02},
                                         PocketCase{2000, 33.3, 0.03, 0.01},
                                         PocketCase{4000, 83.3, 0.1, 0.05}));

}  // namespace
}  // namespace steadyrest::contour::online
