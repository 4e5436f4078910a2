// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <complex>
#include <cstddef>
#include <cstdint>
#include <optional>

#include <steadyrest/chatter/offline/cycle/delay_cycle.hpp>
#include <steadyrest/chatter/offline/cycle/multipliers.hpp>
#include <steadyrest/kernel/outcome/result.hpp>

/// Is the cut stable at this speed and depth, and how much may a vibration grow before it dies?
///
/// Spectral radius ρ < 1 is necessary but, with slow modulation, not enough: a vibration grows
/// while the speed passes through unstable ranges. Peak growth is the worst of all vibrations: the
/// largest later displacement over the largest within one pass before, max ‖Φ(t₂, t₁)‖_∞ over pass
/// boundaries t₁ < t₂ within two principal periods (at least 20 passes; free vibration counts as q
/// and q̇/ω).
namespace steadyrest::chatter::offline {

enum class ChatterType : std::uint8_t {
  none,  ///< stable
  hopf,  ///< a pair of complex multipliers: quasi-periodic chatter
  flip,  ///< a real multiplier below −1: period doubling
  fold   ///< a real multiplier above 1
};

struct Stability {
  double log_radius = 0.0;  ///< ln ρ over one period of the modulation law, over one pass (tooth
                            ///< pitch; revolution where the pitch is uneven) when constant
  double log_radius_per_pass = 0.0;
  bool stable = false;
  std::complex<double> multiplier;       ///< dominant, over the principal period
  ChatterType type = ChatterType::none;  ///< of the dominant multiplier when unstable
  /// The strongest line of the dominant vibration e^{λt}·p(t), p repeating with the principal
  /// period. The multiplier e^{λT} gives a frequency up to multiples of 1/T: at constant speed the
  /// strongest line stands out, under modulation lines 1/T apart are nearly as strong. Empty beyond
  /// 400 passes.
  std::optional<double> frequency_hz;
  double frequency_step_hz = 0.0;  ///< 1/T
  double peak_growth = 1.0;        ///< see above; only on request, else 1
  std::size_t passes = 1;          ///< in the principal period
  std::size_t law_periods = 1;
};

struct StabilityOptions {
  bool peak_growth = false;
  bool frequency = false;
  double tolerance = 1e-10;
};

/// At the cycle's present depth.
[[nodiscard]] Stability stability(DelayCycle& cycle, const StabilityOptions& options);

/// The same at one point; the depth is `config.most_depth_mm`. Refuses what DelayCycle refuses.
[[nodiscard]] kernel::outcome::Result<Stability> stability_at(const Process& process,
                                                              const DelayCycle::Config& config,
                                                              const StabilityOptions& options);

/// ln of the worst growth between pass boundaries.
[[nodiscard]] double log_peak_growth(DelayCycle& cycle);

[[nodiscard]] const char* name(ChatterType type) noexcept;

}  // namespace steadyrest::chatter::offline
