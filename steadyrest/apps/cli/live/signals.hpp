// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <csignal>

#include <steadyrest/live/loop.hpp>

namespace steadyrest::apps::cli::live {

/// SIGINT and SIGTERM end the loop while this lives. A second one ends the process at once: the
/// machine's watchdog hands back then.
class StopSignals {
 public:
  explicit StopSignals(steadyrest::live::Loop& loop);
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;
  ~StopSignals();

 private:
  struct sigaction interrupt_{};
  struct sigaction terminate_{};
};

/// While this lives, SIGHUP waits for the reloader's thread and disturbs neither the loop nor the
/// threads that are made after it.
class HangupWaits {
 public:
  HangupWaits();
  HangupWaits(const HangupWaits&) = delete;
  HangupWaits& operator=(const HangupWaits&) = delete;
  ~HangupWaits();

  /// The terminal that the process was started on has gone: the signal meant that.
  [[nodiscard]] bool terminal_is_gone() const noexcept;

 private:
  sigset_t before_{};
  bool on_terminal_;
};

}  // namespace steadyrest::apps::cli::live
