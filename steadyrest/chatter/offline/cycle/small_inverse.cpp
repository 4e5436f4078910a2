// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include <steadyrest/chatter/offline/cycle/columns.hpp>
#include <steadyrest/chatter/offline/cycle/small_inverse.hpp>

namespace steadyrest::chatter::offline {
void SmallInverse::make(const Eigen::MatrixXd& m, double a) {
  size_ = static_cast<std::size_t>(m.rows());
  stride_ = filled_up(size_);
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
  // Gauss–Jordan, step k: divide the row by its pivot and eliminate it from all other rows. Column
  // k is then a unit vector and need not be stored; column k of the inverse takes its place.
  for (std::size_t k = 0; k < size_; ++k) {
    double* const own = &number_[k * stride_];
    std::size_t p = k;
    for (std::size_t i = k + 1; i < size_; ++i) {
      // Without pivots I + a·M loses digits where a·M is of the order of −1.
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
      // What remains of it after the elimination.
      row = 0.0;
    }
    std::copy_n(own, stride_, column_.begin());
    std::fill_n(own, size_, 0.0);
    factor_[k] = inverse;
    subtract_from_columns(number_.data(), stride_, size_, column_.data(), factor_.data());
    for (std::size_t j = 0; j < size_; ++j) {
      number_[j * stride_ + k] = factor_[j];
    }
  }
  for (std::size_t k = size_; k-- > 0;) {
    if (pivot_[k] != k) {
      // Rows were swapped on the way; of the inverse these are the columns, in the opposite order.
      std::swap_ranges(&number_[k * stride_], &number_[k * stride_] + size_,
                       &number_[pivot_[k] * stride_]);
    }
  }
}

void SmallInverse::apply(std::span<const double> in, std::span<double> out) const {
  // Once per piece and pass: the heap would cost more than the sum.
  constexpr std::size_t kMost = 128;
  std::array<double, kMost> sum;  // NOLINT(cppcoreguidelines-pro-type-member-init): filled below
  if (stride_ > kMost) {
    std::vector<double> large(stride_);
    sum_columns(number_.data(), stride_, size_, in.data(), large.data());
    std::copy_n(large.begin(), size_, out.begin());
    return;
  }
  sum_columns(number_.data(), stride_, size_, in.data(), sum.data());
  std::copy_n(sum.begin(), size_, out.begin());
}

void SmallInverse::apply_transposed(std::span<const double> in, std::span<double> out) const {
  using Column = Eigen::Map<const Eigen::VectorXd>;
  const auto rows = static_cast<Eigen::Index>(size_);
  const Column given(in.data(), rows);
  for (std::size_t j = 0; j < size_; ++j) {
    out[j] = Column(&number_[j * stride_], rows).dot(given);
  }
}

}  // namespace steadyrest::chatter::offline
