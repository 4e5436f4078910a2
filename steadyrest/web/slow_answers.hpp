// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <mutex>
#include <stop_token>
#include <string>
#include <unordered_map>

#include <boost/asio/thread_pool.hpp>

namespace steadyrest::web {

/// Makes answers that take long, some at a time, in threads of low priority: the quick ones never
/// wait for them.
class SlowAnswers {
 public:
  /// Makes an answer and returns its delivery, which is called once this has room again: whoever
  /// has the answer may ask for another.
  using Work = std::function<std::function<void()>(std::stop_token)>;

  struct Config {
    std::size_t threads = 1;
    std::size_t most = 8;            ///< being made or waiting
    std::size_t most_of_client = 6;  ///< the same of one client
  };

  explicit SlowAnswers(const Config& config) : config_(config), pool_(config.threads) {}
  SlowAnswers(const SlowAnswers&) = delete;
  SlowAnswers& operator=(const SlowAnswers&) = delete;
  ~SlowAnswers() { end(); }

  /// False: there are too many already, of all or of this client.
  [[nodiscard]] bool take(const std::string& client, Work work);
  /// Tells those that are being made to give up, drops those that wait, and returns when none is
  /// left.
  void end();

 private:
  [[nodiscard]] bool has_room(const std::string& client);
  void free(const std::string& client);

  Config config_;
  std::mutex mutex_;
  std::unordered_map<std::string, std::size_t> taken_;  ///< by client
  std::size_t all_ = 0;
  std::stop_source stop_;
  boost::asio::thread_pool pool_;
};

}  // namespace steadyrest::web
