// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <steadyrest/chatter/online/speed_law.hpp>

/// Spindle speed over the spindle's angle for a modulation law given in time, or a course of ramps.
///
/// dθ/dt = Ω₀·(1 + RVA·S(u)), u = RVF·Ω₀·t/2π, so θ(u) = (2π/RVF)·(u + RVA·∫₀ᵘS); over one period
/// of the law the spindle turns 2π/RVF. RVA is the amplitude over the mean speed, 0 … below 1, RVF
/// the law's frequency over that of the rotation.
namespace steadyrest::chatter::offline {

struct Modulation {
  online::Law law = online::Law::constant;
  double rva = 0.0;
  double rvf = 0.1;
  std::uint64_t seed = 1;  ///< of the random law
};

/// The speed over a stretch of time, rising or falling evenly.
struct SpeedRamp {
  double duration_s = 0.0;  ///< > 0
  double from_rev_s = 0.0;  ///< > 0
  double to_rev_s = 0.0;    ///< > 0
};

class SpeedProfile {
 public:
  SpeedProfile(double mean_rev_s, const Modulation& modulation);
  /// One period of a course, which then repeats: θ(t) = θ₀ + Ω₀·t + Ω̇·t²/2 on each ramp, so Ω² =
  /// Ω₀² + 2Ω̇·(θ − θ₀). Its durations are stretched together to fill the angle; not empty. The
  /// ends of up to 64 ramps are corners; with more ramps none is, and the accuracy is lower.
  SpeedProfile(const std::vector<SpeedRamp>& course, double period_rad);
  /// Angle of a course without stretching.
  [[nodiscard]] static double angle_rad(const std::vector<SpeedRamp>& course) noexcept;

  [[nodiscard]] bool constant() const noexcept { return constant_; }
  /// Angle of one period of the law; 0 when constant.
  [[nodiscard]] double period_rad() const noexcept { return period_rad_; }
  /// At the angle since the law's start, any real number.
  [[nodiscard]] double speed_rad_s(double angle_rad) const noexcept;
  [[nodiscard]] double time_s(double angle_rad) const noexcept;
  [[nodiscard]] double mean_rad_s() const noexcept { return mean_rad_s_; }
  [[nodiscard]] double slowest_rad_s() const noexcept { return slowest_rad_s_; }
  /// Angles within [0, period) where the speed or its slope jumps.
  [[nodiscard]] const std::vector<double>& corners_rad() const noexcept { return corners_rad_; }

 private:
  /// A ramp by its angle.
  struct Part {
    double angle_rad;  ///< where it begins
    double time_s;
    double from_rad_s;
    double to_rad_s;
  };
  [[nodiscard]] const Part& part(double angle_rad) const noexcept;
  [[nodiscard]] double phase(double angle_rad) const noexcept;

  online::SpeedLaw law_;
  double mean_rad_s_;
  double rva_;
  double slowest_rad_s_;
  double period_rad_ = 0.0;
  bool constant_;
  std::vector<Part> parts_;  ///< of a course, and its end; empty for a law
  std::vector<double> corners_rad_;
};

}  // namespace steadyrest::chatter::offline
