// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/chatter/offline/signal/signal_file.hpp>

namespace steadyrest::chatter::offline {

/// The highest rate that the detector takes.
inline constexpr double kDetectorRate_hz = 50e3;

/// Brings a signal to the detector's rate: y_k = Σ h_j·x_{kM+j}, with M the least whole number for
/// which rate/M ≤ 50 kHz and h an even low-pass (sinc in a Kaiser window, β = 7.857), which delays
/// nothing. Flat within 10⁻³ to 0.4 of the new rate (10 kHz or more); what would be mirrored there
/// from above 0.6 of it is 80 dB down. At the ends the signal is taken to continue as it began or
/// ended. The speed is read at the samples kept. Sets `recorded_hz`. Source: Oppenheim, Schafer,
/// Discrete-Time Signal Processing, 7.6.
void reduce_rate(RecordedSignal& signal);

}  // namespace steadyrest::chatter::offline
