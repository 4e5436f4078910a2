// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include <steadyrest/kernel/machine/axis.hpp>
#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/kernel/signal/frame.hpp>

namespace steadyrest::contour::online {

/// What the prediction needs of one axis: τ·ẍ + ẋ = k·(c − x) + a·ċ.
struct AxisModel {
  double gain_1_s = 50.0;       ///< k
  double feed_forward = 0.0;    ///< a
  double velocity_lag_s = 0.0;  ///< τ
  bool operator==(const AxisModel&) const = default;
};

/// Identifies servo gain k and feed-forward a of each axis while the machine cuts.
///
/// Law. The axis obeys τ·ẍ + ẋ = k·e + a·ċ, e = c − x. Multiplied by φ(t) = 4t(T − t)/T², which
/// vanishes at both ends of a window T, and integrated by parts:
///   −∫φ′x dt + τ·(∫φ″x dt − [φ′x]) = k·∫φe dt − a·∫φ′c dt,
/// so no sample is ever differentiated and the encoder's quantisation averages out (modulating
/// functions, Shinbrot 1957). Each window is one row y = k·p + a·q of a recursive least-squares
/// estimate in information form that forgets towards the prior, not towards nothing:
///   Λ ← λΛ + (1 − λ)Λ₀ + φφᵀ/σ²,   λ = exp(−T/memory).
/// Λ ≥ (1 − λ)·Λ₀-share always, so the covariance is bounded: at constant speed, where only (1 −
/// a)/k shows, that direction is learnt and the prior holds the other one. Rows with a residual
/// large against the recent ones get less weight (Huber).
///
/// τ is not identified; it comes from the machine file. Gates: no row from standstill, reversals
/// (backlash, stiction), a saturated drive, gaps in time. The estimate never leaves k₀/3 … 3·k₀ and
/// 0 … 1.
///
/// Converges: with a true gain of 42 and 50 in the file, to within 1 % after 0.3 s of steady
/// motion.
class ServoModel {
 public:
  struct Config {
    std::array<AxisModel, kernel::signal::kMaxAxes> prior{};
    std::array<double, kernel::signal::kMaxAxes> count_mm{};     ///< encoder count; 0 = ideal
    std::array<double, kernel::signal::kMaxAxes> drive_mm_s2{};  ///< drive's limit; 0 = not known
    std::size_t axes = 3;                                        ///< 1…kMaxAxes
    double window_s = 0.040;                                     ///< T; 0.01…0.5
    double memory_s = 2.0;                                       ///< forgetting; > window
    double prior_gain_ratio = 0.3;     ///< standard deviation of k₀ over k₀
    double prior_feed_forward = 0.03;  ///< standard deviation of a₀
    double row_noise_ratio = 0.01;     ///< error of the law over the travel of a window
  };

  /// One axis' running sums and information; plain values.
  struct AxisState {
    double c0 = 0.0, x0 = 0.0;  ///< positions at the window's start
    double last_c = 0.0, last_x = 0.0;
    double sum_x = 0.0, sum_tx = 0.0;  ///< ∫x, ∫t·x relative to x0
    double sum_c = 0.0, sum_tc = 0.0;
    double sum_te = 0.0, sum_tte = 0.0;  ///< ∫t·e, ∫t²·e
    double first_step_mm = 0.0, last_step_mm = 0.0;
    bool reversed = false;
    double l11 = 0.0, l12 = 0.0, l22 = 0.0;  ///< Λ
    double r1 = 0.0, r2 = 0.0;               ///< Λ·θ
    double residual_ratio = 0.3;             ///< running size of |residual|/|y|
    std::uint32_t rows = 0;
    AxisModel model;
  };
  struct State {
    bool started = false;
    double time_s = 0.0;
    double elapsed_s = 0.0;
    double first_dt_s = 0.0;
    std::uint32_t samples = 0;
    std::array<AxisState, kernel::signal::kMaxAxes> axis{};
  };

  static kernel::outcome::Result<ServoModel> make(const Config& config);
  /// Prior, encoder and drive from the machine file.
  static kernel::outcome::Result<ServoModel> make(std::span<const kernel::machine::Axis> axes,
                                                  double interpolator_period_s);

  /// One cycle. True when some axis's model was renewed.
  bool update(const kernel::signal::Frame& frame) noexcept;
  /// Learns nothing until the next update; for use while the input cannot be trusted.
  void pause() noexcept { state_.started = false; }

  [[nodiscard]] const AxisModel& axis(std::size_t i) const noexcept { return state_.axis[i].model; }
  [[nodiscard]] const State& state() const noexcept { return state_; }
  void restore(const State& state) noexcept { state_ = state; }

 private:
  explicit ServoModel(const Config& config) noexcept;
  void open_window(const kernel::signal::Frame& frame) noexcept;
  bool close_window() noexcept;
  bool learn(std::size_t i) noexcept;
  void solve(std::size_t i) noexcept;

  Config config_;
  State state_;
};

}  // namespace steadyrest::contour::online
