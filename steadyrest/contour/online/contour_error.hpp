// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include <steadyrest/kernel/machine/axis.hpp>
#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/kernel/signal/frame.hpp>

/// The true contour error: distance from the actual point to the commanded path.
///
/// Law: ε = min |p(s) − x| over s ∈ [s_c − back, s_c + ahead], with s_c the commanded path
/// position, x the actual point. The servo lag, not a distance, bounds the window, so the foot
/// never jumps to a neighbouring turn of a spiral or to the other wall of a pocket:
///   back = max(2.5·ℓ, 1.2·|e|) + reserve,   ahead = |e|/4 + reserve
/// ℓ is the slowest axis's lag along the path, ℓ' = v − k·ℓ; |e| the distance between commanded and
/// actual point. Inside the window the minimum is global: a distance changes at most as fast as the
/// path length, so the search skips any stretch too far away to hold a nearer point.
///
/// Sign. On arcs ε > 0 means towards the centre (a disc comes out undersize): ε = R − R′. On lines
/// ε > 0 means left of the direction of travel, seen against `plane_normal`. Where the foot is on a
/// corner, the direction of travel is the mean of both sides. `left_mm` has the same magnitude and
/// follows the rule of lines everywhere, so it has no step where a clockwise arc begins. In space
/// |ε| is the whole distance; the plane gives only its sign. Where the direction of travel is
/// parallel to the normal the sign is +.
///
/// Accuracy: foot point to rounding on lines and arcs, < 1e-9 mm on helices and spirals. Without a
/// path the recent commanded points form the path (a polyline): on an arc its chords add at most
/// (v·Δt)²/(8R). Limits: rotary axes do not count; where the control rounds corners (G64) and the
/// given path is the programmed one, that rounding is part of ε.
///
/// Bounded: at most `kMaxFeet` segments are evaluated per cycle, starting next to the last foot;
/// `complete` tells whether the whole window was covered.
///
/// Source: Jin, Zhang, Ding (definition of the contour error); Erkorkmaz and Altintas, IJMTM 41
/// (2001).
namespace steadyrest::contour::online {

class ContourError {
 public:
  static constexpr std::size_t kHistory = 1024;  ///< commanded points kept in place of a path
  static constexpr int kMaxFeet = 160;

  struct Config {
    double servo_gain_1_s = 50.0;                       ///< lowest of the axes; 1…1000
    double reserve_mm = 0.25;                           ///< of the window at both ends; > 0
    kernel::signal::Point plane_normal{0.0, 0.0, 1.0};  ///< of the active plane; unit vector
  };

  struct Input {
    double time_s = 0.0;
    kernel::signal::Point command_mm{};
    kernel::signal::Point actual_mm{};
    kernel::signal::PathView path;  ///< may be empty
    std::size_t path_index = 0;
    double path_position_mm = 0.0;
    double path_speed_mm_s = 0.0;
    double slack_mm = 0.0;  ///< more of the window at both ends
    bool in_cut = true;     ///< the control is in the cut: not in a rapid, not idle
  };

  struct Output {
    bool valid = false;      ///< false: unfit input or nothing to measure against yet
    bool in_cut = false;     ///< the error is the part's: command and foot are both in the cut
    bool from_path = false;  ///< false: measured against the recent commanded points
    bool complete = true;
    double error_mm = 0.0;           ///< ε with the sign of the arc rule
    double left_mm = 0.0;            ///< ε with the sign of the line rule everywhere
    double tracking_error_mm = 0.0;  ///< |e| = Ed
    double curvature_1_mm = 0.0;     ///< of the path at the foot; 0 without a path
    kernel::signal::Point foot_mm{};
    kernel::signal::Point tangent{};  ///< at the foot
    std::size_t foot_index = 0;       ///< segment of the foot
    double foot_position_mm = 0.0;    ///< path length since the program's start
  };

  struct State {
    bool started = false;
    double time_s = 0.0;
    double lag_mm = 0.0;  ///< ℓ
    double foot_position_mm = 0.0;
    std::size_t foot_index = 0;
    double cut_from_mm = 0.0;   ///< commanded length where the cut began; a foot before it is not
    bool tool_in_cut = false;   ///< at the last sample
    double travelled_mm = 0.0;  ///< of the commanded point, in place of a path
    std::size_t count = 0;      ///< commanded points in the ring
    std::size_t next = 0;
    std::array<kernel::signal::Point, kHistory> point_mm{};
    std::array<double, kHistory> at_mm{};  ///< travelled_mm when the point was recorded
    bool from_path = false;
  };

  static kernel::outcome::Result<ContourError> make(const Config& config);

  Output update(const Input& input) noexcept;
  /// The first three axes of a frame.
  Output update(const kernel::signal::Frame& frame) noexcept;

  [[nodiscard]] const State& state() const noexcept { return state_; }
  void restore(const State& state) noexcept { state_ = state; }
  void reset() noexcept {
    state_.started = false;
    state_.count = 0;
    state_.next = 0;
  }

 private:
  /// Of the path, by its length.
  struct Window {
    double low_mm = 0.0;
    double high_mm = 0.0;
    double guess_mm = 0.0;    ///< likely position of the foot
    bool knows_foot = false;  ///< the last foot lies inside
  };

  explicit ContourError(const Config& config) noexcept : config_(config) {}
  double advance(const Input& input) noexcept;
  void remember(const Input& input) noexcept;
  [[nodiscard]] Window window(const Input& input, double tracking_error_mm,
                              double elapsed_s) const noexcept;

  Config config_;
  State state_;
};

/// What `ContourError` needs of a frame.
[[nodiscard]] ContourError::Input contour_input(const kernel::signal::Frame& frame) noexcept;

/// The same with the commanded place moved to `position_mm` of another path, which is not empty.
[[nodiscard]] ContourError::Input moved_to(ContourError::Input input, kernel::signal::PathView path,
                                           double position_mm) noexcept;

/// The same for the path that the part should have (Frame::original), where the program's text
/// corrects its path; else for the frame's own.
[[nodiscard]] ContourError::Input original_input(const kernel::signal::Frame& frame) noexcept;

/// For a machine: the gain of the softest of the three axes that make the contour.
[[nodiscard]] ContourError::Config contour_config(
    std::span<const kernel::machine::Axis> axes) noexcept;

}  // namespace steadyrest::contour::online
