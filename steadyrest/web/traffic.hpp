// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <list>
#include <memory>
#include <set>
#include <string>

#include <boost/asio.hpp>
#include <boost/asio/ssl.hpp>

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
  virtual void look() = 0;  ///< whether it may go on
};

/// A connection that waits for what its client sends next. In the traffic's thread alone.
class Waiting {
 public:
  Waiting() = default;
  Waiting(const Waiting&) = delete;
  Waiting& operator=(const Waiting&) = delete;
  virtual ~Waiting() = default;
  virtual void give_way() = 0;  ///< closes it
};

struct Traffic {
  Traffic(Server::Config config_in, Server::Handlers handlers_in)
      : config(std::move(config_in)),
        handlers(std::move(handlers_in)),
        gate(config.gate),
        slow(2, config.most_slow),
        slowest(2, config.most_slow) {}

  Server::Config config;
  Server::Handlers handlers;
  Gate gate;
  std::set<Stream*> streams;
  std::atomic<std::size_t> stream_count{0};
  std::size_t connections = 0;
  std::list<Waiting*> waiting;  ///< the longest first
  // Last, so that they go first: their handlers still use what is above.
  asio::io_context io{1};
  asio::thread_pool answers{1};
  SlowAnswers slow;
  SlowAnswers slowest;  ///< take minutes
};

}  // namespace steadyrest::web
