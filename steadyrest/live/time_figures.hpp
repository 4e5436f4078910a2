// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace steadyrest::live {

/// Times of cycles, counted in bins of 1/16 octave from 0.1 µs to about 13 s: any number of them in
/// bounded memory, without allocation.
class TimeFigures {
 public:
  /// Shorter times count as the shortest bin, longer ones and what is not finite as the longest.
  void add(double time_s) noexcept;

  [[nodiscard]] std::uint64_t count() const noexcept { return count_; }
  [[nodiscard]] double largest_s() const noexcept { return largest_s_; }
  /// The upper end of the bin that holds this share of the times: at most 4.5 % above the true
  /// quantile, and never above the largest. 0 without times.
  [[nodiscard]] double quantile_s(double share) const noexcept;

 private:
  static constexpr std::size_t kBins = std::size_t{16} * 27;
  std::array<std::uint64_t, kBins> bins_{};
  std::uint64_t count_ = 0;
  double largest_s_ = 0.0;
};

}  // namespace steadyrest::live
