// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <steadyrest/kernel/file/temporary.hpp>
#include <steadyrest/kernel/outcome/result.hpp>

namespace steadyrest::kernel::file {

/// Where an output goes.
struct Place {
  enum class Kind {
    file,             ///< a file, there or not: written beside and renamed
    stream,           ///< a pipe or a character device: written as it arises
    standard_output,  ///< the process's own stdout
  };
  Kind kind = Kind::file;
  std::filesystem::path path;  ///< of a file: absolute, without links; otherwise as it was named
  bool exists = false;
};

/// Resolves a name as the user gave it, following links, including one whose target does not exist
/// yet. Refused: an empty name, a folder, a block device, a folder that is missing or cannot be
/// written, a file that may not be written (for root too, when nobody may).
[[nodiscard]] outcome::Result<Place> place_of(const std::string& name);

/// What is wrong with an output that may not be written, and what to do.
struct Unwritable {
  std::string what;
  std::string to_do;
};
/// From the system's error; `thing`: "file" or "folder". Blames permissions only where they are
/// missing.
[[nodiscard]] Unwritable unwritable(const std::string& thing, int error);

/// Both names lead to the same file, whatever the spelling or links. False where either is a
/// character device or cannot be resolved.
[[nodiscard]] bool same_place(const std::string& one, const std::string& other);

/// Folders made for files to come; those still empty are removed with this object.
class MadeFolders {
 public:
  /// Makes the folder and any missing ones above it. Refused: what cannot be made or written.
  static outcome::Result<MadeFolders> make(const std::filesystem::path& folder);
  MadeFolders(MadeFolders&&) = default;
  MadeFolders& operator=(MadeFolders&&) = default;
  MadeFolders(const MadeFolders&) = delete;
  MadeFolders& operator=(const MadeFolders&) = delete;
  ~MadeFolders();

 private:
  MadeFolders() = default;
  std::vector<Temporary> made_;  ///< the outermost first
};

}  // namespace steadyrest::kernel::file
