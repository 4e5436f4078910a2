// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

/// Ripple that repeats with position: waves of 5 … 35 counts in the position, learnt in place from
/// the edges alone.
///
/// e(n) = Σ aⱼ·cos 2πfⱼn + bⱼ·sin 2πfⱼn, n in counts, up to four waves. Teeth, poles and the
/// interpolation of a fine encoder cause such waves; their velocity, v·e′, is 2 … 5 % of the speed
/// and appears within 1 … 3 edges: unpredictable for any filter over time, but known in advance by
/// position.
///
/// Learning: a least-squares cubic x(t) through 21 passages in one direction; the middle passage
/// minus the cubic is z = d·x with weights d that depend only on the times. A bank of discrete
/// Fourier sums over n finds the frequencies (power above 14 times that of noise), and least
/// squares with forgetting finds the coefficients, with d·cos and d·sin in place of the waves.
/// Waves below five counts are excluded: four counts are one period of the lines, and what repeats
/// there is the lines' own error, not motion.
///
/// Waves are used while they explain the residuals: the remainder is below 0.7 of their power. The
/// lines' random errors repeat with position too, but in no wave more than in others: a wave needs
/// a tenth of the power and 150 lines of travel.
///
/// Cost: 0.5 µs per tick with a new passage. Lengths are counts. Figures:
/// steadyrest/motion/README.md.
namespace steadyrest::motion::online {

class Ripple {
 public:
  static constexpr std::size_t kWaves = 4;
  static constexpr std::size_t kWindow = 21;

  struct Value {
    double counts = 0.0;
    double slope = 0.0;  ///< counts/count
  };

  Ripple() noexcept;
  /// A passage, in time order. A turn, a lost edge or a gap in the lines restarts the window.
  void edge(double t_s, std::int64_t line, std::int8_t direction, bool lost) noexcept;
  /// Learns from the window that ends with the last passage. Call at every tick; a tick with more
  /// than two passages teaches nothing: waves sampled at every third line or fewer are ambiguous.
  void learn() noexcept;
  /// At the position `counts`, whose zero is line 0.
  [[nodiscard]] Value at(double counts) const noexcept;
  /// At a line, exact however far from 0.
  [[nodiscard]] double at_line(std::int64_t line) const noexcept;
  /// Waves were found that explain the residuals.
  [[nodiscard]] bool active() const noexcept { return active_ && noise_ < kHeard * power_; }
  /// Amplitude in counts of wave j, 0 = not in use; and its length in counts.
  [[nodiscard]] double amplitude(std::size_t j) const noexcept;
  [[nodiscard]] double length(std::size_t j) const noexcept { return 1.0 / wave_[j].frequency; }

 private:
  static constexpr std::size_t kCircle =
      1024;  ///< places of the table of sines; bins are 1/kCircle apart
  static constexpr std::size_t kFirstBin = 29;
  static constexpr std::size_t kBins = 176;
  static constexpr std::size_t kStates = 2 * kWaves;
  static constexpr double kHeard = 0.7;

  struct Wave {
    double frequency = 0.1;  ///< 1/count
    bool used = false;
  };
  struct Peak {
    double power = 0.0;
    double frequency = 0.0;
  };
  [[nodiscard]] double cosine(double turns) const noexcept;
  [[nodiscard]] bool weigh() noexcept;
  void teach() noexcept;
  void search() noexcept;
  void choose() noexcept;
  void take_up(std::size_t j, const Peak& peak) noexcept;
  [[nodiscard]] std::array<Peak, kWaves> peaks() const noexcept;

  std::array<double, kCircle + kCircle / 4 + 1> cosine_{};
  std::array<double, kWindow> t_s_{};
  std::int64_t last_line_ = 0;
  std::int64_t origin_ = 0;  ///< line that phases count from
  std::size_t next_ = 0;
  std::size_t count_ = 0;
  std::int8_t direction_ = 0;
  bool started_ = false;
  std::uint32_t fresh_ = 0;  ///< passages since the last call of learn()

  std::array<double, kWindow> weight_{};  ///< d
  double residual_ = 0.0;                 ///< z
  std::int64_t middle_ = 0;               ///< line of the window's middle, from the origin
  std::int8_t sense_ = 1;

  std::array<double, kBins> cosine_sum_{};
  std::array<double, kBins> sine_sum_{};
  double weight_sum_ = 0.0;
  double square_sum_ = 0.0;
  std::uint32_t since_choice_ = 0;
  std::int64_t lowest_ = 0;  ///< lines with residuals, from the origin
  std::int64_t highest_ = 0;

  std::array<Wave, kWaves> wave_{};
  std::array<double, kStates> c_{};
  std::array<std::array<double, kStates>, kStates> p_{};
  double power_ = 1e-4;  ///< mean of z²
  double noise_ = 1e-4;  ///< … of the part that the waves do not explain
  bool active_ = false;  ///< a wave is in use
};

}  // namespace steadyrest::motion::online
