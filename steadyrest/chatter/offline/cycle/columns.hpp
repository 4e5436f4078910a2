// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

/// Sums over the columns of a matrix, four rows at a time.
///
/// The matrix is stored by columns, `stride` apart, padded to a multiple of four rows. On x86-64
/// with AVX2, detected at run time, four rows take one register; the numbers are the same on every
/// machine, since no product is fused with a sum.
namespace steadyrest::chatter::offline {

constexpr std::size_t kRowsAtOnce = 4;

/// The least multiple of kRowsAtOnce that holds this many rows.
constexpr std::size_t filled_up(std::size_t rows) noexcept {
  return (rows + kRowsAtOnce - 1) / kRowsAtOnce * kRowsAtOnce;
}

/// out = Σ_j factor_j·column_j, `stride` rows.
void sum_columns(const double* matrix, std::size_t stride, std::size_t columns,
                 const double* factor, double* out) noexcept;

/// column_j −= factor_j·what, for each of them.
void subtract_from_columns(double* matrix, std::size_t stride, std::size_t columns,
                           const double* what, const double* factor) noexcept;

}  // namespace steadyrest::chatter::offline
