// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <complex>
#include <numbers>
#include <string>
#include <string_view>
#include <vector>

#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/table/row_reader.hpp>

/// A measured frequency response: displacement over force at the tool's tip.
///
/// CSV: a header `frequency_hz,real_um_N,imag_um_N` or `frequency_hz,magnitude_m_N,phase_deg`, then
/// rows, as read by table::RowReader; `coherence` may follow. The unit is in the header (m/N, mm/N
/// or um/N, written `_um_N`, `(um/N)` or `[µm/N]`) or in a row of units. Accelerance A (m/s2/N,
/// mm/s2/N, g/N) and mobility V (m/s/N, mm/s/N) become displacement by H = A/(iω)² = −A/ω² and H =
/// V/(iω).
namespace steadyrest::chatter::offline {

struct Frf {
  std::vector<double> frequency_hz;  ///< rising, > 0
  std::vector<std::complex<double>> compliance_mm_n;
  std::vector<double> coherence;  ///< 0 … 1, as many; empty: not recorded
  int measured_order = 0;  ///< 0: a displacement was measured, 1: a velocity, 2: an acceleration
  std::string file;        ///< its source
  std::string point;       ///< node and direction of a universal file; empty: not stated
  std::vector<std::string> notes;  ///< what was chosen, converted or skipped in the file
};

/// All responses of a file, universal file format 58 or CSV, recognised by its first line. Refused
/// by line: no file, fewer than kLeastPoints points, an unknown unit, frequencies that do not rise,
/// a value that is not a number.
[[nodiscard]] kernel::outcome::Result<std::vector<Frf>> read_frf(const std::string& path,
                                                                 const table::Format& format = {});
[[nodiscard]] kernel::outcome::Result<Frf> parse_frf_csv(std::string_view text,
                                                         const std::string& file,
                                                         const table::Format& format = {});

inline constexpr std::size_t kLeastPoints = 8;
inline constexpr double kGravity_mm_s2 = 9806.65;

/// The response of the displacement where that of its `order`th derivative was measured.
[[nodiscard]] inline std::complex<double> displacement_of(std::complex<double> measured,
                                                          double frequency_hz, int order) noexcept {
  for (; order > 0; --order) {  // d/dt is a factor iω
    measured /= std::complex<double>(0.0, 2.0 * std::numbers::pi * frequency_hz);
  }
  return measured;
}

/// A usable compliance in mm/N: finite, and so is its square.
[[nodiscard]] inline bool possible(const std::complex<double>& compliance_mm_n) noexcept {
  return std::abs(compliance_mm_n) <= 1e12;
}

}  // namespace steadyrest::chatter::offline
