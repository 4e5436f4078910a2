// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <deque>
#include <functional>
#include <mutex>

#include <boost/asio/thread_pool.hpp>

namespace steadyrest::web {

/// Makes answers one after the other in a thread of its own, urgent ones first. From any thread.
class Answers {
 public:
  using Work = std::function<void()>;

  Answers() : pool_(1) {}
  void take(Work work, bool urgent);
  /// Makes those that wait, and returns.
  void join() { pool_.join(); }

 private:
  void make_next();

  std::mutex mutex_;
  std::array<std::deque<Work>, 2> waiting_;  ///< urgent, others
  boost::asio::thread_pool pool_;
};

}  // namespace steadyrest::web
