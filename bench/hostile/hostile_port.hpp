// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bench/hostile/dice.hpp>

#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/port/port.hpp>

namespace steadyrest::bench::hostile {

/// A control that does everything a control should not: its clock glitches, freezes, is set; its
/// frames are stale, not finite, out of range; its panel turns at any time; its link fails.
class HostilePort final : public kernel::port::Port {
 public:
  HostilePort(const kernel::machine::Machine& machine, const kernel::port::Capability& capability,
              double cycle_s, Dice& dice);

  /// Another act: what the machine does and which faults it has for the next cycles.
  void begin_act();
  /// No faults from now on, and this motion.
  void behave(kernel::signal::Motion motion);
  /// Real time passes; nobody reads.
  void pass(double real_s) { real_s_ += real_s; }

  /// Wrong stamps are so rare that two in a row do not occur, and the last one was true: a process
  /// restarted after a frozen clock cannot tell how long it was away.
  [[nodiscard]] bool keeps_time() const noexcept {
    return true_stamp_ && !set_ && stands_ == 0 && (glitch_ == 0 || glitch_ >= 200);
  }
  [[nodiscard]] bool keeps_time_well() const noexcept { return keeps_time() && glitch_ == 0; }

  [[nodiscard]] kernel::port::Capability capability() const noexcept override { return can_; }
  kernel::outcome::Result<kernel::signal::Frame> read() noexcept override;
  kernel::outcome::Result<void> write(const kernel::signal::Command& command) noexcept override;

  kernel::signal::Frame frame;  ///< the last one that was read
  kernel::signal::Command last;
  bool taken = false;        ///< `last` arrived in this cycle
  bool clean = false;        ///< no fault is in `frame`, its stamp is true
  bool unfit = false;        ///< certainly: the frame must not be acted on
  std::uint32_t outage = 0;  ///< remaining cycles of a dead link
  bool reads_fail = false;   ///< in an outage; else writes
  double shown_feed = 1.0;   ///< last panel shown in a frame with a known code
  double shown_spindle = 1.0;
  bool any_shown = false;

 private:
  double stamp() noexcept;
  void spoil() noexcept;
  void turn(kernel::signal::OverrideState& state, double& truth,
            const kernel::machine::OverrideTable& table) noexcept;

  const kernel::machine::Machine& machine_;
  kernel::port::Capability can_;
  double cycle_s_;
  Dice& dice_;
  double real_s_ = 0.0;
  double offset_s_ = 0.0;
  double last_stamp_s_ = 0.0;
  double feed_panel_ = 1.0;
  double spindle_panel_ = 1.0;
  std::uint64_t glitch_ = 0;  ///< one stamp in this many is wrong; 0: none
  std::uint64_t fault_ = 0;   ///< one frame in this many
  std::uint64_t turns_ = 0;   ///< the panel turns in one cycle in this many
  int lasting_ = 0;           ///< a fault that holds for the whole act
  std::uint32_t stands_ = 0;
  bool true_stamp_ = false;
  bool set_ = false;  ///< the next stamp is the first of a clock that was set
};

}  // namespace steadyrest::bench::hostile
