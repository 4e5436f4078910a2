// SPDX-License-Identifier: Apache-2.0
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/trial/timing/quantiles.hpp>

namespace steadyrest::trial::timing {
namespace {

TEST(Quantiles, AreTheLeastValuesThatSoManyDoNotExceed) {
  std::vector<double> values(2000);
  std::iota(values.rbegin(), values.rend(), 1.0);
  const Quantiles of = quantiles(values);
  EXPECT_EQ(of.p50, 1000.0);
  EXPECT_EQ(of.p999, 1998.0);
  EXPECT_EQ(of.worst, 2000.0);
}

TEST(Quantiles, OfOneValueAreThatValueAndOfNoneZero) {
  EXPECT_EQ(quantiles({3.0}).p50, 3.0);
  EXPECT_EQ(quantiles({3.0}).p999, 3.0);
  EXPECT_EQ(quantiles({}).p999, 0.0);
  EXPECT_EQ(quantiles({}).worst, 0.0);
}

}  // namespace
}  // namespace steadyrest::trial::timing
