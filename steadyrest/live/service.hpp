// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <string_view>
#include <thread>

#include <steadyrest/live/loop.hpp>

namespace steadyrest::live {

/// The service manager that started this process (systemd, Type=notify): each message is one
/// datagram to the socket that it has named. Without one nothing is sent.
///
/// The datagram is systemd's documented protocol (sd_notify(3)); its library would bring five more
/// into a process that moves axes.
class ServiceManager {
 public:
  /// By $NOTIFY_SOCKET, and $WATCHDOG_USEC where $WATCHDOG_PID is this process or not set.
  [[nodiscard]] static ServiceManager from_environment();

  /// `address`: a path, or `@` and an abstract name; empty: nobody.
  explicit ServiceManager(std::string address, double watchdog_s = 0.0);
  ServiceManager(ServiceManager&& other) noexcept;
  ServiceManager& operator=(ServiceManager&&) = delete;
  ServiceManager(const ServiceManager&) = delete;
  ServiceManager& operator=(const ServiceManager&) = delete;
  ~ServiceManager();

  [[nodiscard]] bool is_there() const noexcept { return socket_ >= 0; }
  /// It ends the process after so long without a sign of life; 0: never.
  [[nodiscard]] double watchdog_s() const noexcept { return watchdog_s_; }
  /// `READY=1`, or several such lines. From any thread; never waits.
  void tell(std::string_view state) const noexcept;

 private:
  std::string address_;
  int socket_ = -1;
  double watchdog_s_ = 0.0;
};

/// Tells the service manager that the loop runs: READY=1 after its first cycle, WATCHDOG=1 only if
/// it has cycled since the last look, STOPPING=1 once it has been told to stop.
///
/// The cycle makes no system call for this. Nor may another thread vouch for a loop that hangs:
/// this one only passes on what the loop's count of cycles says.
class LifeSign {
 public:
  /// Both outlive it.
  LifeSign(const Loop& loop, const ServiceManager& manager) noexcept
      : loop_(loop), manager_(manager) {}

  void look() noexcept;
  /// The loop has ended.
  void stopping() noexcept;

 private:
  const Loop& loop_;
  const ServiceManager& manager_;
  std::uint64_t beats_ = 0;
  bool ready_ = false;
  bool stopping_ = false;
};

/// Looks several times in each watchdog interval, in its own thread, while it lives.
class LifeSignThread {
 public:
  LifeSignThread(const Loop& loop, const ServiceManager& manager);
  LifeSignThread(const LifeSignThread&) = delete;
  LifeSignThread& operator=(const LifeSignThread&) = delete;
  ~LifeSignThread();

 private:
  void work(double every_s);

  LifeSign sign_;
  int wake_ = -1;
  std::atomic<bool> stop_{false};  ///< where there is nothing to wake it by, too
  std::thread thread_;
};

/// The lines that tell of a reload's begin: systemd wants to know since when.
[[nodiscard]] std::string reloading();

}  // namespace steadyrest::live
