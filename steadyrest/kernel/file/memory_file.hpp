// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <utility>

#include <steadyrest/kernel/outcome/result.hpp>

namespace steadyrest::kernel::file {

/// A text under the name of a file, for code that reads files: in memory alone, gone with this
/// object, whatever happens to the process.
class MemoryFile {
 public:
  static outcome::Result<MemoryFile> make(std::string_view text);
  MemoryFile(MemoryFile&& other) noexcept
      : descriptor_(std::exchange(other.descriptor_, -1)), path_(std::move(other.path_)) {}
  MemoryFile& operator=(MemoryFile&&) = delete;
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  ~MemoryFile();

  [[nodiscard]] const std::string& path() const noexcept { return path_; }

 private:
  explicit MemoryFile(int descriptor);
  int descriptor_ = -1;
  std::string path_;
};

}  // namespace steadyrest::kernel::file
