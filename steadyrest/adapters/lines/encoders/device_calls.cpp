// SPDX-License-Identifier: Apache-2.0
#include <ctime>

#include <sys/ioctl.h>
#include <unistd.h>

#include <steadyrest/adapters/lines/encoders/device_calls.hpp>

namespace steadyrest::adapters::lines {

Descriptor::~Descriptor() {
  if (is_open()) {
    ::close(number_);
  }
}

int system_control(int descriptor, unsigned long request, void* data) {
  return ::ioctl(descriptor, request, data);
}

std::uint64_t edge_clock_ns() noexcept {
  timespec now{};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  return static_cast<std::uint64_t>(now.tv_sec) * 1'000'000'000U +
         static_cast<std::uint64_t>(now.tv_nsec);
}

}  // namespace steadyrest::adapters::lines
