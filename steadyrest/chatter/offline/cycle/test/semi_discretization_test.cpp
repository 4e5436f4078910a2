// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/chatter/offline/cycle/stability.hpp>
#include <steadyrest/chatter/offline/test/cuts.hpp>
#include <steadyrest/chatter/offline/test/semi_discretization.hpp>
#include <steadyrest/kernel/testing/cases.hpp>

namespace steadyrest::chatter::offline::test {
namespace {

using kernel::testing::cases;

/// The method's own figures at 40, 80 and 200 steps, slot, 5000 rpm.
TEST(SemiDiscretization, HasItsPublishedConvergence) {
  const Process slot = benchmark_cut(1.0, Direction::up);
  struct Row {
    int m;
    std::vector<double> radius;  ///< at 0.2, 0.5 and 1 mm
  };
  for (const Row& row :
       cases({Row{40, {.808747, 1.043681, 1.350262}}, Row{80, {.816912, 1.066223, 1.392144}},
              Row{200, {.819286, 1.072727, 1.404168}}})) {
    for (std::size_t i = 0; i < 3; ++i) {
      const double depth = std::vector{0.2, 0.5, 1.0}[i];
      EXPECT_NEAR(radius_by_semi_discretization(slot, 5000.0 / 60.0, depth, row.m), row.radius[i],
                  2e-6)
          << row.m << " " << depth;
    }
  }
}

/// Two methods that share only the forces: extrapolated at second order, it matches the
/// collocation.
TEST(SemiDiscretization, ExtrapolatesToTheCollocation) {
  for (const auto& [immersion, rpm] : cases({std::pair{1.0, 5000.0}, std::pair{1.0, 15000.0}})) {
    const Process cut = benchmark_cut(immersion, Direction::up);
    for (const double depth : cases({0.3, 1.3})) {
      DelayCycle::Config config;
      config.speed_rev_s = rpm / 60.0;
      config.most_depth_mm = depth;
      DelayCycle cycle = DelayCycle::make(cut, config).value();
      cycle.set_depth(depth);
      const double coarse = radius_by_semi_discretization(cut, rpm / 60.0, depth, 80);
      const double fine = radius_by_semi_discretization(cut, rpm / 60.0, depth, 160);
      // Richardson: of an error in h², 4·f(h/2) − f(h) over 3 leaves h⁴.
      EXPECT_NEAR((4.0 * fine - coarse) / 3.0, std::exp(stability(cycle, {}).log_radius), 1e-4)
          << rpm << " " << depth;
    }
  }
}

}  // namespace
}  // namespace steadyrest::chatter::offline::test
