// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>

#include <steadyrest/adapters/linuxcnc/control_state.hpp>
#include <steadyrest/kernel/outcome/result.hpp>

namespace steadyrest::adapters::linuxcnc {

/// The process that reads LinuxCNC's status channel (control_state.py). Belongs to one thread,
/// which is not the cycle's.
class ControlPeer {
 public:
  struct Config {
    std::string python = "/usr/bin/python3";  ///< the one that has LinuxCNC's modules
    // Without the initializer a designated one that leaves it out is a compiler's warning.
    // NOLINTNEXTLINE(readability-redundant-member-init)
    std::string script = {};  ///< its text; empty: control_state.py
  };

  /// Refused (unavailable): the process cannot be started.
  [[nodiscard]] static kernel::outcome::Result<std::unique_ptr<ControlPeer>> start(
      const Config& config);

  ControlPeer(const ControlPeer&) = delete;
  ControlPeer& operator=(const ControlPeer&) = delete;
  /// Ends the process.
  ~ControlPeer();

  /// The newest state within the time; nothing when none came. Refused: what it could not do, and
  /// that it has ended.
  [[nodiscard]] kernel::outcome::Result<std::optional<ControlState>> next(double timeout_s);

 private:
  ControlPeer(int process, int pipe) noexcept : process_(process), pipe_(pipe) {}

  int process_;
  int pipe_;
  std::string text_;  ///< not yet a whole line
};

}  // namespace steadyrest::adapters::linuxcnc
