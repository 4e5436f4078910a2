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
/// Lines above 0.45·fs are not looked for.
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

  /// Where lines are that are not looked for, Hz.
  struct Orders {
    double spacing_hz = 0.0;  ///< lines within `guard_hz` of a multiple are ignored
    double guard_hz = 0.0;    ///< 0: none are
    double spindle_hz = 0.0;  ///< Output::beside is off its multiples; 0: there is none
  };
  /// Energies in unit² (a line of amplitude a has a²/2).
  struct Line {
    double frequency_hz = 0.0;   ///< 0: there is none
    double peak_ratio = 0.0;     ///< strongest bin over the noise of a bin
    double advance_turns = 0.0;  ///< of that bin's phase since the spectrum before, −½ … ½
    double energy = 0.0;         ///< of the strongest bin and its two neighbours
  };
  struct Output {
    bool fresh = false;  ///< this sample completed a spectrum
    Line strongest;
    Line beside;                ///< the strongest off the spindle's orders, by 1.5 bins at least
    Line guarded;               ///< the strongest of those that are ignored
    double line_energy = 0.0;   ///< all lines together that are not ignored
    double noise_energy = 0.0;  ///< the rest, over the whole band
    double advance_s = 0.0;     ///< since the spectrum before; 0: there was none
  };

  [[nodiscard]] static kernel::outcome::Result<LineSpectrum> make(const Config& config);

  const Output& update(double value, const Orders& orders) noexcept;
  void reset() noexcept;

  [[nodiscard]] double resolution_hz() const noexcept { return bin_hz_; }
  [[nodiscard]] std::size_t length() const noexcept { return n_; }

 private:
  enum class Step : std::uint8_t { idle, copy, transform, power, noise, lines };
  static constexpr std::size_t kQuota = 256;
  static constexpr std::size_t kCopy = 512;
  static constexpr int kNoisePasses = 4;

  LineSpectrum(const Config& config, std::size_t n);
  void work(const Orders& orders) noexcept;
  void copy() noexcept;
  void transform() noexcept;
  void power(const Orders& orders) noexcept;
  void noise() noexcept;
  void lines() noexcept;
  void finish() noexcept;
  [[nodiscard]] Line line_at(std::size_t peak) const noexcept;

  Config config_;
  std::size_t n_;
  double bin_hz_;
  std::size_t first_bin_;
  std::size_t end_bin_;
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
  std::size_t beside_ = 0, guarded_ = 0;  ///< 0: none
  Output out_;
};

}  // namespace steadyrest::chatter::online
