// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <csignal>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/live/loop.hpp>

namespace steadyrest::live {

/// What became of the last request to read the machine file again.
struct ReloadStatus {
  std::uint64_t number = 0;  ///< of the request, from 1; 0: there was none
  std::string utc;           ///< when it was done
  bool taken = false;        ///< else refused
  std::string words;         ///< why it was refused
};

/// Reads the machine file again when asked, in its own thread, and offers the new layer to the
/// loop. A refused file changes nothing.
class Reloader {
 public:
  /// A layer from the file as it is now; refused where it does not fit the running one.
  using Make = std::function<kernel::outcome::Result<std::unique_ptr<Successor>>(
      const kernel::machine::Machine& running)>;

  struct Config {
    kernel::machine::Machine running;  ///< that the loop begins with, and each that took over
    Make make;
    // NOLINTBEGIN(readability-redundant-member-init)
    std::function<std::string()> utc_now = {};
    /// Both in the reloader's thread.
    std::function<void()> on_begin = {};
    std::function<void(const ReloadStatus&)> on_end = {};
    // NOLINTEND(readability-redundant-member-init)
    /// Counts as a request, whichever thread it reaches; the caller blocks it in those that it must
    /// not disturb. One reloader at a time may have one. 0: none.
    int signal = 0;
    double patience_s = 2.0;  ///< for the loop to take an offer
  };

  /// The reloader outlives the loop's run().
  Reloader(Loop& loop, Config config);
  Reloader(const Reloader&) = delete;
  Reloader& operator=(const Reloader&) = delete;
  ~Reloader();

  /// From any thread: its number. Requests that come while one is at work make one.
  std::uint64_t ask();
  [[nodiscard]] ReloadStatus status() const;
  /// What the loop runs by.
  [[nodiscard]] kernel::machine::Machine running() const;

 private:
  void work();
  void reload();
  [[nodiscard]] bool hand_over();

  Loop& loop_;
  Config config_;
  std::unique_ptr<Successor> present_;  ///< that the loop runs; null: the one it began with
  std::unique_ptr<Successor> next_;
  int wake_ = -1;
  int signal_ = -1;
  struct sigaction before_{};  ///< what the signal did
  std::atomic<std::uint64_t> asked_{0};
  std::uint64_t done_ = 0;  ///< of the thread: the last request that it has served
  std::atomic<bool> stop_{false};
  mutable std::mutex mutex_;
  ReloadStatus status_;
  std::thread thread_;  ///< last: it uses all the others
};

}  // namespace steadyrest::live
