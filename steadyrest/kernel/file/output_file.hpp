// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <steadyrest/kernel/file/place.hpp>
#include <steadyrest/kernel/file/temporary.hpp>
#include <steadyrest/kernel/outcome/result.hpp>

namespace steadyrest::kernel::file {

/// The one way in which this program writes a file: beside its target, renamed when it is whole and
/// on the disk. The target is the old file or the new one, never a part; without commit() nothing
/// is left behind.
///
/// A link is followed, and the file that it leads to replaced; the permissions of the replaced file
/// are kept, and its owner where that is permitted. Another hard link keeps the old content. A
/// pipe, a character device and stdout are written as the text arises: they cannot be renamed.
class OutputFile {
 public:
  static outcome::Result<OutputFile> open(const std::string& target);
  static OutputFile standard_output();
  OutputFile(OutputFile&& other) noexcept;
  OutputFile& operator=(OutputFile&&) = delete;
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;
  ~OutputFile();

  /// A fault shows at flush() or commit().
  void write(std::string_view bytes) noexcept;
  /// What has been written can now be read at path().
  [[nodiscard]] outcome::Result<void> flush();
  /// All of it is on the disk.
  [[nodiscard]] outcome::Result<void> settle();
  /// Puts the file in its place; see declare_outputs().
  [[nodiscard]] outcome::Result<void> commit();
  /// Where this process and its children can read the text until commit(). Empty for a stream.
  [[nodiscard]] const std::string& path() const noexcept { return path_; }

 private:
  OutputFile() = default;
  outcome::Result<void> make_beside();
  /// The last that can fail before the rename: the file has its temporary name.
  [[nodiscard]] outcome::Result<void> take_name();
  /// The old file, if there is one, then has the temporary name, where the file system can do that.
  [[nodiscard]] outcome::Result<void> rename();
  /// What rename() has done is undone.
  void take_back() noexcept;
  /// It stays: the old file goes.
  void let_stay();
  friend outcome::Result<void> put_in_place(std::span<OutputFile> settled);
  [[nodiscard]] outcome::Refusal refusal(int error) const;
  void put() noexcept;

  static constexpr std::size_t kHeld = std::size_t{1} << 16U;
  int descriptor_ = -1;
  std::vector<char> held_;  ///< not written yet: a call for each line costs more than the line
  int error_ = 0;
  std::string name_;  ///< of the target, as the user gave it
  Place place_;
  std::string path_;
  Temporary beside_;  ///< the file's temporary name, once it has one
  bool exchanged_ = false;
  std::uintmax_t bytes_ = 0;
  std::uintmax_t lines_ = 0;
};

struct FileText {
  std::string file;
  std::string text;
};

/// Renames these settled files: all or none, whatever fails and whatever signal arrives. Where the
/// file system cannot exchange two names, a failed rename leaves the earlier ones in place.
[[nodiscard]] outcome::Result<void> put_in_place(std::span<OutputFile> settled);

/// Declares a program's outputs: from now on commit() leaves these files to put_outputs_in_place(),
/// so that either all of them are put in place or none, and written_files() lists only these.
void declare_outputs(std::span<const std::string> files);
[[nodiscard]] outcome::Result<void> put_outputs_in_place();

/// Writes whole files; renames none before all are on the disk.
[[nodiscard]] outcome::Result<void> write_files(std::span<const FileText> files);
[[nodiscard]] outcome::Result<void> write_file(const std::string& file, std::string_view text);

/// A file that this process has put in place.
struct Written {
  std::string file;  ///< as the user named it
  std::uintmax_t bytes = 0;
  std::uintmax_t lines = 0;
};

/// All of them, in order: what a verb reports as written.
[[nodiscard]] std::vector<Written> written_files();

}  // namespace steadyrest::kernel::file
