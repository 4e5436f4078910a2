// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>

#include <sys/types.h>

#include <steadyrest/kernel/outcome/result.hpp>

namespace steadyrest::adapters::opcua {

/// The bridge as a child process, with a pair of sockets between: it has its end as descriptor 3.
/// It ends when this ends.
class BridgeProcess {
 public:
  struct Config {
    std::string node = "node";  ///< found by PATH
    std::string script;         ///< opcua-bridge.cjs
  };

  static kernel::outcome::Result<std::unique_ptr<BridgeProcess>> start(const Config& config);
  BridgeProcess(const BridgeProcess&) = delete;
  BridgeProcess& operator=(const BridgeProcess&) = delete;
  ~BridgeProcess();

  /// False: it has ended, or takes nothing more.
  [[nodiscard]] bool send(const std::string& lines);
  /// One line, without its end. None within the time, or it has ended.
  [[nodiscard]] std::optional<std::string> next_line(double timeout_s);
  [[nodiscard]] bool ended() const noexcept { return ended_; }
  [[nodiscard]] pid_t process() const noexcept { return process_; }

 private:
  BridgeProcess(pid_t process, int socket) noexcept : process_(process), socket_(socket) {}

  pid_t process_;
  int socket_;
  bool ended_ = false;
  std::string text_;  ///< that came and has not been taken
};

}  // namespace steadyrest::adapters::opcua
