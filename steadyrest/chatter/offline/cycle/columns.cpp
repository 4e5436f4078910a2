// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstring>

#include <steadyrest/chatter/offline/cycle/columns.hpp>

// Matrices of some tens of rows spend more time in a library's dispatch than in its arithmetic.
// These loops keep the accumulators in registers and run along whole columns. Four lanes
// everywhere, with or without AVX2, and no fused multiply-add: sums come out equal to the last bit
// on every machine.
namespace steadyrest::chatter::offline {
namespace {

// AVX2 has 16 registers: six for the column, six in flight, the rest for factors.
constexpr std::size_t kMostWides = 6;  ///< rows over four that registers hold with everything else
using Wide = double __attribute__((vector_size(kRowsAtOnce * sizeof(double))));

// always_inline: the bodies must be compiled inside the function with the AVX2 target; separately
// they would be built for the baseline.
[[gnu::always_inline]] inline void load(const double* from, Wide& to) {
  std::memcpy(&to, from, sizeof to);
}
[[gnu::always_inline]] inline void store(const Wide& from, double* to) {
  std::memcpy(to, &from, sizeof from);
}

/// Subtracts from each column `column` times its number in `row`; 4·Count rows.
template <std::size_t Count>
[[gnu::always_inline]] inline void subtract_rows(double* matrix, std::size_t stride,
                                                 std::size_t columns, const double* what,
                                                 const double* factor) {
  std::array<Wide, Count> c{};
  for (std::size_t w = 0; w < Count; ++w) {
    load(what + w * kRowsAtOnce, c[w]);
  }
  for (std::size_t j = 0; j < columns; ++j) {
    double* const to = matrix + j * stride;
    const double f = factor[j];
    for (std::size_t w = 0; w < Count; ++w) {
      Wide rows;
      load(to + w * kRowsAtOnce, rows);
      rows -= c[w] * f;
      store(rows, to + w * kRowsAtOnce);
    }
  }
}

/// out = Σ in_j·column_j.
template <std::size_t Count>
[[gnu::always_inline]] inline void sum_rows(const double* matrix, std::size_t stride,
                                            std::size_t columns, const double* in, double* out) {
  std::array<Wide, Count> sum{};
  for (std::size_t j = 0; j < columns; ++j) {
    const double* const from = matrix + j * stride;
    const double f = in[j];
    for (std::size_t w = 0; w < Count; ++w) {
      Wide rows;
      load(from + w * kRowsAtOnce, rows);
      sum[w] += rows * f;
    }
  }
  for (std::size_t w = 0; w < Count; ++w) {
    store(sum[w], out + w * kRowsAtOnce);
  }
}

/// Rows in blocks that fit the registers.
[[gnu::always_inline]] inline void subtract_lanes(double* matrix, std::size_t stride,
                                                  std::size_t columns, const double* what,
                                                  const double* factor) {
  std::size_t row = 0;
  for (; row + kMostWides * kRowsAtOnce <= stride; row += kMostWides * kRowsAtOnce) {
    subtract_rows<kMostWides>(matrix + row, stride, columns, what + row, factor);
  }
  // The remainder of the division by six: pairs, then at most one single.
  for (; row + 2 * kRowsAtOnce <= stride; row += 2 * kRowsAtOnce) {
    subtract_rows<2>(matrix + row, stride, columns, what + row, factor);
  }
  if (row < stride) {
    subtract_rows<1>(matrix + row, stride, columns, what + row, factor);
  }
}

[[gnu::always_inline]] inline void sum_lanes(const double* matrix, std::size_t stride,
                                             std::size_t columns, const double* in, double* out) {
  std::size_t row = 0;
  for (; row + kMostWides * kRowsAtOnce <= stride; row += kMostWides * kRowsAtOnce) {
    sum_rows<kMostWides>(matrix + row, stride, columns, in, out + row);
  }
  for (; row + 2 * kRowsAtOnce <= stride; row += 2 * kRowsAtOnce) {
    sum_rows<2>(matrix + row, stride, columns, in, out + row);
  }
  if (row < stride) {
    sum_rows<1>(matrix + row, stride, columns, in, out + row);
  }
}

#if defined(__x86_64__)
__attribute__((target("avx2"))) void subtract_avx2(double* matrix, std::size_t stride,
                                                   std::size_t columns, const double* what,
                                                   const double* factor) {
  subtract_lanes(matrix, stride, columns, what, factor);
}
__attribute__((target("avx2"))) void sum_avx2(const double* matrix, std::size_t stride,
                                              std::size_t columns, const double* in, double* out) {
  sum_lanes(matrix, stride, columns, in, out);
}
const bool kAvx2 = __builtin_cpu_supports("avx2") != 0;
#endif

}  // namespace

void subtract_from_columns(double* matrix, std::size_t stride, std::size_t columns,
                           const double* what, const double* factor) noexcept {
#if defined(__x86_64__)
  if (kAvx2) {
    subtract_avx2(matrix, stride, columns, what, factor);
    return;
  }
#endif
  subtract_lanes(matrix, stride, columns, what, factor);
}

void sum_columns(const double* matrix, std::size_t stride, std::size_t columns,
                 const double* factor, double* out) noexcept {
#if defined(__x86_64__)
  if (kAvx2) {
    sum_avx2(matrix, stride, columns, factor, out);
    return;
  }
#endif
  sum_lanes(matrix, stride, columns, factor, out);
}

}  // namespace steadyrest::chatter::offline
