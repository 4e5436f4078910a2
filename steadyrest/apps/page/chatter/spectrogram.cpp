// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include <unsupported/Eigen/FFT>

#include <steadyrest/apps/page/chatter/spectrogram.hpp>

// Power over time and frequency, thinned for a picture by maxima, never by means: a short burst of
// chatter must not vanish between two pixels.
namespace steadyrest::apps::page {
namespace {

constexpr double kFloor_db = -120.0;
constexpr std::size_t kClose = 8;  ///< windows are at least this share of their length apart

/// Hann: its side lobes fall fast, so a strong tooth line does not cover chatter beside it.
std::vector<double> hann(std::size_t n) {
  std::vector<double> out(n);
  for (std::size_t i = 0; i < n; ++i) {
    out[i] = 0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * static_cast<double>(i) /
                                  static_cast<double>(n));
  }
  return out;
}

std::size_t rounded_up(std::size_t a, std::size_t b) {
  return (a + b - 1) / b;
}

/// Windows begin `hop` apart: close together in a short signal, for a smooth picture; half a window
/// apart in a long one, so that nothing is lost between them.
std::size_t hop_of(std::size_t samples, const SpectrogramConfig& config) {
  const std::size_t even = (samples - config.window) / config.columns + 1;
  return std::clamp(even, std::max<std::size_t>(config.window / kClose, 1), config.window / 2);
}

/// dB under the strongest cell; whole decibels make the page a third of the size.
std::vector<int> in_db(const std::vector<double>& power) {
  const double most = std::ranges::max(power);
  std::vector<int> out;
  out.reserve(power.size());
  for (const double p : power) {
    const double db = p > 0.0 ? 10.0 * std::log10(p / most) : kFloor_db;
    out.push_back(static_cast<int>(std::lround(std::max(db, kFloor_db))));
  }
  return out;
}

}  // namespace

Spectrogram spectrogram(const std::vector<double>& signal, const SpectrogramConfig& config) {
  const std::size_t n = config.window;
  const std::size_t hop = hop_of(signal.size(), config);
  const std::size_t windows = (signal.size() - n) / hop + 1;
  const double bin_hz = config.rate_hz / static_cast<double>(n);
  const std::size_t bins =
      std::min(n / 2, static_cast<std::size_t>(std::ceil(config.most_hz / bin_hz)) + 1);
  const std::size_t together = rounded_up(windows, config.columns);
  const std::size_t bins_in_row = rounded_up(bins, config.rows);
  Spectrogram out;
  out.columns = rounded_up(windows, together);
  out.rows = rounded_up(bins, bins_in_row);
  out.column_s = static_cast<double>(together * hop) / config.rate_hz;
  out.row_hz = bin_hz * static_cast<double>(bins_in_row);
  // The centre of the first window is the centre of the first hop.
  out.start_s = config.start_s + 0.5 * static_cast<double>(n - hop) / config.rate_hz;
  const std::vector<double> window = hann(n);
  std::vector<double> power(out.columns * out.rows, 0.0);
  std::vector<double> piece(n);
  std::vector<std::complex<double>> spectrum;
  Eigen::FFT<double> fft;
  for (std::size_t w = 0; w < windows; ++w) {
    // One missing sample and the whole spectrum is unknown: nothing is shown there.
    bool whole = true;
    for (std::size_t i = 0; i < n; ++i) {
      piece[i] = signal[w * hop + i] * window[i];
      whole = whole && std::isfinite(piece[i]);
    }
    if (!whole) {
      continue;
    }
    fft.fwd(spectrum, piece);
    for (std::size_t bin = 0; bin < bins; ++bin) {
      double& cell = power[w / together * out.rows + bin / bins_in_row];
      cell = std::max(cell, std::norm(spectrum[bin]));
    }
  }
  out.level_db = in_db(power);
  return out;
}

}  // namespace steadyrest::apps::page
