// SPDX-License-Identifier: Apache-2.0
#include <cerrno>
#include <cstring>

#include <sys/mman.h>
#include <unistd.h>

#include <steadyrest/kernel/file/memory_file.hpp>

namespace steadyrest::kernel::file {

MemoryFile::MemoryFile(int descriptor)
    : descriptor_(descriptor), path_("/proc/self/fd/" + std::to_string(descriptor)) {}

MemoryFile::~MemoryFile() {
  if (descriptor_ >= 0) {
    ::close(descriptor_);
  }
}

outcome::Result<MemoryFile> MemoryFile::make(std::string_view text) {
  const auto failed = [] {
    return std::unexpected(
        outcome::Refusal{.kind = outcome::Kind::unavailable,
                         .file = {},
                         .line = 0,
                         .what = std::string("no memory for a file: ") + std::strerror(errno),
                         .to_do = "free some memory and try again"});
  };
  const int descriptor = ::memfd_create("steadyrest", MFD_CLOEXEC);
  if (descriptor < 0) {
    return failed();
  }
  MemoryFile file(descriptor);
  while (!text.empty()) {
    const ssize_t written = ::write(descriptor, text.data(), text.size());
    if (written <= 0 && errno != EINTR) {
      return failed();
    }
    text.remove_prefix(static_cast<std::size_t>(written > 0 ? written : 0));
  }
  return file;
}

}  // namespace steadyrest::kernel::file
