// SPDX-License-Identifier: Apache-2.0
// What every comparator must withstand.
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/kernel/rt/testing/allocation_guard.hpp>
#include <steadyrest/motion/offline/test/scenes.hpp>
#include <steadyrest/motion/online/estimator/backward_difference.hpp>
#include <steadyrest/motion/online/estimator/event_fit.hpp>
#include <steadyrest/motion/online/estimator/m_over_t.hpp>
#include <steadyrest/motion/online/estimator/pll.hpp>
#include <steadyrest/motion/online/estimator/savitzky_golay.hpp>
#include <steadyrest/motion/online/estimator/worst_case_difference.hpp>

namespace steadyrest::motion::offline::test {
namespace {

using online::BackwardDifference;
using online::EventFit;
using online::MOverT;
using online::Pll;
using online::SavitzkyGolay;
using online::WorstCaseDifference;

struct Comparator {
  std::string name;
  std::unique_ptr<Estimator> estimator;
};

template <class E>
Comparator made(const std::string& name, const typename E::Config& config) {
  return {name, std::make_unique<E>(E::make(config).value())};
}

std::vector<Comparator> all() {
  std::vector<Comparator> out;
  out.push_back(made<BackwardDifference>("difference", {}));
  out.push_back(made<MOverT>("m_over_t", {}));
  out.push_back(made<MOverT>("m_over_t as the encoder component", MOverT::linuxcnc_encoder(0.001)));
  out.push_back(made<Pll>("pll", {}));
  out.push_back(made<SavitzkyGolay>("savitzky_golay", {}));
  out.push_back(made<EventFit>("event_fit", {}));
  out.push_back(made<EventFit>("event_fit of degree 3", {.degree = 3, .edges = 8, .skip = 3}));
  out.push_back(made<EventFit>("event_fit with window", {.edges = 512, .window_s = 0.004}));
  out.push_back(made<WorstCaseDifference>("worst_case_difference", {}));
  return out;
}

bool finite(const Estimate& e) {
  return std::isfinite(e.position_mm) && std::isfinite(e.velocity_mm_s) &&
         std::isfinite(e.acceleration_mm_s2);
}

double worst_speed(Estimator& estimator, const Record& record) {
  double worst = 0.0;
  for (const Estimate& e : run(estimator, record)) {
    EXPECT_TRUE(finite(e));
    worst = std::max(worst, std::abs(e.velocity_mm_s));
  }
  return worst;
}

TEST(Comparators, DoNotAllocate) {
  const Record& record = s_curve_ideal();
  for (Comparator& c : all()) {
    SCOPED_TRACE(c.name);
    const kernel::rt::testing::AllocationGuard guard;
    auto edge = record.edges.begin();
    for (const Tick& tick : record.ticks) {
      for (; edge != record.edges.end() && edge->t_s <= tick.t_s; ++edge) {
        c.estimator->edge(*edge);
      }
      c.estimator->tick(tick);
    }
  }
}

TEST(Comparators, GiveZeroAtStandstillFromTheFirstTick) {
  for (Comparator& c : all()) {
    for (int k = 0; k < 200; ++k) {
      const Estimate e = c.estimator->tick({k * 0.001, -123456789, -123456.789, -123456.788});
      EXPECT_EQ(e.velocity_mm_s, 0.0) << c.name;
      EXPECT_EQ(e.acceleration_mm_s2, 0.0) << c.name;
      EXPECT_NEAR(e.position_mm, -123456.7885, 0.0006) << c.name;
      EXPECT_EQ(e.t_s, k * 0.001) << c.name;
    }
  }
}

TEST(Comparators, ReversalGivesNoSpeedThatTheAxisNeverHad) {
  for (const double amplitude : {0.01, 0.0502, 0.9997}) {
    const Record record = offline::record(sine(amplitude, 3.0, 1.0), {});
    for (Comparator& c : all()) {
      if (c.name != "m_over_t as the encoder component") {  // known for it
        EXPECT_LT(worst_speed(*c.estimator, record), 1.3 * record.max_speed_mm_s + 1.1)
            << c.name << " at " << amplitude;
      }
    }
  }
}

TEST(Comparators, DitherOnALineStaysFiniteAndWithinACountPerTick) {
  for (const double amplitude : {0.0003, 0.0012}) {
    for (const double frequency : {7.0, 90.0, 333.0}) {
      const Record record = offline::record(dither(amplitude, frequency, 0.5), {});
      for (Comparator& c : all()) {
        if (c.name != "m_over_t as the encoder component") {
          EXPECT_LT(worst_speed(*c.estimator, record), 3.0 * record.max_speed_mm_s + 2.1)
              << c.name << " at " << amplitude << " mm " << frequency << " Hz";
        }
      }
    }
  }
}

TEST(Comparators, BearJitterGapsLostEdgesAndStampsThatRepeat) {
  Recording how;
  how.tick_jitter_s = 1e-4;
  how.lost_share = 0.05;
  how.clock_s = 1e-3;  // many edges with one stamp
  how.line_error_counts = 0.1;
  Record record = offline::record(s_curve(), how);
  record.ticks.erase(record.ticks.begin() + 300, record.ticks.begin() + 350);
  for (Comparator& c : all()) {
    for (const Estimate& e : run(*c.estimator, record)) {
      ASSERT_TRUE(finite(e)) << c.name << " at " << e.t_s;
    }
  }
}

TEST(Comparators, TicksAloneAreBorne) {
  const Record record = without_edges(sine_ideal());
  for (Comparator& c : all()) {
    for (const Estimate& e : run(*c.estimator, record)) {
      ASSERT_TRUE(finite(e)) << c.name;
    }
  }
}

}  // namespace
}  // namespace steadyrest::motion::offline::test
