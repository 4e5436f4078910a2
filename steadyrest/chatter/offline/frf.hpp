// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <complex>
#include <string>
#include <string_view>
#include <vector>

#include <steadyrest/kernel/outcome/result.hpp>

/// A measured frequency response: displacement over force at the tool's tip.
///
/// CSV: a head `frequency_hz,real_um_N,imag_um_N` or `frequency_hz,magnitude_m_N,phase_deg`, then
/// rows; the unit stands in the head (m/N, mm/N or um/N, written `_um_N`, `(um/N)` or `[µm/N]`).
/// Separated by commas, semicolons or tabs; lines that begin with # and empty ones are passed
/// over.
namespace steadyrest::chatter::offline {

struct Frf {
  std::vector<double> frequency_hz;  ///< rising, > 0
  std::vector<std::complex<double>> compliance_mm_n;
};

/// All responses of a file, universal file format 58 or CSV, told apart by its first line.
/// Refused: no file, fewer than kLeastPoints points, an unknown unit, frequencies that do not rise,
/// what is no number; each by its line.
[[nodiscard]] kernel::outcome::Result<std::vector<Frf>> read_frf(const std::string& path);
[[nodiscard]] kernel::outcome::Result<Frf> parse_frf_csv(std::string_view text,
                                                         const std::string& file);

inline constexpr std::size_t kLeastPoints = 8;

/// A compliance in mm/N that can be worked with: finite, and so is its square.
[[nodiscard]] inline bool possible(const std::complex<double>& compliance_mm_n) noexcept {
  return std::abs(compliance_mm_n) <= 1e12;
}

}  // namespace steadyrest::chatter::offline
