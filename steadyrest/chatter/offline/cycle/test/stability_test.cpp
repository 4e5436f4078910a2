// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/chatter/offline/cycle/stability.hpp>
#include <steadyrest/chatter/offline/test/cuts.hpp>
#include <steadyrest/kernel/testing/cases.hpp>

namespace steadyrest::chatter::offline::test {
namespace {

using kernel::testing::cases;
using kernel::testing::kSanitized;
using online::Law;

Stability at(const Process& process, double rpm, double depth_mm, const Modulation& modulation = {},
             const StabilityOptions& options = {}) {
  DelayCycle::Config config;
  config.speed_rev_s = rpm / 60.0;
  config.modulation = modulation;
  config.most_depth_mm = depth_mm;
  DelayCycle cycle = DelayCycle::make(process, config).value();
  cycle.set_depth(depth_mm);
  return stability(cycle, options);
}

/// Converged figures of two independent methods (spectral collocation; RK4 in the time domain).
TEST(Stability, MultipliersOfTheBenchmarkAt5000Rpm) {
  struct Row {
    double immersion;
    Direction direction;
    std::vector<double> radius;  ///< at 0.2, 0.5, 1 and 2 mm
  };
  const std::vector<Row> rows{
      {1.0, Direction::up, {0.819743, 1.073976, 1.406474, 1.760636}},
      {0.5, Direction::down, {0.693725, 0.812383, 1.086208, 1.636201}},
      {0.5, Direction::up, {0.915737, 1.305859, 1.758048, 2.004588}},
      {0.1, Direction::down, {0.692443, 0.731956, 0.890966, 1.268546}},
      {0.1, Direction::up, {0.721686, 0.817507, 0.991074, 1.295811}},
      {0.05, Direction::down, {0.678036, 0.688866, 0.749503, 0.952409}},
      {0.05, Direction::up, {0.697661, 0.734646, 0.812727, 0.976861}},
  };
  for (const Row& row : rows) {
    const Process cut = benchmark_cut(row.immersion, row.direction);
    const std::vector<double> depth{0.2, 0.5, 1.0, 2.0};
    for (std::size_t i = 0; i < depth.size(); ++i) {
      EXPECT_NEAR(std::exp(at(cut, 5000.0, depth[i]).log_radius), row.radius[i], 1e-6)
          << row.immersion << " " << depth[i];
    }
  }
}

// The published 0.8192, 1.0726 and 1.4040 are a semi-discretization's and good to three digits;
// these are converged: collocations of 40 and 80 nodes agree on them.
TEST(Stability, SlotMultipliersToEightDigits) {
  const Process slot = benchmark_cut(1.0, Direction::up);
  EXPECT_NEAR(std::exp(at(slot, 5000.0, 0.2).log_radius), 0.81974278, 1e-8);
  EXPECT_NEAR(std::exp(at(slot, 5000.0, 0.5).log_radius), 1.07397559, 1e-8);
  EXPECT_NEAR(std::exp(at(slot, 5000.0, 1.0).log_radius), 1.40647353, 1e-8);
  EXPECT_NEAR(std::exp(at(slot, 10000.0, 0.2).log_radius), 0.94084672, 1e-8);
  EXPECT_NEAR(std::exp(at(slot, 10000.0, 2.0).log_radius), 1.40351295, 1e-8);
  EXPECT_NEAR(std::exp(at(slot, 15000.0, 1.0).log_radius), 1.13058766, 1e-8);
  EXPECT_NEAR(std::exp(at(slot, 25000.0, 0.5).log_radius), 0.84153824, 1e-8);
  EXPECT_NEAR(std::exp(at(slot, 25000.0, 2.0).log_radius), 0.58143833, 1e-8);
}

TEST(Stability, NamesTypeAndFrequencyOfTheChatter) {
  const Stability hopf =
      at(benchmark_cut(1.0, Direction::up), 5000.0, 1.0, {}, {.frequency = true});
  EXPECT_EQ(hopf.type, ChatterType::hopf);
  EXPECT_NEAR(hopf.multiplier.real(), -0.122946, 1e-6);
  EXPECT_NEAR(std::abs(hopf.multiplier.imag()), 1.401090, 1e-6);
  EXPECT_GT(*hopf.frequency_hz, 922.0);
  EXPECT_LT(*hopf.frequency_hz, 1000.0);
  // Flip: a whole number and a half of waves between the teeth.
  const Stability flip =
      at(benchmark_cut(1.0, Direction::up), 20000.0, 5.0, {}, {.frequency = true});
  EXPECT_EQ(flip.type, ChatterType::flip);
  const double waves = *flip.frequency_hz * 60.0 / (2.0 * 20000.0);
  EXPECT_NEAR(waves - std::floor(waves), 0.5, 1e-9);
}

/// Figures from collocation in the angle domain, two rows also from RK4 with the delay solved
/// exactly.
TEST(Stability, ModulatedSlotAndDownMilling) {
  struct Row {
    double immersion;
    Law law;
    double rpm, rva, rvf, depth_mm, radius;
  };
  const std::vector<Row> rows{
      {1.0, Law::sine, 5000, .1, .1, 1, .033948},
      {1.0, Law::sine, 5000, .2, .1, 1, .044613},
      {1.0, Law::sine, 12000, .1, .1, 1, 3.7532347e-4},
      {1.0, Law::sine, 12000, .2, .2, 2, .24786583},
      {1.0, Law::triangle, 5000, .1, .1, 1, .97725365},
      {1.0, Law::triangle, 5000, .2, .1, 1, .0032550985},
      {1.0, Law::triangle, 12000, .1, .1, 1, 4.2458405e-4},
      {1.0, Law::triangle, 12000, .2, .2, 2, .20541735},
      {1.0, Law::square, 5000, .1, .1, 1, .01685},
      {1.0, Law::square, 5000, .2, .1, 1, 12.7146},
      {1.0, Law::square, 12000, .1, .1, 1, .0056952221},
      {1.0, Law::square, 12000, .2, .2, 2, 2.0297059},
      {.05, Law::sine, 5000, .1, .1, 1, .0014110587},
      {.05, Law::sine, 5000, .2, .1, 1, 4.80841e-5},
      {.05, Law::sine, 12000, .1, .1, 1, .12295207},
      {.05, Law::sine, 12000, .2, .2, 2, .12315781},
      {.05, Law::triangle, 5000, .1, .1, 1, 9.4115644e-4},
      {.05, Law::triangle, 5000, .2, .1, 1, 1.7867885e-4},
      {.05, Law::triangle, 12000, .1, .1, 1, .1620293},
      {.05, Law::triangle, 12000, .2, .2, 2, .2061927},
      {.05, Law::square, 5000, .1, .1, 1, .0066309008},
      {.05, Law::square, 5000, .2, .1, 1, 3.0622534e-5},
      {.05, Law::square, 12000, .1, .1, 1, .056294439},
      {.05, Law::square, 12000, .2, .2, 2, .04959198},
  };
  for (const Row& row : rows) {
    const Process cut =
        benchmark_cut(row.immersion, row.immersion < 1.0 ? Direction::down : Direction::up);
    const Stability found = at(cut, row.rpm, row.depth_mm, {row.law, row.rva, row.rvf, 1});
    EXPECT_NEAR(found.log_radius, std::log(row.radius), 1e-4)
        << row.immersion << " " << static_cast<int>(row.law) << " " << row.rpm << " " << row.rva;
  }
}

/// Slow modulation: stable by the radius, yet a vibration grows a thousandfold on the way.
TEST(Stability, SlowModulationLetsVibrationsGrowOnTheWay) {
  const Process slot = benchmark_cut(1.0, Direction::up);
  double last = 1.0;
  for (const double rvf : cases({0.1, 0.02})) {
    const Stability found =
        at(slot, 5000.0, 1.0, {Law::triangle, 0.2, rvf, 1}, {.peak_growth = true});
    EXPECT_TRUE(found.stable);
    // The reference: ×16 at RVF 0.1, ×921 at 0.02.
    EXPECT_GT(found.peak_growth, 8.0 * last);
    last = found.peak_growth;
  }
  EXPECT_GT(last, kSanitized ? 8.0 : 500.0);
  EXPECT_LT(last, 1500.0);
}

// Two ways through the solver: one tooth pass with one delay, and a revolution with two. A
// revolution is two passes, hence twice the logarithm.
TEST(Stability, UnevenPitchNearEvenIsEven) {
  Process cut = benchmark_cut(0.5, Direction::down);
  const double even = at(cut, 5000.0, 1.0).log_radius;
  cut.tool.pitch_rad = {M_PI - 1e-8, M_PI + 1e-8};
  EXPECT_NEAR(at(cut, 5000.0, 1.0).log_radius, 2.0 * even, 1e-6);
}

/// A damping far beyond the literature's 20 N/mm decays faster than any mode oscillates: the nodes
/// must follow it.
TEST(Stability, StaysConvergedUnderStrongProcessDamping) {
  Process cut = benchmark_cut(1.0, Direction::up);
  cut.cut.process_damping_n_mm = 14155.0;
  const auto log_radius = [&](double fineness) {
    DelayCycle::Config config;
    config.speed_rev_s = 5000.0 / 60.0;
    config.most_depth_mm = 5.0;
    config.fineness = fineness;
    DelayCycle cycle = DelayCycle::make(cut, config).value();
    cycle.set_depth(5.0);
    return stability(cycle, {}).log_radius;
  };
  EXPECT_NEAR(log_radius(1.0), log_radius(2.0), 1e-7);
}

TEST(Stability, RefusesAModulationWithoutPrincipalPeriod) {
  DelayCycle::Config config;
  config.speed_rev_s = 80.0;
  // An irrational RVF never meets a tooth pass again.
  config.modulation = {Law::sine, 0.1, 0.1 * M_SQRT2, 1};
  EXPECT_FALSE(DelayCycle::make(benchmark_cut(1.0, Direction::up), config).has_value());
}

/// A small swing must not move the frequency: the strongest of the lines 1/T apart is the constant
/// speed's own.
TEST(Stability, FrequencyUnderModulationIsThatOfTheStrongestLine) {
  const Process slot = benchmark_cut(1.0, Direction::up);
  const auto at = [&](const Modulation& law) {
    DelayCycle::Config config;
    config.speed_rev_s = 5000.0 / 60.0;
    config.modulation = law;
    config.most_depth_mm = 0.5;
    return stability_at(slot, config, {.frequency = true}).value();
  };
  const Stability constant = at({});
  const Stability swung = at({online::Law::sine, 1e-3, 0.1, 1});
  EXPECT_NEAR(constant.frequency_step_hz, 2.0 * 5000.0 / 60.0, 1e-9);
  EXPECT_NEAR(swung.frequency_step_hz, 0.1 * 5000.0 / 60.0, 1e-9);
  EXPECT_NEAR(*swung.frequency_hz, *constant.frequency_hz, 0.1);
  // A true swing: a line about the mode's 922 Hz.
  EXPECT_NEAR(*at({online::Law::square, 0.2, 0.1, 1}).frequency_hz, 940.0, 60.0);
}

}  // namespace
}  // namespace steadyrest::chatter::offline::test
