// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <complex>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include <unsupported/Eigen/FFT>

namespace steadyrest::apps::live_page {

/// The amplitude spectrum of a signal that comes in pieces, averaged over about a second.
///
/// Hann windows of about 0.2 s, half overlapping; the powers of the windows are averaged with a
/// memory of four windows. A sine of amplitude a has a peak of a (1.4 dB less between two lines).
class VibrationSpectrum {
 public:
  /// Appends evenly spaced readings. A changed rate discards the earlier ones; a rate of 0 or less
  /// discards all.
  void add(std::span<const double> readings, double rate_hz);
  /// A window has been added since the last call.
  [[nodiscard]] bool fresh() noexcept { return std::exchange(fresh_, false); }
  [[nodiscard]] double rate_hz() const noexcept { return rate_hz_; }

  struct Lines {
    std::vector<double> hz;
    std::vector<double> amplitude;  ///< in the signal's unit
  };
  /// From 0 to `most_hz`, in at most `most` lines. Where lines are merged, the largest is kept.
  [[nodiscard]] Lines lines(double most_hz, std::size_t most) const;

  struct Bands {
    double band_hz = 0.0;       ///< width of each; the first begins half a line below 0
    std::vector<int> level_db;  ///< of a sine of amplitude 1
  };
  /// The loudest line in each band, of the windows since the last call and not their average: a
  /// burst shows. From 0 to `most_hz`, in at most `most` bands; a band without any vibration has
  /// kSilence_db. Empty without a new window.
  [[nodiscard]] Bands take_bands(double most_hz, std::size_t most);
  static constexpr int kSilence_db = -240;

 private:
  /// Neighbouring lines that are shown as one.
  struct Merged {
    std::size_t lines = 0;  ///< in all
    std::size_t together = 1;
  };
  [[nodiscard]] double line_hz() const noexcept;
  [[nodiscard]] Merged merged(double most_hz, std::size_t most) const noexcept;
  void begin(double rate_hz);
  void transform();

  double rate_hz_ = 0.0;
  bool fresh_ = false;
  std::vector<double> waiting_;  ///< not yet in a window, and the last half window
  std::vector<double> window_;
  std::vector<double> windowed_;
  std::vector<double> power_;
  std::vector<double> loudest_;  ///< power, since take_bands(); empty: no window
  std::vector<std::complex<double>> lines_;
  Eigen::FFT<double> fft_;
};

}  // namespace steadyrest::apps::live_page
