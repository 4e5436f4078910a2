// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <steadyrest/contour/offline/learn/learnt.hpp>

namespace steadyrest::contour::offline {
namespace {

Learnt::Stretch lifted(double from_mm, double to_mm, double shift_mm) {
  return {.from_mm = from_mm,
          .to_mm = to_mm,
          .knots = {{.at_mm = from_mm, .shift_mm = {0, 0, shift_mm}, .unknown_mm = {0, 0, 1.0}},
                    {.at_mm = to_mm, .shift_mm = {0, 0, shift_mm}, .unknown_mm = {0, 0, 1.0}}}};
}

// Two records of one place are two readings of the same error; a refinement is what is still left.
TEST(Refinement, AddsToTheMeanOfTheRecords) {
  Learnt learnt;
  learnt.add({lifted(0, 10, 0.010)});
  learnt.add({lifted(0, 10, 0.020)});
  learnt.refine({lifted(5, 15, 0.002)});
  learnt.refine({lifted(5, 15, 0.001)});
  EXPECT_NEAR(learnt.shift_mm(2.0)[2], 0.015, 1e-12);
  EXPECT_NEAR(learnt.shift_mm(7.0)[2], 0.018, 1e-12);
  EXPECT_NEAR(learnt.shift_mm(12.0)[2], 0.003, 1e-12);
  learnt.unrefine(1);
  EXPECT_NEAR(learnt.shift_mm(12.0)[2], 0.002, 1e-12);
}

TEST(Refinement, IsNoKnowledgeOfTheMachine) {
  Learnt learnt;
  learnt.refine({lifted(0, 10, 0.002)});
  EXPECT_TRUE(learnt.empty());
  EXPECT_EQ(learnt.unknown_mm(5.0), (kernel::signal::Point{}));
}

}  // namespace
}  // namespace steadyrest::contour::offline
