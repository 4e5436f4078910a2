// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

/// Power of a signal over time and frequency, in a picture's resolution.
namespace steadyrest::apps::page {

/// Hann windows, half of their length apart or, in a short signal, as close as an eighth; where
/// several windows or bins share a cell, the strongest counts.
struct Spectrogram {
  double start_s = 0.0;   ///< lower edge of the first column
  double column_s = 0.0;  ///< width of one
  double row_hz = 0.0;    ///< height of a row; the first begins half a bin below 0
  std::size_t columns = 0;
  std::size_t rows = 0;
  /// [column·rows + row], dB below the strongest cell (a line of amplitude a counts a²/2), −120 at
  /// least.
  std::vector<int> level_db;
};

struct SpectrogramConfig {
  double rate_hz = 0.0;       ///< > 0
  double start_s = 0.0;       ///< of the first sample
  std::size_t window = 0;     ///< samples in a window, ≥ 16, at most as many as there are
  double most_hz = 0.0;       ///< upper end, at most half the rate
  std::size_t columns = 480;  ///< at most
  std::size_t rows = 320;     ///< at most
};

[[nodiscard]] Spectrogram spectrogram(const std::vector<double>& signal,
                                      const SpectrogramConfig& config);

}  // namespace steadyrest::apps::page
