// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include <steadyrest/chatter/offline/small_inverse.hpp>

namespace steadyrest::chatter::offline {
namespace {

constexpr std::size_t kLanes = 4;
constexpr std::size_t kMostWides = 6;  ///< rows over four that registers hold beside the rest
using Wide = double __attribute__((vector_size(kLanes * sizeof(double))));

[[gnu::always_inline]] inline void load(const double* from, Wide& to) {
  std::memcpy(&to, from, sizeof to);
}
[[gnu::always_inline]] inline void store(const Wide& from, double* to) {
  std::memcpy(to, &from, sizeof from);
}

/// Each of the columns less `column` times its number in `row`; 4·Count rows.
template <std::size_t Count>
[[gnu::always_inline]] inline void eliminate_rows(double* matrix, std::size_t stride,
                                                  std::size_t columns, const double* column,
                                                  const double* factor) {
  std::array<Wide, Count> c{};
  for (std::size_t w = 0; w < Count; ++w) {
    load(column + w * kLanes, c[w]);
  }
  for (std::size_t j = 0; j < columns; ++j) {
    double* const to = matrix + j * stride;
    const double f = factor[j];
    for (std::size_t w = 0; w < Count; ++w) {
      Wide rows;
      load(to + w * kLanes, rows);
      rows -= c[w] * f;
      store(rows, to + w * kLanes);
    }
  }
}

/// out = Σ in_j·column_j.
template <std::size_t Count>
[[gnu::always_inline]] inline void multiply_rows(const double* matrix, std::size_t stride,
                                                 std::size_t columns, const double* in,
                                                 double* out) {
  std::array<Wide, Count> sum{};
  for (std::size_t j = 0; j < columns; ++j) {
    const double* const from = matrix + j * stride;
    const double f = in[j];
    for (std::size_t w = 0; w < Count; ++w) {
      Wide rows;
      load(from + w * kLanes, rows);
      sum[w] += rows * f;
    }
  }
  for (std::size_t w = 0; w < Count; ++w) {
    store(sum[w], out + w * kLanes);
  }
}

/// Rows in blocks that registers hold.
[[gnu::always_inline]] inline void eliminate_lanes(double* matrix, std::size_t stride,
                                                   std::size_t columns, const double* column,
                                                   const double* factor) {
  std::size_t row = 0;
  for (; row + kMostWides * kLanes <= stride; row += kMostWides * kLanes) {
    eliminate_rows<kMostWides>(matrix + row, stride, columns, column + row, factor);
  }
  for (; row + 2 * kLanes <= stride; row += 2 * kLanes) {
    eliminate_rows<2>(matrix + row, stride, columns, column + row, factor);
  }
  if (row < stride) {
    eliminate_rows<1>(matrix + row, stride, columns, column + row, factor);
  }
}

[[gnu::always_inline]] inline void multiply_lanes(const double* matrix, std::size_t stride,
                                                  std::size_t columns, const double* in,
                                                  double* out) {
  std::size_t row = 0;
  for (; row + kMostWides * kLanes <= stride; row += kMostWides * kLanes) {
    multiply_rows<kMostWides>(matrix + row, stride, columns, in, out + row);
  }
  for (; row + 2 * kLanes <= stride; row += 2 * kLanes) {
    multiply_rows<2>(matrix + row, stride, columns, in, out + row);
  }
  if (row < stride) {
    multiply_rows<1>(matrix + row, stride, columns, in, out + row);
  }
}

#if defined(__x86_64__)
__attribute__((target("avx2"))) void eliminate_avx2(double* matrix, std::size_t stride,
                                                    std::size_t columns, const double* column,
                                                    const double* factor) {
  eliminate_lanes(matrix, stride, columns, column, factor);
}
__attribute__((target("avx2"))) void multiply_avx2(const double* matrix, std::size_t stride,
                                                   std::size_t columns, const double* in,
                                                   double* out) {
  multiply_lanes(matrix, stride, columns, in, out);
}
const bool kWide = __builtin_cpu_supports("avx2") != 0;
#endif

void eliminate(double* matrix, std::size_t stride, std::size_t columns, const double* column,
               const double* factor) {
#if defined(__x86_64__)
  if (kWide) {
    eliminate_avx2(matrix, stride, columns, column, factor);
    return;
  }
#endif
  eliminate_lanes(matrix, stride, columns, column, factor);
}

void multiply(const double* matrix, std::size_t stride, std::size_t columns, const double* in,
              double* out) {
#if defined(__x86_64__)
  if (kWide) {
    multiply_avx2(matrix, stride, columns, in, out);
    return;
  }
#endif
  multiply_lanes(matrix, stride, columns, in, out);
}

}  // namespace

void SmallInverse::make(const Eigen::MatrixXd& m, double a) {
  size_ = static_cast<std::size_t>(m.rows());
  stride_ = (size_ + kLanes - 1) / kLanes * kLanes;
  number_.assign(size_ * stride_, 0.0);
  column_.assign(stride_, 0.0);
  pivot_.resize(size_);
  factor_.resize(size_);
  for (std::size_t j = 0; j < size_; ++j) {
    const double* const from = m.data() + j * size_;
    double* const to = &number_[j * stride_];
    for (std::size_t i = 0; i < size_; ++i) {
      to[i] = a * from[i];
    }
    to[j] += 1.0;
  }
  for (std::size_t k = 0; k < size_; ++k) {
    double* const own = &number_[k * stride_];
    std::size_t p = k;
    for (std::size_t i = k + 1; i < size_; ++i) {
      p = std::abs(own[i]) > std::abs(own[p]) ? i : p;
    }
    pivot_[k] = p;
    for (std::size_t j = 0; p != k && j < size_; ++j) {
      std::swap(number_[j * stride_ + k], number_[j * stride_ + p]);
    }
    const double inverse = 1.0 / own[k];
    for (std::size_t j = 0; j < size_; ++j) {
      double& row = number_[j * stride_ + k];
      factor_[j] = row * inverse;
      // What is left of it after the elimination.
      row = 0.0;
    }
    std::copy_n(own, stride_, column_.begin());
    std::fill_n(own, size_, 0.0);
    factor_[k] = inverse;
    eliminate(number_.data(), stride_, size_, column_.data(), factor_.data());
    for (std::size_t j = 0; j < size_; ++j) {
      number_[j * stride_ + k] = factor_[j];
    }
  }
  for (std::size_t k = size_; k-- > 0;) {
    if (pivot_[k] != k) {
      std::swap_ranges(&number_[k * stride_], &number_[k * stride_] + size_,
                       &number_[pivot_[k] * stride_]);
    }
  }
}

void SmallInverse::apply(std::span<const double> in, std::span<double> out) const {
  constexpr std::size_t kMost = 128;
  std::array<double, kMost> sum;  // NOLINT(cppcoreguidelines-pro-type-member-init): filled below
  if (stride_ > kMost) {
    std::vector<double> large(stride_);
    multiply(number_.data(), stride_, size_, in.data(), large.data());
    std::copy_n(large.begin(), size_, out.begin());
    return;
  }
  multiply(number_.data(), stride_, size_, in.data(), sum.data());
  std::copy_n(sum.begin(), size_, out.begin());
}

}  // namespace steadyrest::chatter::offline
