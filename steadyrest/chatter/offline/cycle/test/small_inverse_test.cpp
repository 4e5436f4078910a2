// SPDX-License-Identifier: Apache-2.0
#include <random>
#include <span>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include <steadyrest/chatter/offline/cycle/small_inverse.hpp>

namespace steadyrest::chatter::offline::test {
namespace {

Eigen::VectorXd applied(const SmallInverse& inverse, const Eigen::VectorXd& in) {
  Eigen::VectorXd out(in.size());
  const auto size = static_cast<std::size_t>(in.size());
  inverse.apply({in.data(), size}, {out.data(), size});
  return out;
}

TEST(SmallInverse, SolvesWhatEigenSolves) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  SmallInverse inverse;  // rebuilt for each size
  // On both sides of every block of rows: 4, 8, 24 and the 128 that fit on the stack.
  for (const int size : {1, 2, 3, 4, 7, 8, 21, 24, 25, 31, 44, 64, 127, 130}) {
    const Eigen::MatrixXd m =
        Eigen::MatrixXd::NullaryExpr(size, size, [&] { return normal(random); });
    const Eigen::VectorXd right =
        Eigen::VectorXd::NullaryExpr(size, [&] { return normal(random); });
    inverse.make(m, 0.3);
    const Eigen::MatrixXd a = Eigen::MatrixXd::Identity(size, size) + 0.3 * m;
    const Eigen::VectorXd want = a.fullPivLu().solve(right);
    EXPECT_LT((applied(inverse, right) - want).norm(), 1e-11 * a.inverse().norm() * right.norm())
        << size;
  }
}

/// I + M is a cyclic shift: each of its diagonal numbers is 0.
TEST(SmallInverse, TakesRowsThatMustBeExchanged) {
  constexpr int kSize = 13;
  // Without pivots the first step divides by 0.
  Eigen::MatrixXd m = -Eigen::MatrixXd::Identity(kSize, kSize);
  for (int i = 0; i < kSize; ++i) {
    m(i, (i + 5) % kSize) += 1.0;
  }
  SmallInverse inverse;
  inverse.make(m, 1.0);
  Eigen::VectorXd right = Eigen::VectorXd::LinSpaced(kSize, 1.0, 13.0);
  const Eigen::VectorXd x = applied(inverse, right);
  for (int i = 0; i < kSize; ++i) {
    EXPECT_EQ(x[(i + 5) % kSize], right[i]);
  }
}

}  // namespace
}  // namespace steadyrest::chatter::offline::test
