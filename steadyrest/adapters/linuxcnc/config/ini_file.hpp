// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <steadyrest/kernel/outcome/result.hpp>

namespace steadyrest::adapters::linuxcnc::config {

/// One `KEY = value` of a section, where it was found.
struct IniEntry {
  std::string section;
  std::string key;
  std::string value;
  std::string file;          ///< the INI file, or the file that it includes
  std::size_t line = 0;      ///< the first, where backslashes continue it
  std::size_t top_line = 0;  ///< the last in the INI file itself: of the entry or its #INCLUDE
  bool included = false;     ///< from an included file

  /// `[TRAJ] LINEAR_UNITS = mm`
  [[nodiscard]] std::string text() const;
};

/// A number and the entry that it is from.
struct IniNumber {
  double value = 0.0;
  const IniEntry* entry = nullptr;
};

/// An INI file as LinuxCNC 2.9 reads it: the first section of a name and the first key of a name
/// count, `HALFILE` may repeat, `#` or `;` begins a comment line, a backslash continues a line, and
/// `#INCLUDE file` takes in a file beside the INI file, one level deep.
///
/// Refused: a file that cannot be read, is binary, has no section or an included file that cannot
/// be read.
class IniFile {
 public:
  static kernel::outcome::Result<IniFile> read(const std::string& path);
  /// The same from a text; `path` names it, and the folder of included files.
  static kernel::outcome::Result<IniFile> parse(std::string_view text, const std::string& path);

  [[nodiscard]] const std::string& path() const noexcept { return path_; }
  /// Files that it includes.
  [[nodiscard]] const std::vector<std::string>& included() const noexcept { return included_; }
  [[nodiscard]] const std::vector<IniEntry>& entries() const noexcept { return entries_; }
  [[nodiscard]] const IniEntry* find(std::string_view section, std::string_view key) const noexcept;
  [[nodiscard]] std::vector<const IniEntry*> all(std::string_view section,
                                                 std::string_view key) const;
  [[nodiscard]] bool has_section(std::string_view section) const noexcept;
  /// The line of `[section]` in the INI file itself, or of the #INCLUDE that brings it; 0: none.
  [[nodiscard]] std::size_t section_line(std::string_view section) const noexcept;
  /// After this line of the INI file itself, an inserted line belongs to that section.
  [[nodiscard]] bool in_section_after(std::size_t line, std::string_view section) const noexcept;

  /// Without the key: nothing. A refusal where the value does not begin with a finite number, or
  /// has anything but a comment behind it.
  [[nodiscard]] kernel::outcome::Result<std::optional<IniNumber>> number(
      std::string_view section, std::string_view key) const;

 private:
  struct Section {
    std::string name;
    std::size_t top_line = 0;
    bool first = true;  ///< of its name
  };
  friend class IniReader;

  std::string path_;
  std::vector<std::string> included_;
  std::vector<Section> sections_;
  std::vector<IniEntry> entries_;   ///< of the first section of each name
  std::vector<int> section_after_;  ///< by line of the INI file; -1: before the first section
};

}  // namespace steadyrest::adapters::linuxcnc::config
