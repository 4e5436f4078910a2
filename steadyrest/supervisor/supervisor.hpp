// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>

#include <steadyrest/chatter/online/modulator.hpp>
#include <steadyrest/contour/online/feed_governor.hpp>
#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/kernel/override/arbiter.hpp>
#include <steadyrest/kernel/override/channel.hpp>
#include <steadyrest/kernel/override/envelope.hpp>
#include <steadyrest/kernel/port/port.hpp>
#include <steadyrest/kernel/signal/command.hpp>
#include <steadyrest/kernel/signal/frame.hpp>
#include <steadyrest/kernel/signal/in_force.hpp>
#include <steadyrest/kernel/signal/request.hpp>
#include <steadyrest/supervisor/frame_check.hpp>
#include <steadyrest/supervisor/frame_clock.hpp>
#include <steadyrest/supervisor/listening_stage.hpp>
#include <steadyrest/supervisor/motion_stage.hpp>
#include <steadyrest/supervisor/succession.hpp>
#include <steadyrest/thermal/online/offset_governor.hpp>

namespace steadyrest::supervisor {

/// One cycle of the layer: read → estimate → decide → arbitrate → clamp → write.
///
/// Modes. observe: the rooms estimate, the Command is the panel's own. advise: the Command is what
/// would be written. act: the Command is written, and only then is `Command::write` set. Leaving
/// act hands back first: neutral through the slew limit, path offsets out at once, thermal ones
/// once no tool is in the cut; until then the mode in force stays act.
/// Time. FrameClock turns the frames' stamps into good time, and rooms, envelopes and words get
/// nothing else. A stamp in doubt gives no credit to any slew and settles no word.
/// What the envelopes let pass comes down to the rooms with the next frame (InForce); no room keeps
/// a copy of it.
/// Thread cutting and tapping hold feed and spindle where they are, from the first frame that shows
/// them to the first fit one that shows something else, whatever the mode and the input; the
/// operator still wins. Up to 10 s of rapids, dwells and waits for the spindle after a pass of a
/// thread belong to it, unless act is left: all passes must be cut at one speed.
/// The tool counts as in the cut during feed, thread and tap, and as out of it during rapids and
/// tool changes and after a second of idle (program end, abort); anything else, and unfit input,
/// keeps the last known state.
/// Only what was written counts: mere advice is dropped on the way to act, and a cycle that the
/// port did not take is taken back. After an interruption (restore(), a port that could not read or
/// write) of more than machine::holds_s() the machine's watchdog has dropped everything, so the
/// layer begins at the panel and at offset 0; until a good stamp tells how long it was, nothing is
/// written.
/// All of update() runs in the cycle: bounded, noexcept, without allocation, lock or I/O.
class Supervisor {
 public:
  /// Requests from outside, in addition to the supervisor's own rooms.
  struct Requests {
    std::span<const kernel::signal::FeedRequest> feed;
    std::span<const kernel::signal::SpindleRequest> spindle;
    std::span<const kernel::signal::OffsetRequest> offset;
    /// Against the contour error. Designated initialisers may leave it out.
    // NOLINTNEXTLINE(readability-redundant-member-init)
    std::span<const kernel::signal::OffsetRequest> path_offset = {};
  };

  /// What the active rooms saw and chose in the last cycle; for logs and the page.
  struct Estimates {
    std::optional<contour::online::FeedGovernor::Output> contour;
    std::optional<chatter::online::Modulator::Output> chatter;
    std::optional<chatter::online::BetterSpeed::Output> heard;
    std::optional<thermal::online::OffsetGovernor::Output> thermal;
  };

  /// Without the rooms' estimates: those start over after restore(). The machine keeps its heat, so
  /// the thermal room's state is included.
  struct State {
    kernel::machine::Mode mode_in_force = kernel::machine::Mode::observe;
    kernel::machine::Mode mode_wanted = kernel::machine::Mode::observe;
    std::uint64_t heartbeat = 0;
    FrameClock::State clock;
    double delivered_s = 0.0;          ///< good time of the last written cycle
    double delivered_stamped_s = 0.0;  ///< the same by its stamp, which may have been in doubt
    /// Of the cycles since the last written one; infinite: none yet.
    double silent_s = std::numeric_limits<double>::infinity();
    double stamp_s = std::numeric_limits<double>::quiet_NaN();  ///< of the last frame read
    double stalled_s = 0.0;  ///< of the cycles that have shown the same stamp again
    double idle_s = 0.0;     ///< good time since the control became idle
    bool tool_in_cut = false;
    bool in_thread = false;    ///< by the last fit frame
    bool in_passes = false;    ///< likewise, in a thread or on the way back between two passes
    double between_s = 0.0;    ///< good time of that way so far
    bool interrupted = false;  ///< what is on the machine is unknown until the time is known
    double silence_began_s = std::numeric_limits<double>::quiet_NaN();  ///< NaN: not restored
    bool clock_set = false;                                             ///< since then
    kernel::override::Channel::State feed;
    kernel::override::Channel::State spindle;
    kernel::override::OffsetEnvelope::State offset;
    kernel::override::OffsetEnvelope::State path_offset;
    thermal::online::OffsetGovernor::State thermal;
  };

  /// Refuses invalid tables, envelopes and room settings. The machine file switches rooms on:
  /// contour by `contour.enabled`, where there is a feed override to work through; chatter by
  /// `chatter.enabled`, where there is a spindle override; thermal by `thermal.enabled`. A machine
  /// without a table has no such override.
  [[nodiscard]] static kernel::outcome::Result<Supervisor> make(
      const kernel::machine::Machine& machine, const kernel::port::Capability& capability);

  /// One cycle without the port.
  kernel::signal::Command update(const kernel::signal::Frame& frame,
                                 const Requests& requests) noexcept {
    return update(frame, requests, true);
  }
  kernel::signal::Command update(const kernel::signal::Frame& frame) noexcept {
    return update(frame, {});
  }
  /// The last command did not reach the machine: the previous one still applies there.
  void not_delivered() noexcept;
  /// The machine has dropped what was written: the layer itself stood still for longer than it
  /// holds that. The layer begins at the panel with the next good stamp. Before or while it reads.
  void was_dropped() noexcept;
  /// A cycle without a reading: the last frame, aged. The caller gives the time.
  kernel::signal::Command update_without_frame(double time_s) noexcept;
  /// One whole cycle on a port; returns its refusal when it cannot read or write.
  kernel::outcome::Result<kernel::signal::Command> cycle(kernel::port::Port& port,
                                                         const Requests& requests) noexcept;

  [[nodiscard]] const Estimates& estimates() const noexcept { return estimates_; }
  /// The last cycle's frame as the rooms saw it: with the motion room's estimates, without its
  /// path.
  [[nodiscard]] const kernel::signal::Frame& frame() const noexcept { return last_frame_; }

  /// The feed override's steps that preview() may be asked for; empty: the contour room is off.
  [[nodiscard]] std::span<const double> feed_steps() const noexcept {
    return contour_ ? contour_->steps() : std::span<const double>();
  }
  /// preview() has a path to look at.
  [[nodiscard]] bool previews() const noexcept { return contour_ && contour_->previews(); }
  /// What a step would give from the last cycle on (FeedGovernor::preview): one forecast, which
  /// changes nothing.
  [[nodiscard]] std::optional<double> preview(
      double ratio, contour::online::FeedGovernor::Look look) const noexcept;

  /// Why the last cycle's input was not acted on; none: it was.
  [[nodiscard]] kernel::outcome::Reason unfit() const noexcept { return unfit_; }
  /// What became of the requests so far: the rooms get it with the next frame.
  [[nodiscard]] kernel::signal::InForce in_force() const noexcept;

  void set_mode(kernel::machine::Mode mode) noexcept { state_.mode_wanted = mode; }
  /// Changes the modulation of the spindle's speed; false, with nothing changed, where the chatter
  /// room is off or a value is out of range.
  [[nodiscard]] bool modulate(const chatter::online::Modulation& modulation) noexcept {
    return chatter_ && chatter_->change(modulation);
  }
  /// The modulation in force: the machine file's until modulate(). Null where the room is off.
  [[nodiscard]] const chatter::online::Modulation* modulation() const noexcept {
    return chatter_ ? &chatter_->state().modulation : nullptr;
  }
  /// Listens to the frames' vibration from now on. When it chatters, the table's better speed
  /// becomes the modulator's constant mean: feed per tooth, slew and withdrawal are the
  /// modulator's. One that does not act requests nothing. False, with nothing
  /// changed, for one that acts where the chatter room is off.
  [[nodiscard]] bool listen(const ListeningStage& listener) noexcept {
    if (listener.acts() && !chatter_) {
      return false;
    }
    listener_ = listener;
    return true;
  }
  /// It listens and acts, and so chooses the modulator's speed itself.
  [[nodiscard]] bool chooses_speed() const noexcept { return listener_ && listener_->acts(); }
  /// The thermal room, for probe readings and the workpiece's zero; null where it is off.
  [[nodiscard]] thermal::online::OffsetGovernor* thermal() noexcept {
    return thermal_ ? &*thermal_ : nullptr;
  }
  [[nodiscard]] const thermal::online::OffsetGovernor* thermal() const noexcept {
    return thermal_ ? &*thermal_ : nullptr;
  }
  [[nodiscard]] kernel::machine::Mode mode_in_force() const noexcept {
    return state_.mode_in_force;
  }
  [[nodiscard]] State state() const noexcept;
  void restore(const State& state) noexcept;
  /// Between two cycles, for a layer made from a machine file that fits() `before`'s: mode, clock,
  /// words and offsets go on where they are, without an interruption; what is beyond a new limit
  /// goes there by the slew. Swaps rooms with `before`, which must not run any more. In the cycle:
  /// no allocation.
  void take_over(Supervisor& before, const Kept& kept) noexcept;

 private:
  struct Decisions {
    kernel::signal::FeedRequest feed;
    kernel::signal::SpindleRequest spindle;
    kernel::signal::OffsetRequest offset;
    kernel::signal::OffsetRequest path_offset;
    kernel::outcome::Reason unfit = kernel::outcome::Reason::none;
    bool hold = false;
  };

  Supervisor(const kernel::machine::Machine& machine, const kernel::port::Capability& capability,
             const FrameClock& clock, MotionStage motion,
             const kernel::override::OffsetEnvelope& offset,
             const kernel::override::OffsetEnvelope& path_offset);
  kernel::signal::Command update(const kernel::signal::Frame& frame, const Requests& requests,
                                 bool read_now) noexcept;
  kernel::outcome::Reason inspect(const kernel::signal::Frame& frame,
                                  const FrameClock::Tick& tick) noexcept;
  void settle_mode() noexcept;
  void watch_source(double stamp_s) noexcept;
  [[nodiscard]] bool stamps_say_short(const FrameClock::Tick& tick) const noexcept;
  [[nodiscard]] bool is_dropped(const FrameClock::Tick& tick) const noexcept;
  [[nodiscard]] bool source_stalled() const noexcept { return state_.stalled_s > stale_after_s_; }
  void begin_at_panel() noexcept;
  void resume(const FrameClock::Tick& tick) noexcept;
  void hear(const kernel::signal::Frame& frame, bool fit) noexcept;
  void estimate(kernel::signal::Frame& frame, bool fit, kernel::outcome::Reason unfit) noexcept;
  [[nodiscard]] Decisions arbitrate(const kernel::signal::Frame& frame, const Requests& requests,
                                    kernel::outcome::Reason unfit) noexcept;
  /// What holds without the layer: the panel's own value.
  [[nodiscard]] static kernel::signal::Command panel_command(
      const kernel::signal::Frame& frame) noexcept;
  void explain_silence(kernel::outcome::Reason unfit,
                       kernel::signal::Command& command) const noexcept;
  void clamp(const kernel::signal::Frame& frame, double step_s, const Decisions& decisions,
             kernel::signal::Command& command) noexcept;
  [[nodiscard]] bool leaving_act() const noexcept;

  struct Written {
    kernel::override::Channel::State feed;
    kernel::override::Channel::State spindle;
    kernel::override::OffsetEnvelope::State offset;
    kernel::override::OffsetEnvelope::State path_offset;
    double delivered_s = 0.0;
    double delivered_stamped_s = 0.0;
    double silent_s = 0.0;
  };
  [[nodiscard]] Written written() const noexcept;
  void put_back(const Written& written) noexcept;
  void see_panel(const kernel::signal::Frame& frame) noexcept;

  FrameCheck check_;
  FrameClock clock_;
  double cycle_s_;
  double stale_after_s_;
  double watchdog_s_;  ///< the machine drops whatever no heartbeat renews for this long
  MotionStage motion_;
  std::optional<contour::online::FeedGovernor> contour_;
  std::optional<chatter::online::Modulator> chatter_;
  std::optional<ListeningStage> listener_;
  std::optional<thermal::online::OffsetGovernor> thermal_;
  Estimates estimates_;
  std::optional<kernel::override::Channel> feed_;
  std::optional<kernel::override::Channel> spindle_;
  kernel::override::OffsetEnvelope offset_;
  kernel::override::OffsetEnvelope path_offset_;
  bool offset_available_;
  bool path_offset_available_;
  bool handed_back_ = true;  ///< nothing of the layer is on the machine
  Written before_;           ///< the last cycle
  State state_;              ///< the parts that are not a member's own
  kernel::signal::Frame last_frame_;
  kernel::signal::InForce seen_;  ///< with it by the rooms
  kernel::outcome::Reason unfit_ = kernel::outcome::Reason::none;
};

}  // namespace steadyrest::supervisor
