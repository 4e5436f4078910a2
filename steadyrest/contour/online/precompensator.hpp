// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include <steadyrest/contour/online/look_ahead.hpp>
#include <steadyrest/contour/online/servo_model.hpp>
#include <steadyrest/contour/online/tool_point.hpp>
#include <steadyrest/kernel/machine/axis.hpp>
#include <steadyrest/kernel/offset/limited_follower.hpp>
#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/kernel/signal/frame.hpp>
#include <steadyrest/kernel/signal/request.hpp>

namespace steadyrest::contour::online {

/// Cancels the contour error at full feed: axis offsets that keep the tool on the path.
///
/// Law: tool_point.hpp. An offset asked for now acts with the next command, or n cycles later where
/// the port says so; so the command is predicted by n + 1 cycles of constant acceleration, the
/// first of them s_c + (v + ½Δv)·T, and the offset is
///   o = w·(c′ − c)   at that place,
/// with w = 0 … 1 growing over `fade_in_s` where it comes into force on a moving machine.
///
/// Slow offsets. A port may limit an offset's acceleration to A (LimitedFollower): a jump of J mm
/// then takes 2·√(J/A). Where the error has passed by then, as behind a sharp corner, following
/// does only harm; the governor forecasts both and says whether the offset follows o or returns
/// to 0.
///
/// Withdraws (no wish; the envelope then ramps the offset out): no path, threads and taps, frames
/// that are unfit or not one cycle apart.
/// Not in it: friction, stiction and whatever else ServoModel leaves out. The feed governor
/// forecasts with the same tool point and takes the feed down for what the offsets cannot do.
class Precompensator {
 public:
  struct Config {
    std::vector<kernel::machine::Axis> axes;  ///< X, Y, Z first
    double max_offset_mm = 0.0;               ///< 0: it never asks
    double fade_in_s = 0.2;
    double delay_s = 0.0;             ///< of an offset beyond one cycle; 0 … 0.02
    double acceleration_mm_s2 = 0.0;  ///< A ≥ 0; 0: no limit
  };

  struct Input {
    const kernel::signal::Frame& frame;
    const LookAhead& path;   ///< that knows the frame's command
    double step_s = 0.0;     ///< since the last frame
    bool active = false;     ///< offsets that are asked for come into force
    bool permitted = false;  ///< the path is known, the frame is fit, no thread is cut
    bool follows = true;     ///< the offset follows o, else 0
  };

  struct State {
    bool started = false;
    double share = 0.0;        ///< w
    double position_mm = 0.0;  ///< s_c of the last frame
    double speed_mm_s = 0.0;
    ToolPoint::State tool;                                    ///< at the last frame
    std::array<kernel::offset::LimitedFollower, 3> offset{};  ///< where the port moves slow ones
  };

  static kernel::outcome::Result<Precompensator> make(const Config& config);

  void set_model(std::span<const AxisModel, 3> model) noexcept { point_.set_model(model); }
  kernel::signal::OffsetRequest update(const Input& input) noexcept;

  [[nodiscard]] bool enabled() const noexcept { return config_.max_offset_mm > 0.0; }
  /// Of the last update: where the tool point is, once the offsets have their full size.
  [[nodiscard]] std::optional<ToolPoint::State> in_full() const noexcept;
  /// The same, whatever their size yet.
  [[nodiscard]] std::optional<ToolPoint::State> tool() const noexcept;
  [[nodiscard]] const ToolPoint& point() const noexcept { return point_; }
  [[nodiscard]] double max_offset_mm() const noexcept { return config_.max_offset_mm; }
  /// The path must be kept from here on.
  [[nodiscard]] double position_mm() const noexcept { return state_.tool.position_mm; }
  [[nodiscard]] bool started() const noexcept { return state_.started; }

  /// A; 0: no limit.
  [[nodiscard]] double acceleration_mm_s2() const noexcept { return config_.acceleration_mm_s2; }

  void reset() noexcept { state_ = {}; }
  [[nodiscard]] const State& state() const noexcept { return state_; }
  void restore(const State& state) noexcept { state_ = state; }

 private:
  explicit Precompensator(const Config& config) noexcept;
  kernel::signal::OffsetRequest ask(const Input& input) noexcept;

  Config config_;
  ToolPoint point_;
  State state_;
};

}  // namespace steadyrest::contour::online
