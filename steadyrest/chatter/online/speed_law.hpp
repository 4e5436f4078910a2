// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include <steadyrest/kernel/machine/chatter.hpp>

/// Shapes of a spindle-speed modulation: speed = mean·(1 + RVA·S(u)), u the phase in periods.
///
/// S has the mean 0 and lies within −1 … 1:
///   sine      sin 2πu
///   triangle  0 at u = 0, +1 at ¼, −1 at ¾
///   square    +1 in the first half, −1 in the second
///   pulse     +1 for the share d, −d/(1 − d) for the rest
///   stop      −1 for the share d, +d/(1 − d) for the rest (a brief fall of the speed)
///   random    straight lines between values drawn from the seed, at kRandomKnots even phases
/// Phases as in the literature's references: Seguy et al. 2010; Insperger, Stépán 2004.
namespace steadyrest::chatter::online {

using Law = kernel::machine::SpeedLaw;

class SpeedLaw {
 public:
  static constexpr std::size_t kRandomKnots = 16;
  static constexpr std::size_t kMostCorners = kRandomKnots;

  explicit SpeedLaw(Law law = Law::constant, std::uint64_t seed = 1) noexcept;

  [[nodiscard]] Law law() const noexcept { return law_; }
  /// S at the phase, any real number; whole periods are dropped. At a jump: the new value.
  [[nodiscard]] double at(double phase) const noexcept;
  /// ∫₀ᵘ S within one period, u = 0 … 1; 0 at both ends.
  [[nodiscard]] double integral(double phase) const noexcept;
  /// Phases within [0, 1) where S or its slope jumps; the first `corner_count()` are valid.
  [[nodiscard]] const std::array<double, kMostCorners>& corners() const noexcept {
    return corners_;
  }
  [[nodiscard]] std::size_t corner_count() const noexcept { return corner_count_; }

 private:
  void corner(double phase) noexcept { corners_[corner_count_++] = phase; }

  Law law_;
  std::array<double, kMostCorners> corners_{};
  std::size_t corner_count_ = 0;
  std::array<double, kRandomKnots + 1> knot_{};
  std::array<double, kRandomKnots + 1> knot_integral_{};
};

/// S itself jumps, so no drive follows it exactly.
[[nodiscard]] constexpr bool jumps(Law law) noexcept {
  return law == Law::square || law == Law::pulse || law == Law::stop;
}

/// The law's word at the borders: constant, square, pulse, triangle, sine, random, stop.
[[nodiscard]] const char* name(Law law) noexcept;
/// The law of a word; nullopt for any other word.
[[nodiscard]] std::optional<Law> law_of(std::string_view word) noexcept;

}  // namespace steadyrest::chatter::online
