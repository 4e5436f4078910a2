// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <steadyrest/sim/axis/matrix_exponential.hpp>

namespace steadyrest::sim {
namespace {

Matrix2 product(const Matrix2& a, const Matrix2& b) noexcept {
  return {.xx = a.xx * b.xx + a.xv * b.vx,
          .xv = a.xx * b.xv + a.xv * b.vv,
          .vx = a.vx * b.xx + a.vv * b.vx,
          .vv = a.vx * b.xv + a.vv * b.vv};
}

}  // namespace

Matrix2 exponential(Matrix2 a) noexcept {
  int squarings = 0;
  while (std::abs(a.xx) + std::abs(a.xv) + std::abs(a.vx) + std::abs(a.vv) > 0.25 &&
         squarings < 60) {
    a = {.xx = a.xx / 2, .xv = a.xv / 2, .vx = a.vx / 2, .vv = a.vv / 2};
    ++squarings;
  }
  Matrix2 sum{.xx = 1, .xv = 0, .vx = 0, .vv = 1};
  Matrix2 term = sum;
  for (int i = 1; i <= 12; ++i) {
    term = product(term, a);
    term = {.xx = term.xx / i, .xv = term.xv / i, .vx = term.vx / i, .vv = term.vv / i};
    sum = {.xx = sum.xx + term.xx,
           .xv = sum.xv + term.xv,
           .vx = sum.vx + term.vx,
           .vv = sum.vv + term.vv};
  }
  for (; squarings > 0; --squarings) {
    sum = product(sum, sum);
  }
  return sum;
}

}  // namespace steadyrest::sim
