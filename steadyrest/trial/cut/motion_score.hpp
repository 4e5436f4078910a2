// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <steadyrest/kernel/machine/axis.hpp>
#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/kernel/signal/frame.hpp>
#include <steadyrest/kernel/signal/path.hpp>
#include <steadyrest/motion/online/estimator/backward_difference.hpp>
#include <steadyrest/trial/cut/report_data.hpp>

namespace steadyrest::trial::cut {

/// Scores the estimates of the axes' motion in the frames against the simulated machine's true
/// motion, alongside the backward difference of the same counts.
///
/// Each cycle of the cut counts, including standstill and rapids, at zero lag: error = estimate −
/// truth at the cycle's end, on the encoder's side. Coverage: of the cycles with a bound, the share
/// in which |error| ≤ that bound.
class MotionScore {
 public:
  /// `cycle_s`: the control's interpolator period.
  static kernel::outcome::Result<MotionScore> make(std::span<const kernel::machine::Axis> axes,
                                                   double cycle_s);

  void add(const kernel::signal::Frame& frame, const kernel::signal::AxisValues& velocity_mm_s,
           const kernel::signal::AxisValues& acceleration_mm_s2) noexcept;

  /// For the axes that have an encoder with counts.
  [[nodiscard]] std::vector<MotionFigures> figures() const;

 private:
  struct Sums {
    double velocity = 0.0;
    double acceleration = 0.0;
  };
  struct Axis {
    std::string name;
    std::size_t index = 0;
    double count_mm = 0.0;
    motion::online::BackwardDifference difference;
    std::size_t samples = 0;
    Sums estimate_squares{};
    Sums difference_squares{};
    std::array<std::size_t, 2> bounded{};  ///< of velocity, of acceleration
    std::array<std::size_t, 2> kept{};
  };

  MotionScore() = default;

  std::vector<Axis> axes_;
};

}  // namespace steadyrest::trial::cut
