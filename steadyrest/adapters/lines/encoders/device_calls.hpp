// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <utility>

namespace steadyrest::adapters::lines {

/// An open file, closed when it goes.
class Descriptor {
 public:
  explicit Descriptor(int number = -1) noexcept : number_(number) {}
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor();

  [[nodiscard]] int get() const noexcept { return number_; }
  [[nodiscard]] bool is_open() const noexcept { return number_ >= 0; }

 private:
  int number_;
};

/// `ioctl` of the system.
int system_control(int descriptor, unsigned long request, void* data);

/// Where the kernel's devices are and how they are set: tests put theirs in their place.
struct DeviceCalls {
  int (*control)(int descriptor, unsigned long request, void* data) = system_control;
  std::filesystem::path devices = "/dev";
  std::filesystem::path counters = "/sys/bus/counter/devices";
};

/// Calls of `read` in one reading, 64 edges each: a storm of edges must not hold the thread.
inline constexpr int kMostReads = 64;

/// Nanoseconds of CLOCK_MONOTONIC, the clock of the kernel's edges.
[[nodiscard]] std::uint64_t edge_clock_ns() noexcept;

}  // namespace steadyrest::adapters::lines
