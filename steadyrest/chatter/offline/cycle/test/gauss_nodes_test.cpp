// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <functional>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/chatter/offline/cycle/columns.hpp>
#include <steadyrest/chatter/offline/cycle/gauss_nodes.hpp>

namespace steadyrest::chatter::offline {
namespace {

using Eigen::Index;

Eigen::VectorXd at_nodes(const GaussNodes& nodes, const std::function<double(double)>& f) {
  return nodes.node.unaryExpr(f);
}

// Abramowitz and Stegun, table 25.4: abscissae and weights on [−1, 1], to ten digits.
TEST(GaussNodes, AreThoseOfThePublishedTable) {
  const auto expect = [](Index n, Index i, double abscissa, double weight) {
    const GaussNodes& nodes = GaussNodes::of(n);
    EXPECT_NEAR(2.0 * nodes.node[i] - 1.0, abscissa, 5e-11) << n << ' ' << i;
    EXPECT_NEAR(2.0 * nodes.weight[i], weight, 5e-11) << n << ' ' << i;
  };
  expect(1, 0, 0.0, 2.0);
  expect(2, 1, 0.5773502692, 1.0);
  expect(3, 2, 0.7745966692, 0.5555555556);
  expect(3, 1, 0.0, 0.8888888889);
  expect(5, 4, 0.9061798459, 0.2369268851);
  expect(5, 0, -0.9061798459, 0.2369268851);
  expect(5, 3, 0.5384693101, 0.4786286705);
  expect(10, 9, 0.9739065285, 0.0666713443);
  expect(10, 5, 0.1488743390, 0.2955242247);
}

// Degree 2n − 1 is exact, degree 2n is not: ∫₀¹ x^k = 1/(k + 1).
TEST(GaussNodes, IntegrateToDegreeTwoNMinusOneAndNoFurther) {
  for (const Index n : {1, 2, 4, 7, 12}) {
    const GaussNodes& nodes = GaussNodes::of(n);
    for (int k = 0; k <= 2 * n - 1; ++k) {
      const auto power = [k](double x) { return std::pow(x, k); };
      EXPECT_NEAR(nodes.weight.dot(at_nodes(nodes, power)), 1.0 / (k + 1), 2e-15) << n << ' ' << k;
    }
    if (n <= 4) {
      const auto next = [n](double x) { return std::pow(x, 2 * n); };
      EXPECT_GT(std::abs(nodes.weight.dot(at_nodes(nodes, next)) -
                         1.0 / (2.0 * static_cast<double>(n) + 1)),
                1e-6);
    }
  }
}

// From 0 to each node: exact to degree n − 1, and the second integral to n − 2.
TEST(GaussNodes, IntegrateFromTheStartToEachNode) {
  for (const Index n : {2, 5, 16, 40}) {
    const GaussNodes& nodes = GaussNodes::of(n);
    for (int k = 0; k < n; ++k) {
      const Eigen::VectorXd power = at_nodes(nodes, [k](double x) { return std::pow(x, k); });
      const Eigen::VectorXd once =
          at_nodes(nodes, [k](double x) { return std::pow(x, k + 1) / (k + 1); });
      EXPECT_LT((nodes.integral * power - once).cwiseAbs().maxCoeff(), 1e-13) << n << ' ' << k;
      if (k + 1 < n) {
        const Eigen::VectorXd twice =
            at_nodes(nodes, [k](double x) { return std::pow(x, k + 2) / ((k + 1) * (k + 2)); });
        EXPECT_LT((nodes.integral2 * power - twice).cwiseAbs().maxCoeff(), 1e-13) << n << ' ' << k;
      }
    }
  }
}

TEST(GaussNodes, RiseWithinTheIntervalAndAreSymmetric) {
  for (Index n = 1; n <= GaussNodes::kMost; ++n) {
    const GaussNodes& nodes = GaussNodes::of(n);
    ASSERT_EQ(nodes.node.size(), n);
    EXPECT_NEAR(nodes.weight.sum(), 1.0, 1e-13) << n;
    EXPECT_GT(nodes.weight.minCoeff(), 0.0) << n;
    for (Index i = 0; i < n; ++i) {
      EXPECT_GT(nodes.node[i], i == 0 ? 0.0 : nodes.node[i - 1]);
      EXPECT_LT(nodes.node[i], 1.0);
      EXPECT_NEAR(nodes.node[i] + nodes.node[n - 1 - i], 1.0, 1e-15) << n << ' ' << i;
    }
  }
}

// Exact for polynomials of degree n − 1 anywhere, outside the nodes too; 1 on a node is that node.
TEST(GaussNodes, InterpolatePolynomials) {
  const GaussNodes& nodes = GaussNodes::of(6);
  const auto f = [](double x) { return ((((2 * x - 1) * x + 3) * x - 4) * x + 5) * x - 6; };
  const Eigen::VectorXd values = at_nodes(nodes, f);
  for (const double x : {0.0, 0.1, 0.333, 0.5, 0.999, 1.0, 1.2, -0.1}) {
    EXPECT_NEAR(nodes.interpolation(x).dot(values), f(x), 1e-12) << x;
    EXPECT_NEAR(nodes.interpolation(x).sum(), 1.0, 1e-14) << x;
  }
  for (Index i = 0; i < 6; ++i) {
    const Eigen::RowVectorXd row = nodes.interpolation(nodes.node[i]);
    EXPECT_EQ(row[i], 1.0);
    EXPECT_EQ(row.sum(), 1.0);
  }
}

// The error falls exponentially with the nodes: half as many again are a million times better.
TEST(GaussNodes, ConvergeSpectrally) {
  const auto worst = [](Index n) {
    const GaussNodes& nodes = GaussNodes::of(n);
    const Eigen::VectorXd values = at_nodes(nodes, [](double x) { return std::sin(12.0 * x); });
    const Eigen::VectorXd truth =
        at_nodes(nodes, [](double x) { return (1.0 - std::cos(12.0 * x)) / 12.0; });
    return (nodes.integral * values - truth).cwiseAbs().maxCoeff();
  };
  EXPECT_GT(worst(8), 1e-5);
  EXPECT_LT(worst(16), 1e-7);
  EXPECT_LT(worst(24), 1e-14);
}

// Every size takes another way through the blocks of 24, 8 and 4 rows; the plain sum is the truth,
// to the last bit, since no product is fused with a sum.
TEST(Columns, AreThePlainSumsToTheLastBit) {
  for (std::size_t rows = 1; rows <= 70; ++rows) {
    const std::size_t stride = filled_up(rows);
    EXPECT_EQ(stride % kRowsAtOnce, 0U);
    EXPECT_LT(stride - rows, kRowsAtOnce);
    constexpr std::size_t kColumns = 5;
    std::vector<double> matrix(stride * kColumns);
    for (std::size_t i = 0; i < matrix.size(); ++i) {
      matrix[i] = std::sin(static_cast<double>(i * i + rows));
    }
    const std::vector<double> factor = {0.3, -1.7, 1e-9, 42.0, -0.1};
    std::vector<double> out(stride, -1.0);
    sum_columns(matrix.data(), stride, kColumns, factor.data(), out.data());
    std::vector<double> less = matrix;
    subtract_from_columns(less.data(), stride, kColumns, out.data(), factor.data());
    for (std::size_t row = 0; row < stride; ++row) {
      double sum = 0.0;
      for (std::size_t j = 0; j < kColumns; ++j) {
        sum += matrix[j * stride + row] * factor[j];
      }
      EXPECT_EQ(out[row], sum) << rows << ' ' << row;
      for (std::size_t j = 0; j < kColumns; ++j) {
        EXPECT_EQ(less[j * stride + row], matrix[j * stride + row] - out[row] * factor[j]);
      }
    }
  }
}

}  // namespace
}  // namespace steadyrest::chatter::offline
