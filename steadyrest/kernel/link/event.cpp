// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <ctime>

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <steadyrest/kernel/link/event.hpp>

namespace steadyrest::kernel::link {

double monotonic_s() noexcept {
  timespec now{};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

Event::Event() noexcept : descriptor_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  if (descriptor_ < 0) {
    std::abort();  // no descriptor is left: nothing else of the program could be opened either
  }
}

Event::~Event() {
  ::close(descriptor_);
}

void Event::post() const noexcept {
  const std::uint64_t one = 1;
  while (::write(descriptor_, &one, sizeof one) < 0 && errno == EINTR) {
  }
}

bool Event::wait(double timeout_s) noexcept {
  const double until_s = monotonic_s() + timeout_s;
  for (;;) {
    const double left_s = std::max(0.0, until_s - monotonic_s());
    timespec left{.tv_sec = static_cast<time_t>(left_s),
                  .tv_nsec = static_cast<long>(1e9 * (left_s - std::floor(left_s)))};
    pollfd waits{.fd = descriptor_, .events = POLLIN, .revents = 0};
    const int got = ::ppoll(&waits, 1, timeout_s < 0.0 ? nullptr : &left, nullptr);
    if (got > 0) {
      std::uint64_t count = 0;
      return ::read(descriptor_, &count, sizeof count) > 0;
    }
    if (got == 0 || errno != EINTR) {
      return false;
    }
  }
}

}  // namespace steadyrest::kernel::link
