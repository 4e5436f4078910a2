// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <utility>

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <steadyrest/live/reloader.hpp>

namespace steadyrest::live {
namespace {

/// Where the system has no descriptor left to wake it.
constexpr int kWithoutWake_ms = 200;
constexpr auto kLook = std::chrono::milliseconds(1);

/// Where the signal's handler writes.
std::atomic<int> told{-1};

void on_signal(int /*signal*/) {
  const int before = errno;
  ::eventfd_write(told.load(), 1);
  errno = before;
}

/// Empties it; false: it has not been written to.
bool drained(int descriptor) noexcept {
  std::array<char, sizeof(eventfd_t)> bytes{};
  bool any = false;
  while (descriptor >= 0 && ::read(descriptor, bytes.data(), bytes.size()) > 0) {
    any = true;
  }
  return any;
}

}  // namespace

Reloader::Reloader(Loop& loop, Config config)
    : loop_(loop), config_(std::move(config)), wake_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  if (config_.signal != 0) {
    signal_ = ::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
    told.store(signal_);
    struct sigaction now{};
    now.sa_handler = on_signal;
    now.sa_flags = SA_RESTART;
    ::sigaction(config_.signal, &now, &before_);
  }
  thread_ = std::thread([this] { work(); });
}

Reloader::~Reloader() {
  stop_.store(true);
  ::eventfd_write(wake_, 1);
  thread_.join();
  ::close(wake_);
  if (signal_ >= 0) {
    ::sigaction(config_.signal, &before_, nullptr);
    told.store(-1);
    ::close(signal_);
  }
}

std::uint64_t Reloader::ask() {
  const std::uint64_t number = asked_.fetch_add(1) + 1;
  ::eventfd_write(wake_, 1);
  return number;
}

ReloadStatus Reloader::status() const {
  const std::scoped_lock lock(mutex_);
  return status_;
}

kernel::machine::Machine Reloader::running() const {
  const std::scoped_lock lock(mutex_);
  return config_.running;
}

void Reloader::work() {
  // Others hold it back, so that it is handled here.
  if (config_.signal != 0) {
    sigset_t set;
    sigemptyset(&set);
    sigaddset(&set, config_.signal);
    ::pthread_sigmask(SIG_UNBLOCK, &set, nullptr);
  }
  while (!stop_.load()) {
    // A negative descriptor is passed over.
    std::array<pollfd, 2> on = {pollfd{wake_, POLLIN, 0}, pollfd{signal_, POLLIN, 0}};
    ::poll(on.data(), on.size(), wake_ >= 0 ? -1 : kWithoutWake_ms);
    (void)drained(wake_);
    if (drained(signal_)) {
      asked_.fetch_add(1);
    }
    if (asked_.load() != done_ && !stop_.load()) {
      reload();
    }
  }
}

void Reloader::reload() {
  const std::uint64_t number = asked_.load();
  done_ = number;
  if (config_.on_begin) {
    config_.on_begin();
  }
  auto made = config_.make(config_.running);
  ReloadStatus now{.number = number, .utc = {}, .taken = false, .words = {}};
  if (!made) {
    now.words = kernel::outcome::text(made.error());
  } else {
    next_ = std::move(*made);
    now.taken = hand_over();
    now.words = now.taken ? "" : "the loop does not cycle: nothing was changed";
  }
  if (config_.utc_now) {
    now.utc = config_.utc_now();
  }
  {
    const std::scoped_lock lock(mutex_);
    status_ = now;
    if (now.taken) {
      config_.running = present_->machine;
    }
  }
  if (config_.on_end) {
    config_.on_end(now);
  }
}

/// The loop makes no system call to wake this thread, so it looks.
bool Reloader::hand_over() {
  const std::uint64_t before = loop_.taken();
  const auto until =
      std::chrono::steady_clock::now() + std::chrono::duration<double>(config_.patience_s);
  loop_.offer(*next_);
  while (loop_.taken() == before) {
    const bool enough = stop_.load() || std::chrono::steady_clock::now() >= until;
    if (enough && loop_.withdraw()) {
      next_.reset();
      return false;
    }
    std::this_thread::sleep_for(kLook);
  }
  present_ = std::move(next_);
  return true;
}

}  // namespace steadyrest::live
