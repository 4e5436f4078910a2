// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <steadyrest/kernel/outcome/result.hpp>

/// What a control sees of a motion, in counts and ticks, and the encoder that a motion permits.
///
///     V_t = X_i − X_(i−1)            counts/tick     (1)
///     a_t = V_i − V_(i−1)            counts/tick²    (2)
///     V_t = F·K / f_c                counts/tick     (3)   F speed in mm/s, K = 1/d counts/mm
///     a_t = n·g·K / f_c²             counts/tick²    (4)   n overload, g in mm/s²
///     f_s = n_r·Z                    Hz              (5)   n_r in rev/s, Z lines per revolution
///     Z   = f_s·h / F                lines/rev       (6)   h lead in mm/rev, linear axis
///     Z   = f_s / n_r                lines/rev       (7)   spindle
///     d   = h / (4·Z)                mm              (8)   count with fourfold evaluation
///
/// The source writes F in mm/min, n_r in rev/min and g in m/s²; its factors 60 and 1000 are
/// conversions, done at the borders here. f_s is the frequency of one channel; counts come four
/// times as fast.
///
/// Every function refuses inputs that are not finite and positive, and a result beyond a double's
/// range. Source: Kombarov, Aksenov, Krizhivets, Determination of physical parameters of CNC
/// machines execution units, KhAI 2011, eqs. 1–8.
namespace steadyrest::motion::offline {

inline constexpr double kGravity_mm_s2 = 9806.65;  ///< g, standard
inline constexpr double kCountsPerLine = 4.0;      ///< fourfold evaluation of A and B

using Number = kernel::outcome::Result<double>;

/// The view of the control: one count and one cycle.
struct Sampling {
  double count_mm = 0.001;   ///< d = 1/K
  double cycle_hz = 1000.0;  ///< f_c
};

/// Eq. 1 and eq. 2 over a row of counts, one a tick: value k belongs to counts k and k + 1 (k … k +
/// 2).
[[nodiscard]] std::vector<std::int64_t> tick_velocities(std::span<const std::int64_t> counts);
[[nodiscard]] std::vector<std::int64_t> tick_accelerations(std::span<const std::int64_t> counts);

/// Eq. 3 and back.
[[nodiscard]] Number counts_per_tick(const Sampling& sampling, double speed_mm_s);
[[nodiscard]] Number speed_mm_s(const Sampling& sampling, double counts_per_tick);

/// Eq. 4 and back; overload n = 1 is one g.
[[nodiscard]] Number counts_per_tick2(const Sampling& sampling, double acceleration_mm_s2);
[[nodiscard]] Number acceleration_mm_s2(const Sampling& sampling, double counts_per_tick2);
[[nodiscard]] Number acceleration_of_overload_mm_s2(double overload_g);
[[nodiscard]] Number overload_g(double acceleration_mm_s2);

/// The number of speeds up to this one that count differences can tell apart: whole counts per
/// tick.
[[nodiscard]] Number speed_gradations(const Sampling& sampling, double max_speed_mm_s);

/// The position resolution that tells as many speeds apart as the drive has:
/// d·(counts per tick at the largest speed)/(gradations of the drive).
[[nodiscard]] Number required_resolution_mm(const Sampling& sampling, double max_speed_mm_s,
                                            double drive_gradations);

/// Eq. 5: frequency of one channel.
[[nodiscard]] Number signal_frequency_hz(double lines_per_rev, double speed_rev_s);

/// Eq. 6: the most lines for a linear axis, and the fastest feed for given lines.
[[nodiscard]] Number lines_for_feed(double max_frequency_hz, double lead_mm, double speed_mm_s);
[[nodiscard]] Number feed_for_lines_mm_s(double max_frequency_hz, double lead_mm,
                                         double lines_per_rev);

/// Eq. 7: the most lines for a spindle, and the fastest speed for given lines.
[[nodiscard]] Number lines_for_speed(double max_frequency_hz, double speed_rev_s);
[[nodiscard]] Number speed_for_lines_rev_s(double max_frequency_hz, double lines_per_rev);

/// Eq. 8 and back.
[[nodiscard]] Number count_of_lines_mm(double lead_mm, double lines_per_rev);
[[nodiscard]] Number lines_of_count(double lead_mm, double count_mm);

}  // namespace steadyrest::motion::offline
