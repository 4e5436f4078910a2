// SPDX-License-Identifier: Apache-2.0
#include <steadyrest/supervisor/supervisor.hpp>

// The last step before the port: requests through the envelopes into the command.
namespace steadyrest::supervisor {
namespace {

namespace signal = kernel::signal;
using kernel::outcome::Reason;
using kernel::override::Channel;

// Held in a thread: the wish becomes neutral and the envelope holds, since a change of feed or
// spindle between two passes would cut a second thread beside the first.
template <class Request>
kernel::override::RatioEnvelope::Input channel_input(double step_s, const Request& request,
                                                     Reason unfit, bool hold,
                                                     const signal::OverrideState& panel) noexcept {
  return {.step_s = step_s,
          .ratio = hold ? 1.0 : request.ratio,
          .reason = hold ? Reason::withdrawn_thread : request.reason,
          .panel = panel,
          .unfit = unfit,
          .hold = hold};
}

// A panel that reads NaN or below 0 is shown as 100 %; the fault itself is the channel's to
// report.
double shown(const signal::OverrideState& panel) noexcept {
  return kernel::override::fault_of(panel.panel_ratio) == Reason::none ? panel.panel_ratio : 1.0;
}

/// The reason of an override that the machine does not have: a wish that nobody can carry out must
/// not look like one in force.
template <class Request>
Reason without_channel(const Request& request, Reason unfit) noexcept {
  if (unfit != Reason::none) {
    return unfit;
  }
  const bool wish = kernel::override::is_wish(request.ratio, request.reason);
  return wish ? Reason::port_cannot_write : request.reason;
}

/// The fields of one override in the command.
struct Place {
  double& ratio;
  std::uint32_t& code;
  bool& masks_panel;
  Reason& reason;
};

/// One override through its channel into the command; true when it is the panel's again. Without a
/// channel there is a reason alone.
template <class Request>
bool put(std::optional<Channel>& channel, const kernel::override::RatioEnvelope::Input& input,
         const Request& wanted, const Place& place) noexcept {
  if (!channel) {
    place.reason = without_channel(wanted, input.unfit);
    return true;
  }
  const auto out = channel->update(input);
  place.ratio = out.ratio;
  place.code = out.code;
  place.masks_panel = out.masks_panel;
  place.reason = out.reason;
  return out.handed_back;
}

// A port that takes no offsets has a limit of 0 for them; the reason says why nothing moves.
Reason offset_reason(Reason shown, const signal::OffsetRequest& wanted, bool available) noexcept {
  return !available && kernel::override::is_wish(wanted.reason) ? Reason::port_cannot_write : shown;
}

}  // namespace

/// What holds without the layer: the panel's own value.
signal::Command Supervisor::panel_command(const signal::Frame& frame) noexcept {
  return {.feed_ratio = shown(frame.feed),
          .feed_code = frame.feed.panel_code,
          .spindle_ratio = shown(frame.spindle),
          .spindle_code = frame.spindle.panel_code,
          .offset_mm = {},
          .feed_reason = Reason::observe_only,
          .spindle_reason = Reason::observe_only,
          .offset_reason = Reason::observe_only,
          .path_offset_reason = Reason::observe_only};
}

/// Why nothing is written in a mode that would.
void Supervisor::explain_silence(Reason unfit, signal::Command& command) const noexcept {
  if (state_.mode_in_force != kernel::machine::Mode::observe) {
    const Reason why = unfit != Reason::none ? unfit : Reason::heartbeat_lost;
    command.feed_reason = command.spindle_reason = why;
    command.offset_reason = command.path_offset_reason = why;
  }
}

// The last step before the port. Both overrides and both offsets run in every cycle, also when one
// is unfit: each slews back on its own.
void Supervisor::clamp(const signal::Frame& frame, double step_s, const Decisions& decisions,
                       signal::Command& command) noexcept {
  // Advice goes on in the time that the layer's course would take.
  const bool advises = state_.mode_in_force == kernel::machine::Mode::advise;
  const double pace = advises && estimates_.contour ? estimates_.contour->pace : 1.0;
  const bool feed_back =
      put(feed_,
          channel_input(pace * step_s, decisions.feed, decisions.unfit, decisions.hold, frame.feed),
          decisions.feed,
          {command.feed_ratio, command.feed_code, command.feed_masks_panel, command.feed_reason});
  const bool spindle_back =
      put(spindle_,
          channel_input(step_s, decisions.spindle, decisions.unfit, decisions.hold, frame.spindle),
          decisions.spindle,
          {command.spindle_ratio, command.spindle_code, command.spindle_masks_panel,
           command.spindle_reason});
  handed_back_ = feed_back && spindle_back;
  const auto offset = offset_.update({.step_s = step_s,
                                      .request = decisions.offset,
                                      .unfit = decisions.unfit,
                                      .tool_in_cut = state_.tool_in_cut});
  command.offset_mm = offset.offset_mm;
  command.offset_reason = offset_reason(offset.reason, decisions.offset, offset_available_);
  // Heat first: the contour room gets what its limit leaves beside that.
  const auto path = path_offset_.update({.step_s = step_s,
                                         .request = decisions.path_offset,
                                         .beside_mm = offset.offset_mm,
                                         .unfit = decisions.unfit,
                                         .tool_in_cut = state_.tool_in_cut});
  command.path_offset_mm = path.offset_mm;
  command.path_offset_reason =
      offset_reason(path.reason, decisions.path_offset, path_offset_available_);
  handed_back_ = handed_back_ && offset.at_zero && path.at_zero;
}

}  // namespace steadyrest::supervisor
