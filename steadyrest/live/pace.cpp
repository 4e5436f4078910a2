// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cerrno>
#include <cmath>
#include <ctime>

#include <steadyrest/live/pace.hpp>

namespace steadyrest::live {
namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;
constexpr double kPerSecond = 1e9;

std::int64_t now_ns() noexcept {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return static_cast<std::int64_t>(now.tv_sec) * kSecond_ns + now.tv_nsec;
}

}  // namespace

MonotonicPace::MonotonicPace(double period_s) noexcept
    : period_ns_(std::max<std::int64_t>(1, std::llround(period_s * kPerSecond))) {}

Pace::Wake MonotonicPace::wait() noexcept {
  const std::int64_t before = now_ns();
  if (deadline_ns_ == 0) {
    deadline_ns_ = before;
  }
  deadline_ns_ += period_ns_;
  Wake wake;
  if (before > deadline_ns_) {
    wake.missed = static_cast<std::uint64_t>(1 + (before - deadline_ns_) / period_ns_);
    deadline_ns_ += static_cast<std::int64_t>(wake.missed) * period_ns_;
  }
  const timespec until{.tv_sec = deadline_ns_ / kSecond_ns, .tv_nsec = deadline_ns_ % kSecond_ns};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
  }
  wake.lateness_s = static_cast<double>(now_ns() - deadline_ns_) / kPerSecond;
  return wake;
}

double MonotonicPace::now_s() const noexcept {
  return static_cast<double>(now_ns()) / kPerSecond;
}

}  // namespace steadyrest::live
