// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <functional>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>

namespace steadyrest::apps::cli {

/// A bar on stderr for work that takes over a second, and only on a terminal. Calls are cheap: the
/// bar is drawn at most ten times a second. While a step of the work makes no call the seconds
/// still tick, so that no work looks dead.
class Progress {
 public:
  using Clock = std::chrono::steady_clock;

  /// On stderr, with the clock's ticks.
  Progress();
  /// Without ticks of its own.
  Progress(std::FILE* stream, bool terminal, Clock::time_point start)
      : stream_(stream), terminal_(terminal), start_(start), last_(start) {}
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  ~Progress();

  /// `share` of the work done, 0 … 1; `what` is being done.
  void update(double share, std::string_view what) { update_at(Clock::now(), share, what); }
  /// update(), for code that does not know this class. This object outlives it.
  [[nodiscard]] std::function<void(double share, std::string_view what)> reporter() {
    return [this](double share, std::string_view what) { update(share, what); };
  }
  void update_at(Clock::time_point now, double share, std::string_view what);
  /// Draws the seconds if nothing has been drawn for one.
  void tick_at(Clock::time_point now);
  /// Removes the bar from the screen until the next update.
  void clear();

 private:
  void draw(Clock::time_point now);

  std::FILE* stream_;
  bool terminal_;
  bool drawn_ = false;
  bool cleared_ = false;
  double share_ = 0.0;
  std::string what_ = "working";
  Clock::time_point start_;
  Clock::time_point last_;
  std::mutex mutex_;
  std::condition_variable end_;
  bool ended_ = false;
  std::thread ticker_;
};

}  // namespace steadyrest::apps::cli
