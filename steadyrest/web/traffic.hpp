// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <atomic>
#include <list>
#include <memory>
#include <string>

#include <boost/asio.hpp>
#include <boost/asio/ssl.hpp>

#include <steadyrest/web/answers.hpp>
#include <steadyrest/web/guests.hpp>
#include <steadyrest/web/server.hpp>
#include <steadyrest/web/slow_answers.hpp>

/// What the server's connections share; inside this room.
namespace steadyrest::web {

namespace asio = boost::asio;

/// A client of the stream, whatever it is connected by. In the traffic's thread alone.
class Stream {
 public:
  Stream() = default;
  Stream(const Stream&) = delete;
  Stream& operator=(const Stream&) = delete;
  virtual ~Stream() = default;
  virtual void publish(const std::shared_ptr<const std::string>& newest) = 0;
  virtual void announce(const std::shared_ptr<const std::string>& message) = 0;
  virtual void offer(const std::shared_ptr<const std::string>& message) = 0;
  virtual void look() = 0;  ///< whether it may go on, and whether its client takes what it is sent
  virtual void give_way() = 0;
  [[nodiscard]] virtual const std::string& address() const = 0;  ///< of its client
};

struct Traffic {
  Traffic(Server::Config config_in, Server::Handlers handlers_in)
      : config(std::move(config_in)),
        handlers(std::move(handlers_in)),
        gate(config.gate),
        guests(config.most_connections, config.most_kept),
        slow(beside(2, config.most_slow)),
        slowest(beside(2, config.most_slow)),
        hashing({.threads = 1, .most = config.most_slow, .most_of_client = 2}) {}

  /// Of one client never all.
  static SlowAnswers::Config beside(std::size_t threads, std::size_t most) {
    return {.threads = threads, .most = most, .most_of_client = std::max<std::size_t>(most, 3) - 2};
  }

  /// One more stream for a client there; the oldest of the address that has most of them may have
  /// given way to it.
  [[nodiscard]] bool has_room_for_stream(const std::string& address) {
    if (streams.size() < config.most_streams) {
      return true;
    }
    const auto has = [this](const std::string& of) {
      return std::ranges::count(streams, of, [](const Stream* at) { return at->address(); });
    };
    const auto most =
        std::ranges::max_element(streams, {}, [&](const Stream* at) { return has(at->address()); });
    if (most == streams.end() || has((*most)->address()) <= has(address) + 1) {
      return false;
    }
    (*most)->give_way();
    return true;
  }

  Server::Config config;
  Server::Handlers handlers;
  Gate gate;
  std::list<Stream*> streams;  ///< the oldest first
  std::atomic<std::size_t> stream_count{0};
  Guests guests;
  // Last, so that they go first: their handlers still use what is above.
  asio::io_context io{1};
  Answers answers;
  SlowAnswers slow;
  SlowAnswers slowest;  ///< take minutes
  SlowAnswers hashing;  ///< of passwords: each takes 64 MiB, so one at a time
};

}  // namespace steadyrest::web
