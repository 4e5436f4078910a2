// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/outcome/reason.hpp>
#include <steadyrest/kernel/signal/path.hpp>
#include <steadyrest/supervisor/supervisor.hpp>

namespace steadyrest::live {

/// One axis as the layer sees it; mm and s, or rad and s.
struct LiveAxis {
  double position_au = 0.0;  ///< by the encoder
  double following_au = 0.0;
  double velocity_au_s = 0.0;
  double velocity_bound_au_s = 0.0;  ///< of the estimate; infinite: there is none
  double acceleration_au_s2 = 0.0;
  double acceleration_bound_au_s2 = 0.0;
  double displacement_mm = 0.0;  ///< by heat, forecast
  double displacement_sd_mm = 0.0;
};

/// What the layer hears.
struct LiveChatter {
  bool listens = false;
  bool chatters = false;  ///< the tool is in the cut, and the cut chatters
  chatter::online::Detector::Kind kind = chatter::online::Detector::Kind::none;
  double frequency_hz = 0.0;  ///< of the strongest line that is not forced; 0: none
  double level = 0.0;         ///< the detector's energy ratio, 0 … 1; 0: not in a cut
  double threshold = 0.0;     ///< of it
  double before = 0.0;        ///< level before the layer stepped in; 0: it did not
  double better_ratio = 1.0;  ///< of the spindle, by the planner's table; 1: none was asked for
  std::uint64_t events = 0;   ///< how often chatter began, since the start
  double chatter_s = 0.0;     ///< for how long it chattered in all
  /// The strongest line that the teeth do not explain, and the order nearest to it (0: it can be
  /// none); frequency 0: out of the cut, or too weak to be told.
  chatter::online::OrderGate::Output line;
  bool forced = false;       ///< the line is that order
  double mode_hz = 0.0;      ///< the process's mode nearest to the line; 0: none is known
  double confidence = 0.0;   ///< that this chatter is not forced, 0 … 1; 0: there is none
  double speed_rev_s = 0.0;  ///< of the spindle, as its orders show it; 0: they do not
  double speed_sd = 0.0;     ///< the standard deviation of that, relative
  bool clips = false;        ///< the sensor's largest values are cut off
};

/// What a cycle leaves for those who look.
struct LiveStatus {
  std::uint64_t cycles = 0;
  std::uint64_t overruns = 0;
  double time_s = 0.0;  ///< of the last frame
  kernel::machine::Mode mode_wanted = kernel::machine::Mode::observe;
  kernel::machine::Mode mode_in_force = kernel::machine::Mode::observe;
  kernel::signal::Motion motion = kernel::signal::Motion::idle;
  std::uint32_t program_line = 0;
  bool error_known = false;
  double contour_error_mm = 0.0;  ///< by the layer's own estimate
  double contour_limit_mm = 0.0;  ///< of the machine file
  double feed_asked_ratio = 1.0;  ///< by the contour room (FeedGovernor's advised_ratio)
  double feed_ratio = 1.0;        ///< what the layer lets through; the panel's in observe
  double feed_panel_ratio = 1.0;
  double feed_effective_ratio = 1.0;  ///< as the control reports it
  double spindle_ratio = 1.0;
  double spindle_effective_ratio = 1.0;
  double path_speed_mm_s = 0.0;
  double spindle_rev_s = 0.0;
  double spindle_programmed_rev_s = 0.0;
  double predicted_error_mm = 0.0;  ///< the largest ahead with the step that was chosen
  double predicted_at_mm = 0.0;     ///< path length where
  double limit_used_mm = 0.0;       ///< by the last decision: the limit less margin and reserve
  bool path_known = false;
  bool chatter_on = false;  ///< the chatter room is on
  bool modulates = false;
  std::optional<chatter::online::Modulation> modulation;  ///< in force; none: the room is off
  double modulation_goal_ratio = 1.0;  ///< of the modulator, before drive and steps
  double modulation_phase = 0.0;       ///< in periods, [0, 1)
  double feed_per_tooth_ratio = 1.0;
  LiveChatter chatter;
  bool heat_on = false;  ///< the thermal room is on
  /// The readings do not fit the thermal model: it corrects nothing until they do again.
  bool heat_switched_off = false;
  thermal::online::OffsetGovernor::Fed heat_fed;
  std::uint8_t axis_count = 0;
  std::array<LiveAxis, kernel::signal::kMaxAxes> axis{};
  kernel::signal::AxisValues offset_mm{};
  kernel::signal::AxisValues path_offset_mm{};
  /// Feed, spindle, offset against heat, offset of the path.
  std::array<kernel::outcome::Reason, 4> reasons{};
  bool port_fault = false;
  std::array<char, 192> port_words{};  ///< of the last fault, ends with 0
};

/// What a cycle of the layer leaves, without what the loop itself counts.
void look_at(const supervisor::Supervisor& layer, LiveStatus& into) noexcept;

}  // namespace steadyrest::live
