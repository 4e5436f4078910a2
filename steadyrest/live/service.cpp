// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <utility>

#include <fmt/core.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <steadyrest/live/service.hpp>

namespace steadyrest::live {
namespace {

constexpr double kLongestLook_s = 0.25;
constexpr double kLooksInAWatchdog = 4.0;

std::string_view environment(const char* name) {
  const char* const value = std::getenv(name);
  return value != nullptr ? value : "";
}

/// 0 for what is no number.
std::uint64_t number(std::string_view text) noexcept {
  std::uint64_t value = 0;
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), value);
  return fault == std::errc() && end == text.data() + text.size() ? value : 0;
}

}  // namespace

ServiceManager ServiceManager::from_environment() {
  const std::string_view pid = environment("WATCHDOG_PID");
  const bool ours = pid.empty() || number(pid) == static_cast<std::uint64_t>(::getpid());
  const std::uint64_t watchdog_us = ours ? number(environment("WATCHDOG_USEC")) : 0;
  return ServiceManager(std::string(environment("NOTIFY_SOCKET")),
                        1e-6 * static_cast<double>(watchdog_us));
}

ServiceManager::ServiceManager(std::string address, double watchdog_s)
    : address_(std::move(address)), watchdog_s_(watchdog_s) {
  const bool fits = address_.size() > 1 && address_.size() < sizeof(sockaddr_un::sun_path) &&
                    (address_.front() == '/' || address_.front() == '@');
  if (fits) {
    socket_ = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  }
}

ServiceManager::ServiceManager(ServiceManager&& other) noexcept
    : address_(std::move(other.address_)),
      socket_(std::exchange(other.socket_, -1)),
      watchdog_s_(other.watchdog_s_) {}

ServiceManager::~ServiceManager() {
  if (socket_ >= 0) {
    ::close(socket_);
  }
}

void ServiceManager::tell(std::string_view state) const noexcept {
  if (socket_ < 0) {
    return;
  }
  sockaddr_un to{};
  to.sun_family = AF_UNIX;
  address_.copy(to.sun_path, sizeof to.sun_path - 1);
  if (to.sun_path[0] == '@') {
    to.sun_path[0] = '\0';
  }
  const auto length = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + address_.size());
  ::sendto(socket_, state.data(), state.size(), MSG_NOSIGNAL,
           reinterpret_cast<const sockaddr*>(&to), length);
}

void LifeSign::look() noexcept {
  const std::uint64_t beats = loop_.beats();
  const bool cycled = beats != beats_;
  beats_ = beats;
  if (loop_.stop_asked()) {
    stopping();
  }
  if (cycled && !ready_ && !stopping_) {
    ready_ = true;
    manager_.tell("READY=1");
  }
  if (cycled) {
    manager_.tell("WATCHDOG=1");
  }
}

void LifeSign::stopping() noexcept {
  if (!stopping_) {
    stopping_ = true;
    manager_.tell("STOPPING=1");
  }
}

LifeSignThread::LifeSignThread(const Loop& loop, const ServiceManager& manager)
    : sign_(loop, manager) {
  if (!manager.is_there()) {
    return;
  }
  const double watchdog_s = manager.watchdog_s();
  const double every_s =
      watchdog_s > 0.0 ? std::min(kLongestLook_s, watchdog_s / kLooksInAWatchdog) : kLongestLook_s;
  wake_ = ::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
  thread_ = std::thread([this, every_s] { work(every_s); });
}

LifeSignThread::~LifeSignThread() {
  if (thread_.joinable()) {
    stop_.store(true);
    ::eventfd_write(wake_, 1);
    thread_.join();
    ::close(wake_);
  }
}

void LifeSignThread::work(double every_s) {
  const int every_ms = std::max(1, static_cast<int>(std::lround(1e3 * every_s)));
  pollfd end{wake_, POLLIN, 0};  // a negative descriptor is passed over
  while (::poll(&end, 1, every_ms) <= 0 && !stop_.load()) {
    sign_.look();
  }
  sign_.stopping();
}

std::string reloading() {
  timespec now{};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  return fmt::format("RELOADING=1\nMONOTONIC_USEC={}",
                     1'000'000 * static_cast<std::int64_t>(now.tv_sec) + now.tv_nsec / 1000);
}

}  // namespace steadyrest::live
