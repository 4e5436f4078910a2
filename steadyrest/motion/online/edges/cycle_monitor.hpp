// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <steadyrest/kernel/outcome/result.hpp>

namespace steadyrest::motion::online {

/// Measures how steadily the control cycle runs, from the time stamps of its ticks.
///
/// With tick k at t_k = k·T + j_k (j: jitter) the periods are p_k = T + j_k − j_{k−1}. The report
/// has their mean and standard deviation (Welford), extremes, and the 99.9 % quantile of
/// |p − T| from a histogram of fixed bins (32 per octave from 1 ns, so at most 3.2 % too high,
/// never too low, 8 s at most). The correlation of neighbouring periods tells the kind of jitter:
/// −½ for ticks that vary independently about a true grid (σ_t = σ_p/√2), 0 for periods that add
/// up.
///
/// Missed cycles: a period beyond 1.5·T counts as round(p/T) − 1 of them, one beyond `gap_cycles`·T
/// as a gap; neither enters the statistics. A time that is not finite or does not advance is
/// counted but not used; three stamps in a row that go back mean that the clock was set, and the
/// monitor continues from there.
///
/// Effect of jitter on differences over the nominal period, at speed v, acceleration a, for
/// independent j of standard deviation σ_t; the truth is at the instant t_k + j_k:
///   x(t_k + j_k) = x_k + v·j_k + …, x(t_{k−1} + j_{k−1}) = x_k − vT + ½aT² + (v − aT)·j_{k−1} + …
///   v̂ − v = −½aT + (v/T − a)·(j_k − j_{k−1}) + O(a·j²/T)
///   RMS = √2·σ_t·|v/T − a|, the main part √2·v·σ_t/T; the bias −½aT is not the jitter's;
///   â − a: (v/T²)·(j_k − 2j_{k−1} + j_{k−2}), RMS = √6·σ_t·|v|/T².
/// Dividing by the measured period instead leaves −½a·(T + j_k − j_{k−1}): RMS a·σ_t/√2. An edge
/// has its own stamp, so tick jitter does not enter an estimate from edges at all. The count's
/// quantisation, q/(√6·T) and q/(√2·T²), adds as root sum of squares.
class CycleMonitor {
 public:
  struct Config {
    double nominal_period_s = 0.0;  ///< T; 0: the median of the first 31 periods
    double gap_cycles = 10.0;       ///< > 1.5
  };
  struct Report {
    double nominal_period_s = 0.0;
    double mean_period_s = 0.0;
    double period_rms_s = 0.0;        ///< standard deviation σ_p
    double tick_rms_s = 0.0;          ///< σ_p/√2: σ_t if the correlation is near −½
    double period_correlation = 0.0;  ///< of neighbouring periods
    double shortest_s = 0.0;
    double longest_s = 0.0;         ///< of those without a missed cycle
    double deviation_p999_s = 0.0;  ///< 99.9 % of |p − T| are at most this
    double longest_gap_s = 0.0;
    std::uint64_t periods = 0;        ///< in the statistics
    std::uint64_t missed_cycles = 0;  ///< gaps not counted
    std::uint64_t gaps = 0;
    std::uint64_t backwards = 0;  ///< stamps that did not advance
    std::uint64_t not_finite = 0;
  };

  static kernel::outcome::Result<CycleMonitor> make(const Config& config);

  void update(double t_s) noexcept;
  /// Report so far. Walks the histogram: not for every cycle.
  [[nodiscard]] Report report() const noexcept;
  void reset() noexcept;

 private:
  static constexpr std::size_t kLearn = 31;
  static constexpr int kSubBins = 32;
  static constexpr int kOctaves = 33;  // 1 ns … 8.6 s
  static constexpr std::size_t kBins = std::size_t{kSubBins} * (kOctaves + 1);

  explicit CycleMonitor(const Config& config) noexcept : config_(config) { reset(); }
  [[nodiscard]] static std::size_t bin_of(double deviation_s) noexcept;
  [[nodiscard]] static double upper_edge_s(std::size_t bin) noexcept;
  [[nodiscard]] double quantile_s(double share) const noexcept;
  void learn(double period_s) noexcept;
  void take(double period_s) noexcept;
  void count(double period_s) noexcept;

  Config config_;
  std::array<double, kLearn> first_{};
  std::size_t learnt_ = 0;
  bool started_ = false;
  double last_s_ = 0.0;
  int in_a_row_ = 0;  // stamps that go back
  bool has_previous_ = false;
  double previous_ = 0.0;  // deviation of the previous period
  double mean_ = 0.0;      // of the deviation p − T
  double squares_ = 0.0;   // Σ(p − mean)²
  double products_ = 0.0;  // Σ of neighbours' products, with the sums that centre them
  double sum_first_ = 0.0;
  double sum_second_ = 0.0;
  std::uint64_t pairs_ = 0;
  std::array<std::uint64_t, kBins> histogram_{};
  Report report_;
};

/// √2·σ_t·|v/T − a|: RMS error of (x_k − x_{k−1})/T from jitter alone.
[[nodiscard]] double velocity_jitter_error_mm_s(double velocity_mm_s, double acceleration_mm_s2,
                                                double period_s, double tick_rms_s) noexcept;

/// √6·σ_t·|v|/T²: RMS error of (x_k − 2x_{k−1} + x_{k−2})/T² by jitter alone.
[[nodiscard]] double acceleration_jitter_error_mm_s2(double velocity_mm_s, double period_s,
                                                     double tick_rms_s) noexcept;

}  // namespace steadyrest::motion::online
