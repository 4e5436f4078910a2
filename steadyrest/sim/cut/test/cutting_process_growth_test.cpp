// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>

#include <steadyrest/sim/cut/cutting_process.hpp>
#include <steadyrest/sim/cut/test/cuts.hpp>

namespace steadyrest::sim {
namespace {

using test::benchmark;
using test::made;
using test::turns;

/// Mean growth of the vibration over a tooth pass, by the norm of one turn. The power method: the
/// vibration is scaled back every eight turns, and the first half of the record, in which other
/// modes still fade, does not count.
double growth(CuttingProcess& process, double speed_rev_s, std::size_t teeth, int n) {
  const CuttingProcess::Input input{.speed_rev_s = speed_rev_s};
  process.step(input);
  process.disturb(1e-3);
  const auto norm = [&] {
    double sum = 0.0;
    for (const auto& o : turns(process, input, 8)) {
      sum += o.displacement_mm[0] * o.displacement_mm[0];
    }
    return std::sqrt(sum);
  };
  double log = 0.0;
  double first = 0.0;
  for (int i = 0; i < n; ++i) {
    const double now = norm();
    log += std::log(now);
    if (2 * i == n) {
      first = log;
    }
    process.scale(1.0 / now);
  }
  const int counted = n - 1 - n / 2;
  return std::exp((log - first) / (8.0 * static_cast<double>(teeth) * counted));
}

TEST(CuttingProcess, GrowsByTheBenchmarksMultipliers) {
  // Converged dominant multipliers of the slot at 5000 rpm, by collocation.
  for (const auto& [depth_mm, truth] :
       {std::pair{0.2, 0.81974278}, std::pair{0.5, 1.07397559}, std::pair{1.0, 1.40647353}}) {
    CuttingProcess process =
        made({.cut = benchmark(depth_mm), .slowest_rev_s = 5000.0 / 60.0, .keeps_contact = true});
    EXPECT_NEAR(growth(process, 5000.0 / 60.0, 2, 40), truth, 2e-3 * truth) << depth_mm;
  }
}

// Second order: half the step, a quarter of the error; 0.3 leaves room for the next order.
TEST(CuttingProcess, IsOfSecondOrder) {
  const auto error = [](double steps) {
    CuttingProcess process = made({.cut = benchmark(1.0),
                                   .slowest_rev_s = 5000.0 / 60.0,
                                   .steps_per_period = steps,
                                   .keeps_contact = true});
    return std::abs(growth(process, 5000.0 / 60.0, 2, 40) - 1.40647353);
  };
  EXPECT_LT(error(80.0), 0.3 * error(40.0));
  EXPECT_LT(error(160.0), 0.3 * error(80.0));
}

}  // namespace
}  // namespace steadyrest::sim
