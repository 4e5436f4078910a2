// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <complex>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <steadyrest/kernel/outcome/result.hpp>

namespace steadyrest::chatter::online {

/// Lines that stand out from a signal's noise, from a spectrum computed a few steps per sample.
///
/// Law: Hann window over the last n samples, n the power of 2 next to window_s·fs, every n/8. Noise
/// level m of a bin: the mean, recomputed four times without the bins above 3·m. A bin above 10·m
/// is part of a line. The strongest bin's frequency is interpolated by f = (k + δ)·fs/n,
/// δ = (2r − 1)/(r + 1), r the amplitude ratio of the stronger neighbour to the peak (Grandke
/// 1983).
///
/// Accuracy: two lines are told apart from 4·fs/n on (39 Hz at 10 kHz); a single line's frequency
/// is within 0.02·fs/n without noise. The answer is up to n/8 + 12·log2(n) samples old, the
/// window's middle n/2 more. No sample costs more than kQuota butterflies or kCopy bins.
class LineSpectrum {
 public:
  struct Config {
    double sample_rate_hz = 10e3;  ///< 1e3 … 50e3
    double window_s = 0.1;         ///< 0.02 … 1
    double lowest_hz = 40.0;       ///< lines below are ignored; 0 … fs/4
  };

  /// Energies in unit² (a line of amplitude a has a²/2).
  struct Output {
    bool fresh = false;          ///< this sample completed a spectrum
    double frequency_hz = 0.0;   ///< of the strongest line; 0 = none yet
    double line_energy = 0.0;    ///< all lines together
    double noise_energy = 0.0;   ///< the rest, over the whole band
    double peak_ratio = 0.0;     ///< strongest bin over the noise of a bin
    double advance_turns = 0.0;  ///< of the strongest bin's phase since the spectrum before, −½ … ½
    double advance_s = 0.0;      ///< since then; 0: there was none
  };

  [[nodiscard]] static kernel::outcome::Result<LineSpectrum> make(const Config& config);

  /// Lines within `guard_hz` of a multiple of `spacing_hz` are ignored; 0 = none are.
  const Output& update(double value, double spacing_hz, double guard_hz) noexcept;
  void reset() noexcept;

  [[nodiscard]] double resolution_hz() const noexcept { return bin_hz_; }
  [[nodiscard]] std::size_t length() const noexcept { return n_; }

 private:
  enum class Step : std::uint8_t { idle, copy, transform, power, noise, lines };
  static constexpr std::size_t kQuota = 256;
  static constexpr std::size_t kCopy = 512;
  static constexpr int kNoisePasses = 4;

  LineSpectrum(const Config& config, std::size_t n);
  void work(double spacing_hz, double guard_hz) noexcept;
  void copy() noexcept;
  void transform() noexcept;
  void power(double spacing_hz, double guard_hz) noexcept;
  void noise() noexcept;
  void lines() noexcept;
  void finish() noexcept;

  Config config_;
  std::size_t n_;
  double bin_hz_;
  std::size_t first_bin_;
  std::vector<double> ring_;  ///< 2n, so that copying is not overtaken by new samples
  std::vector<double> window_;
  std::vector<std::uint32_t> reversed_;
  std::vector<std::complex<double>> twiddle_;
  std::vector<std::complex<double>> bins_;
  std::vector<std::complex<double>> before_;  ///< of the spectrum before
  std::size_t passed_ = 0;                    ///< samples since that; 0: there was none
  bool known_ = false;                        ///< a spectrum was finished
  std::vector<double> power_;                 ///< of each bin; negative = ignored
  std::size_t head_ = 0;
  std::size_t seen_ = 0;
  std::size_t since_ = 0;
  Step step_ = Step::idle;
  std::size_t at_ = 0;
  std::size_t start_ = 0;
  std::size_t half_ = 1;
  int pass_ = 0;
  bool falls_ = false, rises_ = false, ignored_ = false;  ///< as the bins go up
  std::size_t peak_below_ = 0;                            ///< before they began to rise
  double before_bin_ = 0.0;
  double level_ = 0.0, sum_ = 0.0;
  std::size_t count_ = 0, looked_at_ = 0, peak_ = 0;
  Output out_;
};

}  // namespace steadyrest::chatter::online
