// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

/// (I + a·M)⁻¹ for matrices of some tens of rows, and its products with vectors.
///
/// Gauss–Jordan elimination in place with row pivots: n³ multiplications along whole columns, four
/// numbers at a time. At this size that is several times faster than a library's method for large
/// matrices. The result is the same on every machine: no product is fused with a sum.
namespace steadyrest::chatter::offline {

class SmallInverse {
 public:
  /// Of a square M; I + a·M must not be singular.
  void make(const Eigen::MatrixXd& m, double a);

  /// out = (I + a·M)⁻¹·in; both of the matrix's size, apart from each other.
  void apply(std::span<const double> in, std::span<double> out) const;
  /// The same with the transposed inverse.
  void apply_transposed(std::span<const double> in, std::span<double> out) const;

 private:
  std::size_t size_ = 0;
  std::size_t stride_ = 0;      ///< of the columns, a multiple of four
  std::vector<double> number_;  ///< by columns, padded with zeros
  std::vector<double> column_;  ///< scratch for make()
  std::vector<double> factor_;
  std::vector<std::size_t> pivot_;
};

}  // namespace steadyrest::chatter::offline
