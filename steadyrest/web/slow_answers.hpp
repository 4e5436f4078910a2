// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <stop_token>

#include <boost/asio/thread_pool.hpp>

namespace steadyrest::web {

/// Makes answers that take long, some at a time, in threads of low priority: the quick ones never
/// wait for them.
class SlowAnswers {
 public:
  /// Makes an answer and returns its delivery, which is called once this has room again: whoever
  /// has the answer may ask for another.
  using Work = std::function<std::function<void()>(std::stop_token)>;

  /// At most `most` are being made or wait.
  SlowAnswers(std::size_t threads, std::size_t most) : most_(most), pool_(threads) {}
  SlowAnswers(const SlowAnswers&) = delete;
  SlowAnswers& operator=(const SlowAnswers&) = delete;
  ~SlowAnswers() { end(); }

  /// False: there are too many already.
  [[nodiscard]] bool take(Work work);
  /// Tells those that are being made to give up, drops those that wait, and returns when none is
  /// left.
  void end();

 private:
  std::size_t most_;
  std::atomic<std::size_t> taken_{0};
  std::stop_source stop_;
  boost::asio::thread_pool pool_;
};

}  // namespace steadyrest::web
