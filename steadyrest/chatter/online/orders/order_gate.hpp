// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

#include <steadyrest/chatter/online/orders/order_filter.hpp>

namespace steadyrest::chatter::online {

/// Whether a line of the spectrum can be an order of the spindle, or the fold of one about the
/// sampling rate: vibration there is forced by definition.
///
/// Law. A line is followed from spectrum to spectrum by the phase of its strongest bin: over T
/// seconds it turns by φ turns, order k by k·∫Ω dt, Ω the spindle's speed with the relative
/// standard deviation σ. Order k is excluded where they differ by more than kApart turns + 3·k·σ·∫Ω
/// dt. A line that is new is nearer than it looks: kNewBins bins and 3·k·σ·Ω are added to what is
/// forced. After kLongest_s the past fades. A fold of order k is at |k·Ω − m·fs|; only folds of
/// orders up to `orders`, of the teeth up to `tooth_orders` times their number, are asked for.
class OrderGate {
 public:
  struct Config {
    double sample_rate_hz = 10e3;
    double bin_hz = 10.0;
    std::size_t teeth = 2;
    std::size_t orders = 64;
    std::size_t tooth_orders = 24;
    bool folds = false;  ///< orders beyond half of the rate are heard too
  };
  struct Line {
    double frequency_hz = 0.0;   ///< as the spectrum shows it
    double advance_turns = 0.0;  ///< of its phase since the spectrum before, −½ … ½
    double seconds = 0.0;        ///< since then
    double energy = 0.0;
  };
  /// What the orders have shown so far.
  struct Shown {
    std::span<const OrderFilter::Order> orders;
    bool learning = false;  ///< the cut has just begun
    bool clipped = false;   ///< a sensor that clips makes orders beyond all others, which fold
  };
  struct Output {
    bool forced = false;
    unsigned orders = 0;        ///< how many orders and folds it can be
    bool by_speed = false;      ///< only because the speed is not known well enough
    double order = 0.0;         ///< nearest, whole
    bool folded = false;        ///< it is beyond half of the rate
    double frequency_hz = 0.0;  ///< of the line, by its phase
    double off_hz = 0.0;        ///< of the line from that order
    double sd_hz = 0.0;         ///< what `off_hz` is uncertain by
    double followed_s = 0.0;
  };

  explicit OrderGate(const Config& config) : config_(config) {}

  const Output& look(const Line& line, const Shown& shown, double speed_rev_s,
                     double speed_sd) noexcept;
  void reset() noexcept { *this = OrderGate(config_); }

 private:
  struct Near {
    double order = 0.0;
    double heard_hz = 0.0;
    bool folded = false;
  };
  void follow(const Line& line, double speed_rev_s) noexcept;
  void ask(const Near& near, double speed_rev_s, double speed_sd) noexcept;
  [[nodiscard]] bool could_be(double order) const noexcept;
  [[nodiscard]] bool is_asked(double order, bool folded) const noexcept;

  Config config_;
  double turns_ = 0.0;  ///< of the line …
  double spindle_rev_ = 0.0;
  double seconds_ = 0.0;
  double lately_hz_ = 0.0;  ///< of the line, over some spectra
  double seen_hz_ = 0.0;
  double line_energy_ = 0.0;
  std::span<const OrderFilter::Order> orders_;  ///< while look() runs
  bool learning_ = false;
  bool clipped_ = false;
  double best_ = 0.0;  ///< distance of the nearest in terms of what is forced
  Output out_;
};

}  // namespace steadyrest::chatter::online
