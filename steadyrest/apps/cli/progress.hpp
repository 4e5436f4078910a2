// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdio>
#include <string_view>

namespace steadyrest::apps::cli {

/// A bar on stderr for work that takes over a second, and only on a terminal. Calls are cheap: the
/// bar is drawn at most ten times a second.
class Progress {
 public:
  using Clock = std::chrono::steady_clock;

  /// On stderr.
  Progress();
  Progress(std::FILE* stream, bool terminal, Clock::time_point start)
      : stream_(stream), terminal_(terminal), start_(start), last_(start) {}
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  ~Progress() { clear(); }

  /// `share` of the work that is done, 0 … 1; `what` is being done.
  void update(double share, std::string_view what) { update_at(Clock::now(), share, what); }
  void update_at(Clock::time_point now, double share, std::string_view what);
  /// Removes the bar from the screen.
  void clear();

 private:
  std::FILE* stream_;
  bool terminal_;
  bool drawn_ = false;
  Clock::time_point start_;
  Clock::time_point last_;
};

}  // namespace steadyrest::apps::cli
