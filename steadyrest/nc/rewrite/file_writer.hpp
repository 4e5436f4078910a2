// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

#include <steadyrest/kernel/outcome/result.hpp>

namespace steadyrest::nc::rewrite {

/// Writes a file beside its target and renames it when it is whole and on the disk: the target is
/// the old file or the new one, never a part. Without commit() nothing is left behind.
class FileWriter {
 public:
  static kernel::outcome::Result<FileWriter> open(const std::string& target);
  FileWriter(FileWriter&& other) noexcept;
  FileWriter& operator=(FileWriter&&) = delete;
  FileWriter(const FileWriter&) = delete;
  FileWriter& operator=(const FileWriter&) = delete;
  ~FileWriter();

  /// A fault shows at flush() or commit().
  void write(std::string_view bytes) noexcept;
  /// What has been written can now be read at path().
  [[nodiscard]] kernel::outcome::Result<void> flush();
  [[nodiscard]] kernel::outcome::Result<void> commit();
  [[nodiscard]] const std::string& path() const noexcept { return path_; }

 private:
  FileWriter() = default;
  [[nodiscard]] kernel::outcome::Refusal refusal(int error) const;

  void put() noexcept;

  static constexpr std::size_t kHeld = std::size_t{1} << 16U;
  std::FILE* file_ = nullptr;
  std::vector<char> held_;  ///< not written yet; fwrite for each line costs more than the line
  int error_ = 0;
  std::string target_;
  std::string path_;  ///< beside the target; empty once it is committed
};

}  // namespace steadyrest::nc::rewrite
