// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/chatter/online/lines/line_spectrum.hpp>
#include <steadyrest/chatter/online/orders/order_gate.hpp>

namespace steadyrest::chatter::online {

/// The line of a spectrum that is judged: the strongest. Where that can be an order of the spindle,
/// which is forced vibration whatever its size, it is the strongest line beside the orders, if its
/// phase shows that it is none and it has a tenth of the lines' energy. Lines within the guard of a
/// tooth order are ignored by the spectrum: one that has twice the energy of all others and whose
/// phase has shown for 0.15 s that it is not the order is judged.
class LineChoice {
 public:
  struct Output {
    double frequency_hz = 0.0;  ///< 0 = none yet
    double peak_ratio = 0.0;    ///< strongest bin over the noise of a bin
    double line_energy = 0.0;   ///< of all lines that can be chatter, unit²
    double order_energy = 0.0;  ///< of the other lines
    double noise_energy = 0.0;
    double alone = 0.0;       ///< the line's part of the energy of all lines
    OrderGate::Output order;  ///< the order nearest to the line
  };

  explicit LineChoice(const OrderGate::Config& config)
      : strongest_(config), beside_(config), guarded_(config) {}

  const Output& look(const LineSpectrum::Output& lines, const OrderGate::Shown& shown,
                     double speed_rev_s, double speed_sd) noexcept;
  void reset() noexcept;

 private:
  OrderGate strongest_;
  OrderGate beside_;
  OrderGate guarded_;
  Output out_;
};

}  // namespace steadyrest::chatter::online
