// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/kernel/signal/command.hpp>
#include <steadyrest/kernel/signal/frame.hpp>

namespace steadyrest::kernel::port {

/// What a machine can do with a written override word.
struct Capability {
  bool feed_override = false;
  bool spindle_override = false;
  bool axis_offset = false;
  bool path_offset = false;          ///< takes a second offset that may change in every cycle
  double path_offset_delay_s = 0.0;  ///< from its write to the command that has it, less one cycle
  double path_offset_acceleration_mm_s2 = 0.0;  ///< limit of such an offset's; 0: none
  bool latched_word = true;  ///< an override word of several bits takes effect as a whole; else it
                             ///< must walk step by step

  friend bool operator==(const Capability&, const Capability&) = default;
};

/// A machine: the simulated one or a real control behind an adapter. Nothing above depends on
/// which.
class Port {
 public:
  Port() = default;
  Port(const Port&) = delete;
  Port& operator=(const Port&) = delete;
  virtual ~Port() = default;

  [[nodiscard]] virtual Capability capability() const noexcept = 0;
  /// The inputs of the next cycle. A refusal of kind `unavailable` means that the link is lost.
  virtual outcome::Result<signal::Frame> read() noexcept = 0;
  /// Hands over one cycle's command. Must not be called with command.write == false.
  virtual outcome::Result<void> write(const signal::Command& command) noexcept = 0;
};

}  // namespace steadyrest::kernel::port
