// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>

/// Inputs and outputs of every motion estimator.
///
/// An incremental encoder divides the axis into cells of one count. Line k is the border between
/// the cells k − 1 and k; cell c means line(c) ≤ x < line(c + 1). An *edge* is the passage of a
/// line at a known time; a *tick* is the control cycle's look at the count. Edges come in time
/// order, those of a cycle before its tick.
namespace steadyrest::motion::online {

inline constexpr double kNoBound = std::numeric_limits<double>::infinity();

/// The axis passed a line.
struct Edge {
  double t_s = 0.0;           ///< time stamp, monotone
  double position_mm = 0.0;   ///< of the line, calibration included
  std::int64_t line = 0;      ///< number of the line
  std::int8_t direction = 1;  ///< +1 upwards (the count is now `line`), −1 downwards (`line` − 1)
  std::uint8_t lost = 0;      ///< ≠ 0: edges before this one are missing (saturates)
  float sigma_mm = -1.0F;     ///< of the line's position where it is worse than that of the other
                              ///< lines (not calibrated yet); < 0: like the others
};

/// The control cycle.
struct Tick {
  double t_s = 0.0;        ///< when the cycle looked; monotone, including jitter
  std::int64_t count = 0;  ///< cell in which the axis was
  double low_mm = 0.0;     ///< position of the cell's lower line, calibration included
  double high_mm = 0.0;    ///< of its upper line
};

/// The axis at one instant. Bounds are guaranteed (|true − estimate| ≤ bound) as long as the axis
/// keeps the limits given to the estimator; kNoBound where it gives none.
struct Estimate {
  double t_s = 0.0;  ///< the instant of the values: the tick minus the estimator's lag
  double position_mm = 0.0;
  double velocity_mm_s = 0.0;
  double acceleration_mm_s2 = 0.0;
  double position_bound_mm = kNoBound;
  double velocity_bound_mm_s = kNoBound;
  double acceleration_bound_mm_s2 = kNoBound;
};

/// The common interface. No allocation, lock or unbounded loop in `edge` and `tick`.
class Estimator {
 public:
  Estimator() = default;
  Estimator(const Estimator&) = default;
  Estimator(Estimator&&) = default;
  Estimator& operator=(const Estimator&) = default;
  Estimator& operator=(Estimator&&) = default;
  virtual ~Estimator() = default;

  virtual void edge(const Edge& edge) noexcept = 0;
  virtual Estimate tick(const Tick& tick) noexcept = 0;
};

}  // namespace steadyrest::motion::online
