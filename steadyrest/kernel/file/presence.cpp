// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <steadyrest/kernel/file/presence.hpp>

namespace steadyrest::kernel::file {

Presence::Presence(const std::string& file)
    : descriptor_(::open(file.c_str(), O_PATH | O_CLOEXEC)) {}

Presence::Presence(Presence&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}

Presence::~Presence() {
  if (descriptor_ >= 0) {
    ::close(descriptor_);
  }
}

bool Presence::is_removed() const noexcept {
  struct ::stat status{};
  return descriptor_ >= 0 && ::fstat(descriptor_, &status) == 0 && status.st_nlink == 0;
}

}  // namespace steadyrest::kernel::file
