// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <utility>

#include <steadyrest/supervisor/settings.hpp>
#include <steadyrest/supervisor/supervisor.hpp>

// A cycle runs through update() in the order of README "The life of one Frame": time, interruption,
// mode, check, estimate, arbitrate, clamp. Each step takes the previous result as a value, so none
// can act on a frame that an earlier one found unfit. What survives an interruption is in
// supervisor_state.cpp.
namespace steadyrest::supervisor {
namespace {

namespace machine = kernel::machine;
namespace signal = kernel::signal;
using kernel::outcome::Reason;
using kernel::outcome::Result;
using kernel::override::Channel;
using kernel::override::OffsetEnvelope;
using machine::Mode;

// Age of the frame before the first reading: stale by any limit.
constexpr double kNeverReadS = 1e9;
/// Between two blocks a control may report idle for some cycles with the tool in the cut. Tests
/// AfterAnAbortTheOffsetFades, ADwellOrAShortIdleInTheCutKeepsTheOffset.
constexpr double kIdleLeavesCutS = 1.0;
/// A way back between two passes of a thread takes no longer.
constexpr double kBetweenPassesS = 10.0;

// No table, no override: the machine file need not name what the control lacks.
Result<std::optional<Channel>> channel(const Channel::Config& config) {
  if (config.table.ratio.empty()) {
    return std::nullopt;
  }
  auto made = Channel::make(config);
  if (!made) {
    return std::unexpected(std::move(made.error()));
  }
  return std::move(*made);
}

template <class Room, class Config>
Result<std::optional<Room>> room(bool on, const Config& config) {
  if (!on) {
    return std::nullopt;
  }
  auto made = Room::make(config);
  if (!made) {
    return std::unexpected(std::move(made.error()));
  }
  return std::move(*made);
}

/// It asks for no offset that the port cannot take.
Result<std::optional<contour::online::FeedGovernor>> contour_room(
    const machine::Machine& machine, bool feed_override, const kernel::port::Capability& port) {
  auto config = contour::online::FeedGovernor::Config::of(machine);
  if (port.path_offset && config.envelope.max_path_offset_mm > 0.0) {
    config.path_offset_delay_s = port.path_offset_delay_s;
    config.path_offset_acceleration_mm_s2 = port.path_offset_acceleration_mm_s2;
  } else {
    config.envelope.max_path_offset_mm = 0.0;
  }
  return room<contour::online::FeedGovernor>(machine.contour.enabled && feed_override, config);
}

// Errs towards "in the cut": an offset that moves while the tool cuts leaves a step in the part,
// one that stays too long costs nothing. A probe, a dwell or a spindle start may come at the
// bottom of a hole.
bool in_cut(signal::Motion motion, double idle_s, bool before) noexcept {
  switch (motion) {
    case signal::Motion::feed:
    case signal::Motion::thread:
    case signal::Motion::tap:
      return true;
    case signal::Motion::rapid:
    case signal::Motion::tool_change:
      return false;
    case signal::Motion::idle:
      return before && idle_s < kIdleLeavesCutS;
    case signal::Motion::probe:
    case signal::Motion::dwell:
    case signal::Motion::spindle_wait:
      return before;
  }
  return before;
}

/// The axes where the program has them. The offset against heat is in what the control reports, and
/// it is meant: the contour room would slow the feed down for it.
signal::Frame without_heat(signal::Frame frame, const signal::InForce& in_force) noexcept {
  if (in_force.written) {
    for (std::size_t i = 0; i < frame.axis.size(); ++i) {
      frame.axis[i].command_mm -= in_force.offset_mm[i];
      frame.axis[i].actual_mm -= in_force.offset_mm[i];
    }
  }
  return frame;
}

/// The frame as the rooms see it: all its times in good time. A frame of before has them already.
void in_good_time(signal::Frame& frame, double time_s, bool read_now) noexcept {
  // Edge stamps move with the frame's: their distance to the tick is what the estimators use.
  const double shift_s = read_now ? time_s - frame.time_s : 0.0;
  frame.time_s = time_s;
  for (auto& axis : frame.axis) {
    axis.edge_s += shift_s;
  }
}

}  // namespace

// Channels before rooms: the contour room works through the feed override, the chatter room through
// the spindle's, and a room without its channel is switched off, not refused.
Result<Supervisor> Supervisor::make(const machine::Machine& machine,
                                    const kernel::port::Capability& capability) {
  auto feed = channel(feed_config(machine, capability));
  if (!feed) {
    return std::unexpected(std::move(feed.error()));
  }
  auto spindle = channel(spindle_config(machine, capability));
  if (!spindle) {
    return std::unexpected(std::move(spindle.error()));
  }
  auto offset = OffsetEnvelope::make(offset_config(machine, capability.axis_offset));
  if (!offset) {
    return std::unexpected(std::move(offset.error()));
  }
  auto path_offset = OffsetEnvelope::make(path_offset_config(machine, capability.path_offset));
  if (!path_offset) {
    return std::unexpected(std::move(path_offset.error()));
  }
  auto clock = FrameClock::make({.usual_s = machine::layer_cycle_s(machine)});
  if (!clock) {
    return std::unexpected(std::move(clock.error()));
  }
  auto motion = MotionStage::make(machine);
  if (!motion) {
    return std::unexpected(std::move(motion.error()));
  }
  Supervisor supervisor(machine, capability, *clock, std::move(*motion), *offset, *path_offset);
  auto contour = contour_room(machine, feed->has_value(), capability);
  if (!contour) {
    return std::unexpected(std::move(contour.error()));
  }
  auto chatter = room<chatter::online::Modulator>(machine.chatter.enabled && *spindle, machine);
  if (!chatter) {
    return std::unexpected(std::move(chatter.error()));
  }
  auto thermal = room<thermal::online::OffsetGovernor>(machine.thermal.enabled, machine);
  if (!thermal) {
    return std::unexpected(std::move(thermal.error()));
  }
  supervisor.contour_ = std::move(*contour);
  supervisor.chatter_ = std::move(*chatter);
  supervisor.thermal_ = std::move(*thermal);
  supervisor.feed_ = std::move(*feed);
  supervisor.spindle_ = std::move(*spindle);
  return supervisor;
}

Supervisor::Supervisor(const machine::Machine& machine, const kernel::port::Capability& capability,
                       const FrameClock& clock, MotionStage motion, const OffsetEnvelope& offset,
                       const OffsetEnvelope& path_offset)
    : check_(machine.axes, machine.envelope.stale_after_s),
      clock_(clock),
      cycle_s_(machine::layer_cycle_s(machine)),
      stale_after_s_(machine.envelope.stale_after_s),
      watchdog_s_(machine::holds_s(machine)),
      motion_(std::move(motion)),
      offset_(offset),
      path_offset_(path_offset),
      offset_available_(capability.axis_offset),
      path_offset_available_(capability.path_offset) {
  state_.mode_wanted = machine.mode;
}

// The mode in force stays act until nothing of the layer is left on the machine.
bool Supervisor::leaving_act() const noexcept {
  return state_.mode_in_force == Mode::act && state_.mode_wanted != Mode::act;
}

void Supervisor::settle_mode() noexcept {
  if (state_.mode_wanted == state_.mode_in_force || (leaving_act() && !handed_back_)) {
    return;
  }
  begin_at_panel();  // mere advice was never on the machine
  state_.mode_in_force = state_.mode_wanted;
}

// Tool and thread follow fit frames only: a stale frame that shows a rapid does not prove that the
// tool is out of the cut now.
Reason Supervisor::inspect(const signal::Frame& frame, const FrameClock::Tick& tick) noexcept {
  const Reason fault = check_.fault(frame, tick.fault);
  if (fault == Reason::none) {
    state_.idle_s = frame.motion == signal::Motion::idle ? state_.idle_s + tick.step_s : 0.0;
    state_.tool_in_cut = in_cut(frame.motion, state_.idle_s, state_.tool_in_cut);
    const bool between = frame.motion == signal::Motion::rapid ||
                         frame.motion == signal::Motion::dwell ||
                         frame.motion == signal::Motion::spindle_wait;
    const bool threads = frame.motion == signal::Motion::thread;
    state_.between_s = between ? state_.between_s + tick.step_s : 0.0;
    state_.in_passes =
        threads || (state_.in_passes && between && state_.between_s < kBetweenPassesS);
    state_.in_thread = signal::is_locked(frame.motion);
  }
  return fault;
}

/// The answer runs as the modulator's constant speed, so that the feed follows.
void Supervisor::hear(const signal::Frame& frame, bool fit) noexcept {
  if (!listener_) {
    return;
  }
  estimates_.heard = listener_->update(frame, fit);
  if (!listener_->acts() || !chatter_) {
    estimates_.heard->request = {};
    return;
  }
  const signal::SpindleRequest& request = estimates_.heard->request;
  const bool wish = kernel::override::is_wish(request.ratio, request.reason);
  // Refused only if outside the modulator's range; then the present mean stays.
  [[maybe_unused]] const bool taken = chatter_->change(
      {.law = chatter::online::Law::constant, .mean_ratio = wish ? request.ratio : 1.0});
}

// The motion room first: the other rooms see what it writes into the frame. All rooms get the same
// values in force, those of the previous cycle.
void Supervisor::estimate(signal::Frame& frame, bool fit, Reason unfit) noexcept {
  motion_.update(frame, fit);
  if (std::isfinite(frame.time_s)) {
    last_frame_ = frame;
    last_frame_.path = last_frame_.original = {};  // their owner may not outlive the cycle
    last_frame_.vibration = {};
  }
  const signal::InForce come_down = in_force();
  seen_ = come_down;
  if (contour_) {
    estimates_.contour = contour_->update(without_heat(frame, come_down), come_down, unfit);
  }
  hear(frame, fit);
  if (chatter_) {
    estimates_.chatter = chatter_->update(frame, come_down);
  }
  if (thermal_) {
    estimates_.thermal = thermal_->update(frame, unfit, state_.tool_in_cut, come_down);
  }
}

std::optional<double> Supervisor::preview(double ratio,
                                          contour::online::FeedGovernor::Look look) const noexcept {
  return contour_ ? contour_->preview(without_heat(last_frame_, seen_), ratio, look) : std::nullopt;
}

// Requests from outside and from the rooms rank equally: the lowest feed wins, whoever asks.
Supervisor::Decisions Supervisor::arbitrate(const signal::Frame& frame, const Requests& requests,
                                            Reason unfit) noexcept {
  kernel::override::FeedArbiter feed;
  feed.add(requests.feed);
  if (estimates_.contour) {
    feed.add(estimates_.contour->request);
  }
  if (estimates_.chatter) {
    feed.add(estimates_.chatter->feed);
  }
  kernel::override::SpindleArbiter spindle;
  spindle.add(requests.spindle);
  if (estimates_.chatter) {
    spindle.add(estimates_.chatter->spindle);
  }
  kernel::override::OffsetArbiter path_offset;
  path_offset.add(requests.path_offset);
  if (estimates_.contour) {
    path_offset.add(estimates_.contour->path_offset);
  }
  kernel::override::OffsetArbiter offset;
  offset.add(requests.offset);
  if (estimates_.thermal) {
    offset.add(estimates_.thermal->request);
  }
  return {.feed = feed.decision(),
          .spindle = spindle.decision(),
          .offset = offset.decision(),
          .path_offset = path_offset.decision(),
          .unfit = unfit == Reason::none && leaving_act() ? Reason::observe_only : unfit,
          // The raw frame's motion too: an unfit frame that shows a tap holds at once, while only a
          // fit one ends the hold.
          // Whoever takes the machine back gets it between two passes.
          .hold = state_.in_thread || signal::is_locked(frame.motion) ||
                  (state_.in_passes && !leaving_act())};
}

// resume() and settle_mode() may put the words back to the panel, so the copy that a refused write
// returns to (before_) is taken after them.
signal::Command Supervisor::update(const signal::Frame& frame, const Requests& requests,
                                   bool read_now) noexcept {
  const double last_s = clock_.time_s();
  const bool ever_read = clock_.state().started;
  const FrameClock::Tick tick = clock_.update(frame.time_s);
  state_.silent_s += cycle_s_;
  if (read_now) {
    watch_source(frame.time_s);
  }
  resume(tick);
  settle_mode();
  before_ = written();
  signal::Frame known = frame;
  // Nothing was read: the last frame ages by good time, so that a lost link and a stopped source
  // become stale by the same rule.
  if (!read_now) {
    known.age_s = ever_read ? frame.age_s + (tick.time_s - last_s) : kNeverReadS;
  } else if (source_stalled()) {
    known.age_s = std::max(frame.age_s, state_.stalled_s);
  }
  const Reason unfit = inspect(known, tick);
  unfit_ = unfit;
  if (std::isfinite(frame.time_s)) {
    in_good_time(known, tick.time_s, read_now);
  }
  estimate(known, read_now && unfit == Reason::none, unfit);
  // Panel and motion come from the frame itself, not from the aged copy: the operator's switch is
  // believed even in an unfit frame.
  const Decisions decisions = arbitrate(frame, requests, unfit);
  signal::Command command = panel_command(frame);
  if (state_.mode_in_force != Mode::observe && !state_.interrupted) {
    clamp(frame, tick.step_s, decisions, command);
  } else {
    see_panel(frame);
    explain_silence(unfit, command);
  }
  command.write = state_.mode_in_force == Mode::act && !state_.interrupted;
  if (command.write) {
    state_.silent_s = 0.0;
    state_.delivered_s = tick.time_s;
    state_.delivered_stamped_s = tick.stamped_s;
  }
  // In every cycle, fit or not: the machine's watchdog watches the layer, not its input.
  command.heartbeat = ++state_.heartbeat;
  return command;
}

signal::Command Supervisor::update_without_frame(double time_s) noexcept {
  signal::Frame frame = last_frame_;
  frame.time_s = time_s;
  return update(frame, {}, false);
}

// A frame that could not be read, or a command that was not taken, interrupts: from here on the
// watchdog decides what is on the machine.
Result<signal::Command> Supervisor::cycle(kernel::port::Port& port,
                                          const Requests& requests) noexcept {
  auto frame = port.read();
  if (!frame) {
    state_.interrupted = true;
    state_.silent_s += cycle_s_;
    return std::unexpected(std::move(frame.error()));
  }
  const signal::Command command = update(*frame, requests);
  if (command.write) {
    if (auto written = port.write(command); !written) {
      not_delivered();
      return std::unexpected(std::move(written.error()));
    }
  }
  return command;
}

}  // namespace steadyrest::supervisor
