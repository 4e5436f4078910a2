// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <steadyrest/kernel/outcome/result.hpp>

namespace steadyrest::chatter::online {

/// How much of a line is free: explained neither by the spindle's orders nor by a damped mode that
/// responds to them. A tooth order that sweeps over a resonance, and the ringing after it or after
/// the tool's entry, leave lines that no order explains but a mode does; neither explains chatter.
///
/// Law. z is the signal shifted by the line's frequency f and low-passed (Hann, 4 blocks of fs/625
/// samples, one value a block), u_k the same of e^{ikθ}, θ the spindle's angle, k the orders within
/// kBand of f. Over the last 64 blocks (0.1 s), n the block:
///   rate:   z[n+1] = a·z[n] + Σ b_k·u_k[n] + c_k·u_k[n+1], k the tooth orders, by least squares
///           with z[n−4] as the instrument, so that noise does not damp a;
///   mode:   λ = a, brought to at least kLeastDecay, r_k[n] = λ·r_k[n−1] + (u_k[n−1] + u_k[n])/2;
///   free:   the residual of z outside the space of λⁿ, r_k, u_k (Gram–Schmidt).
/// In a stable cut with one mode near f only noise is left, whatever the speed law.
///
/// Computed over some 80 samples, kQuota samples of the window or one order per sample. At most
/// kMostOrders orders, those nearest to f: below some 10 rev/s not all within the band.
/// Source: forced and free part of a linear system; instruments as in Young 1970.
class FreeShare {
 public:
  static constexpr double kBand = 300.0;       ///< Hz
  static constexpr double kLeastDecay = 30.0;  ///< 1/s
  static constexpr std::size_t kMostOrders = 16;

  struct Config {
    double sample_rate_hz = 10e3;  ///< 1e3 … 50e3
    std::size_t teeth = 2;         ///< 1 … 64
  };

  /// Energies in unit² (a line of amplitude a has a²/2), within about ±150 Hz of f.
  struct Output {
    bool fresh = false;        ///< this sample completed an answer
    bool known = false;        ///< the window was long enough
    double energy = 0.0;       ///< all
    double off_teeth = 0.0;    ///< free of the tooth orders and their modes
    double off_spindle = 0.0;  ///< free of all spindle orders and their modes
    double noise_share = 0.0;  ///< of white noise's energy that is within the band
    double growth_1_s = 0.0;   ///< of the free part, ln|a| per second
  };

  [[nodiscard]] static kernel::outcome::Result<FreeShare> make(const Config& config);

  /// One sample; the angle is any finite number.
  const Output& update(double value, double angle_rev) noexcept;
  /// Queries the line at `frequency_hz` in the signal so far, at most the last `samples`. Ignored
  /// while the previous query is in progress.
  void ask(double frequency_hz, double speed_rev_s, std::size_t samples) noexcept;
  [[nodiscard]] bool busy() const noexcept { return step_ != Step::idle; }
  void reset() noexcept;

 private:
  static constexpr std::size_t kBlocks = 64;
  static constexpr std::size_t kRows = kBlocks - 3;
  static constexpr std::size_t kColumns = 2 * kMostOrders + 1;
  static constexpr std::size_t kLag = 4;
  static constexpr std::size_t kPoles = 3;
  static constexpr std::size_t kQuota = 24;
  using Column = std::array<std::complex<double>, kRows>;
  enum class Step : std::uint8_t { idle, shift, rate, mode };

  struct Span {
    std::size_t first = 0, last = kRows;  ///< rows
    [[nodiscard]] std::size_t size() const noexcept { return last - first; }
  };

  FreeShare(const Config& config, std::size_t block);
  void shift() noexcept;
  void rate() noexcept;
  void solve_rate() noexcept;
  void start_mode() noexcept;
  void mode() noexcept;
  void finish() noexcept;
  void choose_orders(double speed_rev_s) noexcept;
  void add(const Column& column, Span span) noexcept;
  void off(Column& column, Span span) const noexcept;
  [[nodiscard]] bool is_tooth(std::size_t at) const noexcept;

  Config config_;
  std::size_t block_;                  ///< samples
  std::vector<double> taps_;           ///< 4·block
  std::vector<double> value_, angle_;  ///< rings of 2·kBlocks·block
  std::size_t head_ = 0;
  std::size_t seen_ = 0;

  Step step_ = Step::idle;
  double frequency_hz_ = 0.0;
  std::size_t start_ = 0, at_ = 0;
  std::size_t first_row_ = 0;
  std::size_t first_order_ = 1, stride_ = 1, orders_ = 0;
  std::complex<double> turn_, turned_;
  std::array<std::complex<double>, kPoles> poles_{};
  std::size_t pole_ = 0, best_now_ = 0;
  double best_size_ = 0.9, best_hz_ = 0.0;  ///< of the previous query
  Column z_{};
  std::array<Column, kMostOrders> u_{};
  std::array<Column, kColumns> basis_{};
  std::size_t columns_ = 0;
  double off_teeth_ = 0.0;
  Output out_;
};

}  // namespace steadyrest::chatter::online
