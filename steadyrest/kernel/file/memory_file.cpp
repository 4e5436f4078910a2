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
  const auto failed = [](const char* what) {
    return std::unexpected(outcome::Refusal{.kind = outcome::Kind::unavailable,
                                            .file = {},
                                            .line = 0,
                                            .what = std::string(what) + std::strerror(errno),
                                            .to_do = "free some memory and try again"});
  };
  const int descriptor = ::memfd_create("steadyrest", MFD_CLOEXEC);
  if (descriptor < 0) {
    return failed("no memory for a file: ");
  }
  MemoryFile file(descriptor);
  while (!text.empty()) {
    const ssize_t written = ::write(descriptor, text.data(), text.size());
    if (written <= 0 && errno != EINTR) {
      return failed("a file in memory: write failed: ");
    }
    text.remove_prefix(static_cast<std::size_t>(written > 0 ? written : 0));
  }
  return file;
}

}  // namespace steadyrest::kernel::file
