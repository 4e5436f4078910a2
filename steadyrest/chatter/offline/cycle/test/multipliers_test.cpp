// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include <steadyrest/chatter/offline/cycle/multipliers.hpp>
#include <steadyrest/chatter/offline/test/cuts.hpp>
#include <steadyrest/kernel/testing/cases.hpp>

namespace steadyrest::chatter::offline::test {
namespace {

using kernel::testing::cases;
using online::Law;
using Exact = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;

/// ln|μ| of the two largest: the passes' maps multiplied out with 19 digits, and all eigenvalues of
/// the product.
std::vector<double> dense_log_moduli(DelayCycle& cycle) {
  const Eigen::Index size = cycle.state_size();
  Exact period = Exact::Identity(size, size);
  for (std::size_t p = 0; p < cycle.passes(); ++p) {
    Eigen::MatrixXd pass = Eigen::MatrixXd::Identity(size, size);
    for (Eigen::Index i = 0; i < size; ++i) {
      cycle.advance(p, pass.col(i));
    }
    period = (pass.cast<long double>() * period).eval();
  }
  const Eigen::EigenSolver<Exact> eigen(period, false);
  std::vector<double> out;
  for (const auto& value : eigen.eigenvalues()) {
    out.push_back(static_cast<double>(std::log(std::abs(value))));
  }
  std::ranges::sort(out, std::ranges::greater{});
  out.resize(2);
  return out;
}

struct SlowLaw {
  double rpm;
  Law law;
  double rvf;
  double depth_mm;
};

/// Laws so slow that a vibration grows to millions of times its final size; with a pair of leading
/// multipliers, and with two real ones far from and near each other.
const SlowLaw kSlowLaws[] = {{5000.0, Law::sine, 0.025, 1.0},
                             {12000.0, Law::triangle, 0.025, 2.0},
                             {12000.0, Law::sine, 0.02, 1.0}};

DelayCycle under(const SlowLaw& slow) {
  DelayCycle out = DelayCycle::make(benchmark_cut(1.0, Direction::up),
                                    {.speed_rev_s = slow.rpm / 60.0,
                                     .modulation = {slow.law, 0.2, slow.rvf, 1},
                                     .course = {},
                                     .most_depth_mm = slow.depth_mm})
                       .value();
  out.set_depth(slow.depth_mm);
  return out;
}

TEST(Multipliers, UnderSlowLawsAreTheEigenvaluesOfTheWholeMap) {
  for (const SlowLaw& slow : cases(kSlowLaws)) {
    DelayCycle cycle = under(slow);
    const Multipliers found = multipliers(cycle);
    const auto want = dense_log_moduli(cycle);
    ASSERT_EQ(found.log_modulus.size(), 2U);
    // The first over its own modulus: from discrete QR, not Arnoldi's method.
    EXPECT_NEAR(std::abs(found.value[0]), 1.0, 1e-12);
    EXPECT_NEAR(found.log_modulus[0], want[0], 1e-8) << slow.rvf;
    EXPECT_NEAR(found.log_modulus[1], want[1], 1e-8) << slow.rvf;
  }
}

// At least three periods, of two vectors each; Arnoldi's passes come first.
TEST(Multipliers, UnderSlowLawsDriveTheWantedVectorsAlone) {
  for (const SlowLaw& slow : cases(kSlowLaws)) {
    DelayCycle cycle = under(slow);
    const auto tried =
        multipliers_of([&](const auto& state) { cycle.apply(state); }, cycle.state_size());
    for (const std::size_t wanted : {1U, 2U}) {
      const Multipliers found = multipliers(cycle, wanted);
      EXPECT_EQ(found.value.size(), wanted);
      EXPECT_EQ(found.log_modulus.size(), wanted);
      const std::size_t vectors = found.passes_done / cycle.passes() - tried.passes_done;
      EXPECT_GE(vectors, 6U) << slow.rvf;
      EXPECT_LE(vectors, 10U) << slow.rvf;
    }
  }
}

}  // namespace
}  // namespace steadyrest::chatter::offline::test
