// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include <steadyrest/kernel/outcome/reason.hpp>
#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/kernel/signal/frame.hpp>
#include <steadyrest/kernel/signal/request.hpp>

/// The last step before any write: clamp, slew limit, the operator's panel, and the way back.
///
/// No switch turns it off. All of it runs in the cycle.
namespace steadyrest::kernel::override {

/// Envelope of one override ratio (feed or spindle).
///
/// Law, r = the layer's ratio, p = the panel's, w = the wish clamped to [min, max]:
///   target = w for a wish, p when neutral;  r moves to target at most by
///   fall·Δt downwards and rise·Δt upwards;  r ≤ p unless the layer may exceed the panel;  p = 0 ⇒
///   r = 0.
/// Neutral is transparent once r has reached p: from then on only the operator moves the ratio.
/// Unfit input makes the request neutral. While the panel's code is unknown, p is the last known
/// value. In a thread or tap (`hold`) r stays, whatever the wish and the input; p still limits it.
/// Δt is good time (supervisor/frame_clock); at most `max_step_s` of it counts, and none where it
/// is negative or not finite.
class RatioEnvelope {
 public:
  struct Config {
    double min_ratio = 0.0;   ///< 0 … max_ratio
    double max_ratio = 1.2;   ///< > 0
    double fall_1_s = 10.0;   ///< 1/s, > 0
    double rise_1_s = 2.0;    ///< 1/s, > 0
    double max_step_s = 0.1;  ///< s, > 0
    bool may_exceed_panel = false;
  };

  struct Input {
    double step_s = 0.0;                             ///< Δt, good time since the last cycle
    double ratio = 1.0;                              ///< what the rooms ask for
    outcome::Reason reason = outcome::Reason::none;  ///< and why
    signal::OverrideState panel{};
    outcome::Reason unfit = outcome::Reason::none;  ///< why this cycle's input must not be acted on
    bool hold = false;                              ///< thread, tap: the override must not move
  };

  struct Output {
    double ratio = 1.0;        ///< after clamp, slew and panel
    double panel_ratio = 1.0;  ///< the panel's, or the last known of it
    bool panel_known = false;  ///< the panel's value of this cycle is good
    bool hand_back = true;     ///< the ratio is the panel's own: no mask needed
    outcome::Reason reason = outcome::Reason::none;
  };

  struct State {
    double ratio = 1.0;
    double panel_ratio = 1.0;
    bool panel_seen = false;  ///< some panel value has been good
    bool at_panel = true;     ///< neutral has been reached
  };

  [[nodiscard]] static outcome::Result<RatioEnvelope> make(const Config& config);

  Output update(const Input& input) noexcept;
  /// Sets the panel value that update() uses from now on. Returns none, or why the value is unfit:
  /// then the last good one remains.
  outcome::Reason see_panel(const signal::OverrideState& panel) noexcept;

  /// The panel is in force, whatever update() wanted: the next step starts there.
  void start_at_panel() noexcept { state_.ratio = state_.panel_ratio; }
  /// With the mask on, the panel is not in force, and the word may walk slower than the slew: the
  /// ratio must not run ahead of the word, or it would later rise faster than `rise`.
  void wait_within(double low, double high) noexcept {
    state_.ratio = std::clamp(state_.ratio, low, high);
    state_.at_panel = false;
  }
  /// Starts over, as when the layer takes over.
  void reset() noexcept { state_ = {}; }
  [[nodiscard]] const State& state() const noexcept { return state_; }
  /// Rejects impossible ratios (not finite, negative, far too large): the envelope starts over.
  void restore(const State& state) noexcept;

 private:
  explicit RatioEnvelope(const Config& config) noexcept : config_(config) {}

  struct Target {
    double ratio = 1.0;
    outcome::Reason unfit = outcome::Reason::none;
    bool neutral = false;
    bool clamped = false;
    bool panel_limits = false;
  };

  [[nodiscard]] Target target(const Input& input, outcome::Reason unfit) const noexcept;
  [[nodiscard]] outcome::Reason explain(const Target& target, outcome::Reason asked) const noexcept;

  Config config_;
  State state_;
};

/// The largest offset limit of a machine file.
inline constexpr double kMostOffset_mm = 10.0;

/// Envelope of the axis offsets.
///
/// Law, for each axis: under a wish the offset moves to clamp(wish, ±max) by at most min(slew, the
/// request's slope)·Δt; a NaN or negative slope counts as 0. Without a wish, or with unfit input,
/// it freezes; once no tool is in the cut it ramps to 0 at the same slew. An axis with max = 0
/// never gets an offset.
/// With `fade_mm_s` it does not freeze but ramps to 0 at that rate, in the cut too: an offset that
/// cancels the contour error turns with the direction of travel, so a frozen one would soon double
/// the error, while without it the part has the error it would have had anyway.
/// `beside_mm`, the offsets that others hold on the same axes, comes first: the sum stays within
/// ±max, as long as they move no faster than `slew_mm_s`.
/// An offset beyond what is allowed (the limit was lowered, or what is beside it grew) returns to
/// the allowed by the slew, whatever slope is asked for, frozen or not.
class OffsetEnvelope {
 public:
  struct Config {
    signal::AxisValues max_mm{};  ///< ≥ 0; 0 = this axis takes no offset
    double slew_mm_s = 0.05;      ///< mm/s, > 0
    double fade_mm_s = 0.0;       ///< mm/s, ≥ 0; 0 = freezes while a tool is in the cut
    double max_step_s = 0.1;      ///< s, > 0
  };

  struct Input {
    double step_s = 0.0;  ///< Δt, good time since the last cycle
    signal::OffsetRequest request{};
    signal::AxisValues beside_mm{};
    outcome::Reason unfit = outcome::Reason::none;
    bool tool_in_cut = true;  ///< by the machine's own state; the rooms report theirs separately
  };

  struct Output {
    signal::AxisValues offset_mm{};
    outcome::Reason reason = outcome::Reason::none;
    bool at_zero = true;
  };

  struct State {
    signal::AxisValues offset_mm{};
  };

  [[nodiscard]] static outcome::Result<OffsetEnvelope> make(const Config& config);

  Output update(const Input& input) noexcept;

  void reset() noexcept { state_ = {}; }
  [[nodiscard]] const State& state() const noexcept { return state_; }
  /// Of an envelope that was in force until now, perhaps with wider limits: nothing jumps. False,
  /// and at 0, for offsets that no limit allows: not finite, or beyond kMostOffset_mm and its own.
  bool restore(const State& state) noexcept;

 private:
  explicit OffsetEnvelope(const Config& config) noexcept : config_(config) {}
  /// False when the slew, not the slope that was asked for, kept an axis from its target.
  bool approach(const signal::AxisValues& target_mm, const signal::AxisValues& slope_mm_s,
                const signal::AxisValues& beside_mm, double step_s) noexcept;
  [[nodiscard]] double within(std::size_t axis, double offset_mm, double beside_mm) const noexcept;

  Config config_;
  State state_;
};

}  // namespace steadyrest::kernel::override
