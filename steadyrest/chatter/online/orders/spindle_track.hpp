// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <complex>
#include <cstddef>
#include <span>
#include <vector>

#include <steadyrest/chatter/online/orders/order_filter.hpp>

namespace steadyrest::chatter::online {

/// The spindle's real speed, from the phases of the orders in the signal.
///
/// Law. The told speed is wrong by a factor 1 + ε, |ε| ≤ kMost. Over a block of B whole
/// revolutions, as integrated, order k has the phasor Yₖ; from block to block it turns by
/// aₖ = 2π·k·B·ε. Every order that is well above the noise and is not folded votes,
///   ε̂ = Σ wₖ·k·aₖ / (2π·B·Σ wₖ·k²),  wₖ = h/vₖ,  vₖ = 1/SNRₖ + what the order has strayed by
///   lately,
/// from the lowest up, each unwrapped by what those below it say, as far as that leaves its turn
/// known, and left out where it strays from them by three standard deviations: the lines of chatter
/// beside the tooth orders turn them all by one angle. Three orders at least must vote, and twice
/// as many as are left out. The noise
/// is the residual; from kSettledRev revolutions after the tool's entry on, what the tooth orders
/// leave of it over a block (at a wrong speed they are nearly all of it). h is Huber's weight about
/// the median of aₖ/k that k/√vₖ weights. A Kalman filter with one state follows: ε is a random
/// walk of kWalk·√t, faster while it keeps moving (a spindle that droops as it enters); beyond
/// three standard deviations three blocks in a row are believed. What it finds turns the angle that
/// the orders refer to, so later blocks see what is left. For kRingsRev revolutions after an entry
/// nothing is believed; where no order shows ε, in air or behind other vibration, the uncertainty
/// grows to kInAir, or to twice `told_sd` where that is less.
class SpindleTrack {
 public:
  static constexpr double kMost = 0.025;

  /// `told_sd`: relative standard deviation of the told speed; 0: it is exact and stays as it is.
  explicit SpindleTrack(double told_sd, std::size_t orders);

  struct Residual {
    double energy = 0.0;   ///< of the filter's residual, mean over a revolution
    double cut_rev = 0.0;  ///< revolutions since the cut began
    bool gap = false;      ///< this sample: the filter has learnt nothing
    bool loud = false;     ///< lines that may be orders at a wrong speed
  };

  /// To be called with each sample, after the filter has used it. `angle_rev`: as integrated with
  /// ratio().
  void update(OrderFilter& filter, double angle_rev, double speed_rev_s, double rate_hz,
              const Residual& residual) noexcept;
  void reset() noexcept;

  /// 1 + ε̂
  [[nodiscard]] double ratio() const noexcept { return 1.0 + off_; }
  /// Its standard deviation.
  [[nodiscard]] double sd() const noexcept;

 private:
  using Complex = std::complex<double>;
  struct Fit {
    double off = 0.0;
    double variance = 0.0;
    bool known = false;
  };
  void follow(const Fit& found, double seconds, bool loud) noexcept;
  void begin_block(OrderFilter& filter, double angle_rev, double speed_rev_s,
                   double rate_hz) noexcept;
  struct Turned {
    std::size_t at = 0;
    double order = 0.0;
    double turned = 0.0;  ///< rad
    double sd = 0.0;
  };
  void gather(std::span<const OrderFilter::Order> orders, double noise_energy) noexcept;
  [[nodiscard]] double median() noexcept;
  [[nodiscard]] Fit fit(std::span<const OrderFilter::Order> orders, double noise_energy) noexcept;

  double told_sd_;
  std::vector<Complex> at_begin_;  ///< the filter's phasors as the block began
  std::vector<Complex> before_;    ///< Yₖ of the block before
  std::vector<Complex> now_;
  std::vector<Turned> turned_;
  std::size_t left_out_ = 0;     ///< strayed too far to be among them
  std::vector<double> strange_;  ///< of each order: mean square by which it strays from the others
  double off_ = 0.0;
  double variance_;
  double restless_ = 1.0;  ///< mean of innovation²/its variance
  unsigned strays_ = 0;    ///< blocks in a row that found another speed
  double behind_ = 0.0;    ///< what the blocks find again and again: the estimate lags
  double begin_rev_ = 0.0;
  double block_rev_ = 1.0;
  std::size_t samples_ = 0;
  std::size_t missing_ = 0;  ///< of those
  bool started_ = false;
  bool comparable_ = false;  ///< the block before was as long as this one
};

}  // namespace steadyrest::chatter::online
