// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/web/gate.hpp>
#include <steadyrest/web/message.hpp>

namespace steadyrest::web {

/// HTTP and WebSocket, plain or over TLS, on Boost.Beast.
///
/// One thread does the traffic, another makes the answers, one after the other and urgent ones
/// (Gate::Config::urgent_path) first; those that say they take long (Response::later) are made
/// beside them. Bounded: connections, streams, sizes of head and body, time. A stream's client that
/// is slower than the stream gets the newest message and is told how many it has missed; it never
/// delays another.
class Server {
 public:
  struct Config {
    std::string address = "127.0.0.1";
    std::uint16_t port = 0;  ///< 0: any free one
    // NOLINTBEGIN(readability-redundant-member-init)
    std::string certificate = {};  ///< file, PEM; empty: no TLS
    std::string key = {};
    Gate::Config gate = {};
    std::string stream_path = {};
    // NOLINTEND(readability-redundant-member-init)
    std::size_t most_connections =
        64;                         ///< beyond, one that waits for its client gives way (Guests)
    std::size_t most_kept = 256;    ///< further ones, for urgent requests alone
    std::size_t most_streams = 32;  ///< beyond, one of an address that has more than the newcomer's
    std::size_t most_head = 16'384;
    std::size_t most_body = 262'144;
    /// Answers that take seconds, and those that take minutes, are made in two threads each,
    /// passwords are hashed in one; so many of each kind may be in work or wait.
    std::size_t most_slow = 8;
    double patience_s = 15.0;          ///< for a whole request, the next one, or an answer
    double slowest_bytes_s = 100'000;  ///< an answer has more time for what its client has taken
  };
  /// A stream may begin: its first message, and whether it may still go on, asked every second.
  struct Admitted {
    std::string first;
    std::function<bool()> goes_on;
  };
  struct Handlers {
    std::function<Response(const Request&)> answer;
    /// Or why not.
    std::function<std::variant<Admitted, Response>(const Request&)> admit;
    std::function<double()> now_s;
  };

  /// Refused: an address or port that cannot be had, a certificate or key that cannot be used.
  [[nodiscard]] static kernel::outcome::Result<std::unique_ptr<Server>> open(Config config,
                                                                             Handlers handlers);
  Server() = default;
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;
  virtual ~Server() = default;

  [[nodiscard]] virtual std::uint16_t port() const noexcept = 0;
  /// To each stream: the newest takes the place of one that is not sent yet. `{…}` without its
  /// first brace: `"missed":n,` goes before it, how many this client did not get since the last.
  virtual void publish(std::shared_ptr<const std::string> newest) = 0;
  /// To each stream, in order; a client that leaves more than a few waiting is dropped.
  virtual void announce(std::shared_ptr<const std::string> message) = 0;
  /// To each stream that has nothing waiting; the others go without it.
  virtual void offer(std::shared_ptr<const std::string> message) = 0;
  [[nodiscard]] virtual std::size_t streams() const noexcept = 0;
};

}  // namespace steadyrest::web
