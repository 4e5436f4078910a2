// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
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
#include <steadyrest/kernel/signal/request.hpp>
#include <steadyrest/supervisor/frame_check.hpp>
#include <steadyrest/supervisor/listening_stage.hpp>
#include <steadyrest/supervisor/motion_stage.hpp>
#include <steadyrest/thermal/online/offset_governor.hpp>

namespace steadyrest::supervisor {

/// One cycle of the layer: read → estimate → decide → arbitrate → clamp → write.
///
/// Modes. observe: the rooms estimate, the Command is the panel's own. advise: the Command is what
/// would be written. act: it is, and `Command::write` says so; only then. Leaving act hands back
/// first: neutral through the slew limit, offsets out once no tool is in the cut; until then the
/// mode in force stays act.
/// Thread cutting and tapping hold feed and spindle where they are; the operator still wins.
/// The tool counts as in the cut during feed, thread and tap, and as out of it during rapids and
/// tool changes; anything else, and unfit input, keeps what was last known.
/// All of update() is online code: bounded, noexcept, without allocation, lock or I/O.
class Supervisor {
 public:
  /// What is asked from outside of the rooms that the supervisor has itself.
  struct Requests {
    std::span<const kernel::signal::FeedRequest> feed;
    std::span<const kernel::signal::SpindleRequest> spindle;
    std::span<const kernel::signal::OffsetRequest> offset;
  };

  /// What the rooms that are switched on saw and chose in the last cycle; for logs and the page.
  struct Estimates {
    std::optional<contour::online::FeedGovernor::Output> contour;
    std::optional<chatter::online::Modulator::Output> chatter;
    std::optional<chatter::online::BetterSpeed::Output> heard;
    std::optional<thermal::online::OffsetGovernor::Output> thermal;
  };

  /// Without the rooms' estimates: those start anew after restore(). The heat in the machine does
  /// not, so the thermal room's stand in it.
  struct State {
    kernel::machine::Mode mode_in_force = kernel::machine::Mode::observe;
    kernel::machine::Mode mode_wanted = kernel::machine::Mode::observe;
    std::uint64_t heartbeat = 0;
    double time_s = 0.0;
    bool started = false;
    bool tool_in_cut = false;
    kernel::override::Channel::State feed;
    kernel::override::Channel::State spindle;
    kernel::override::OffsetEnvelope::State offset;
    thermal::online::OffsetGovernor::State thermal;
  };

  /// Refuses tables, envelopes and rooms' settings that are none. A room is switched on by the
  /// machine file: contour by `contour.enabled`, where there is a feed override to work through;
  /// chatter by `chatter.enabled`, where there is a spindle override; thermal by `thermal.enabled`.
  /// A machine without a table has no such override.
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
  /// A cycle in which nothing could be read: the last frame, aged. The caller gives the time.
  kernel::signal::Command update_without_frame(double time_s) noexcept;
  /// One whole cycle on a port: its refusal when it cannot be read or written.
  kernel::outcome::Result<kernel::signal::Command> cycle(kernel::port::Port& port,
                                                         const Requests& requests) noexcept;

  [[nodiscard]] const Estimates& estimates() const noexcept { return estimates_; }
  /// The last cycle's frame as the rooms decided by it: with the motion room's estimates, without
  /// its path.
  [[nodiscard]] const kernel::signal::Frame& frame() const noexcept { return last_frame_; }

  void set_mode(kernel::machine::Mode mode) noexcept { state_.mode_wanted = mode; }
  /// Another modulation of the spindle's speed from now on; false and nothing changes where the
  /// chatter room is off or a value is out of its range.
  [[nodiscard]] bool modulate(const chatter::online::Modulation& modulation) noexcept {
    return chatter_ && chatter_->change(modulation);
  }
  /// Hears the frames' vibration from now on. When it chatters, the better speed of the table
  /// becomes the modulator's constant mean: feed per tooth, slew and withdrawal are those of the
  /// modulator. False and nothing changes where the chatter room is off.
  [[nodiscard]] bool listen(const ListeningStage& listener) noexcept {
    if (chatter_) {
      listener_ = listener;
    }
    return chatter_.has_value();
  }
  /// The thermal room, for probe readings and the workpiece's zero; none where it is off.
  [[nodiscard]] thermal::online::OffsetGovernor* thermal() noexcept {
    return thermal_ ? &*thermal_ : nullptr;
  }
  [[nodiscard]] kernel::machine::Mode mode_in_force() const noexcept {
    return state_.mode_in_force;
  }
  [[nodiscard]] State state() const noexcept;
  void restore(const State& state) noexcept;

 private:
  struct Decisions {
    kernel::signal::FeedRequest feed;
    kernel::signal::SpindleRequest spindle;
    kernel::signal::OffsetRequest offset;
    kernel::outcome::Reason unfit = kernel::outcome::Reason::none;
    bool hold = false;
  };

  Supervisor(const kernel::machine::Machine& machine, const kernel::port::Capability& capability,
             MotionStage motion, const kernel::override::OffsetEnvelope& offset);
  kernel::signal::Command update(const kernel::signal::Frame& frame, const Requests& requests,
                                 bool read_now) noexcept;
  kernel::outcome::Reason inspect(const kernel::signal::Frame& frame) noexcept;
  void settle_mode() noexcept;
  void hear(const kernel::signal::Frame& frame, bool fit) noexcept;
  void estimate(kernel::signal::Frame& frame, bool fit, kernel::outcome::Reason unfit) noexcept;
  [[nodiscard]] Decisions arbitrate(const kernel::signal::Frame& frame, const Requests& requests,
                                    kernel::outcome::Reason unfit) noexcept;
  void clamp(const kernel::signal::Frame& frame, const Decisions& decisions,
             kernel::signal::Command& command) noexcept;
  [[nodiscard]] bool leaving_act() const noexcept;

  FrameCheck check_;
  MotionStage motion_;
  std::optional<contour::online::FeedGovernor> contour_;
  std::optional<chatter::online::Modulator> chatter_;
  std::optional<ListeningStage> listener_;
  std::optional<thermal::online::OffsetGovernor> thermal_;
  Estimates estimates_;
  std::optional<kernel::override::Channel> feed_;
  std::optional<kernel::override::Channel> spindle_;
  kernel::override::OffsetEnvelope offset_;
  bool offset_available_;
  bool handed_back_ = true;  ///< nothing of the layer stands on the machine
  State state_;              ///< the parts that are not a member's own
  kernel::signal::Frame last_frame_;
};

}  // namespace steadyrest::supervisor
