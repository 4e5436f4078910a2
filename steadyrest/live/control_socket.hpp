// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include <steadyrest/kernel/outcome/result.hpp>

namespace steadyrest::live {

/// The longest line of a client, bytes.
inline constexpr std::size_t kMostLine = 4096;
/// Clients at a time; for a further one, the one that has said nothing for longest gives way.
inline constexpr std::size_t kMostClients = 16;

/// `$XDG_RUNTIME_DIR/steadyrest.sock`, or `/run/steadyrest.sock` where that is not set.
[[nodiscard]] std::string usual_socket();

/// Answers lines on a Unix socket, each with one line, in its own thread. The file is
/// readable and writable by its owner alone, and goes with the object.
///
/// A line that is too long is answered with an error and ends the connection.
class ControlSocket {
 public:
  /// Called in the socket's thread.
  using Answer = std::function<std::string(std::string_view line)>;

  /// Refused: a path that is too long or a file, and one on which another program answers.
  [[nodiscard]] static kernel::outcome::Result<void> check(const std::string& path);
  /// Refused: what check() refuses, and a path that cannot be made. A socket that a dead program
  /// has left is replaced.
  [[nodiscard]] static kernel::outcome::Result<std::unique_ptr<ControlSocket>> open(
      const std::string& path, Answer answer);

  ControlSocket() = default;
  ControlSocket(const ControlSocket&) = delete;
  ControlSocket& operator=(const ControlSocket&) = delete;
  virtual ~ControlSocket() = default;
};

/// Sends a line to the socket and waits for the answer. Refused (unavailable): there is no layer,
/// one of another user, or one that does not answer within `timeout_s`.
[[nodiscard]] kernel::outcome::Result<std::string> ask(const std::string& path,
                                                       const std::string& line,
                                                       double timeout_s = 2.0);

}  // namespace steadyrest::live
