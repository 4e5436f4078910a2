// SPDX-License-Identifier: Apache-2.0
#include <map>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/thermal/offline/fit/structure_search.hpp>
#include <steadyrest/thermal/offline/test/shop_log.hpp>

namespace steadyrest::thermal::offline {
namespace {

/// Number of modes, powers and inputs.
using StructureKind = std::tuple<std::size_t, std::vector<int>, std::size_t>;
using Inputs = std::vector<std::pair<std::size_t, double>>;

Inputs inputs_of(const Structure& s) {
  Inputs out;
  for (const Structure::Ambient& a : s.ambient) {
    out.emplace_back(a.sensor, a.tau_s);
  }
  return out;
}

// Sets of inputs that did well with one mode continue to two, from all three powers together: none
// of them twice, or the second place of each kind would repeat the first. The bed lags the room by
// 90 min and moves the machine, so one of the two is always included.
TEST(StructureSearch, GivesTwoOfEachKindWithDifferentInputs) {
  const Log log = test::shop(3, {3000, 1500, 4500});
  const FitData data = fit_data(log, 0, -1e300, 1e300);
  const auto found = search(data, {3.0, 4.0 * 3600.0, 0.3},
                            {.most_modes = 2, .most_ambients = 1, .sensor = {0, 1}});
  std::map<StructureKind, std::vector<Inputs>> kinds;
  for (const Structure& s : found) {
    kinds[{s.mode.size(), s.power, s.ambient.size()}].push_back(inputs_of(s));
  }
  // 1 or 2 modes, 3 powers, 0 or 1 input.
  EXPECT_EQ(kinds.size(), 12U);
  for (const auto& [kind, inputs] : kinds) {
    // Without inputs there is one set of them.
    EXPECT_EQ(inputs.size(), std::get<2>(kind) == 0 ? 1U : 2U);
    EXPECT_EQ(std::set<Inputs>(inputs.begin(), inputs.end()).size(), inputs.size());
  }
}

}  // namespace
}  // namespace steadyrest::thermal::offline
