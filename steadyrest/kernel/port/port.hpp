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
  bool latched_word = true;  ///< an override word of several bits takes effect as a whole; else
                             ///< neighbours must be walked
};

/// A machine: the simulated one or a real control behind an adapter. Changing it changes nothing
/// above.
class Port {
 public:
  Port() = default;
  Port(const Port&) = delete;
  Port& operator=(const Port&) = delete;
  virtual ~Port() = default;

  [[nodiscard]] virtual Capability capability() const noexcept = 0;
  /// The inputs of the next cycle. A refusal of kind `unavailable` says that the link is lost.
  virtual outcome::Result<signal::Frame> read() noexcept = 0;
  /// Hands one cycle's command over. Must not be called with command.write == false.
  virtual outcome::Result<void> write(const signal::Command& command) noexcept = 0;
};

}  // namespace steadyrest::kernel::port
