// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include <bench/hostile/dice.hpp>

#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/port/port.hpp>

namespace steadyrest::bench::hostile {

/// The simulated machine behind a port that spoils what it shows: any number in a frame becomes
/// NaN, infinite, huge, denormal or any bits; paths do not fit their index; vibration comes in
/// bursts; time jumps and stops; axes appear and vanish; panels show codes that do not exist; reads
/// and writes fail.
///
/// A fault is drawn for some hundred cycles at a time: a control that fails in one way for a while
/// finds more than single wild frames.
class WildPort final : public kernel::port::Port {
 public:
  /// What the layer was shown of one panel, where that was a sane value.
  struct Shown {
    double feed_ratio = 1.0;
    double spindle_ratio = 1.0;
    bool any = false;
  };

  WildPort(kernel::port::Port& inner, const kernel::port::Capability& can,
           const kernel::machine::Machine& machine, Dice& dice);

  [[nodiscard]] kernel::port::Capability capability() const noexcept override { return can_; }
  kernel::outcome::Result<kernel::signal::Frame> read() noexcept override;
  kernel::outcome::Result<void> write(const kernel::signal::Command& command) noexcept override;

  /// No faults from now on, and the tool out of the cut.
  void behave() noexcept { behaves_ = true; }

  [[nodiscard]] const Shown& shown() const noexcept { return shown_; }

  std::function<void()> before_read;  ///< a cycle begins
  std::function<void(const kernel::signal::Command&)> taken;

 private:
  void draw_act();
  void spoil_path(std::size_t segments);
  void spoil_time(kernel::signal::Frame& frame) noexcept;
  void spoil_panel(kernel::signal::Frame& frame) noexcept;
  void spoil_number(kernel::signal::Frame& frame) noexcept;
  void spoil_whole(kernel::signal::Frame& frame) noexcept;
  void show_path(kernel::signal::Frame& frame) noexcept;
  void show_vibration(kernel::signal::Frame& frame) noexcept;
  void note_shown(const kernel::signal::Frame& frame) noexcept;
  [[nodiscard]] double wild() noexcept;
  [[nodiscard]] bool strikes(std::uint64_t one_in) noexcept {
    return one_in > 0 && dice_.one_in(one_in);
  }

  kernel::port::Port& inner_;
  kernel::port::Capability can_;
  const kernel::machine::Machine& machine_;
  Dice& dice_;
  Shown shown_;
  std::vector<kernel::signal::PathSegment> wild_path_;
  std::vector<double> burst_;
  std::size_t cycles_left_ = 0;  ///< of the present act
  std::uint64_t fails_ = 0;      ///< one read or write in this many; 0: none
  std::uint64_t time_ = 0;       ///< one stamp in this many is wrong
  std::uint64_t panel_ = 0;
  std::uint64_t number_ = 0;
  std::uint64_t whole_ = 0;  ///< flags, counts and enumerations
  std::uint64_t bursts_ = 0;
  int path_ = 0;  ///< 0: the true one
  bool freezes_ = false;
  bool behaves_ = false;
  double set_s_ = 0.0;  ///< the control's clock was set by this much
  double last_stamp_s_ = 0.0;
  double feed_panel_ = 1.0;
  double spindle_panel_ = 1.0;
  kernel::signal::Frame frozen_;
};

}  // namespace steadyrest::bench::hostile
