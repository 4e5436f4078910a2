// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <steadyrest/nc/read/text/line_source.hpp>

namespace steadyrest::nc::interpret {

/// A place between two lines of one of a program's files.
struct Place {
  std::uint32_t file = 0;    ///< 0 = the program itself
  std::uint32_t line = 0;    ///< lines before it
  std::uint64_t offset = 0;  ///< bytes before it
};

/// The program and its subprogram files, one of which is being read.
class ProgramFiles {
 public:
  /// `main` outlives the object. A subprogram NAME is searched as NAME.ngc in `folders`.
  ProgramFiles(read::LineSource& main, std::vector<std::string> folders);

  read::LineSource::Status next() noexcept;
  [[nodiscard]] const read::LineSource& now() const noexcept { return *sources_[current_]; }
  [[nodiscard]] bool in_main() const noexcept { return current_ == 0; }
  /// The path of the file being read; empty for the program itself.
  [[nodiscard]] const std::string& path() const noexcept { return paths_[current_]; }
  /// Those opened so far, in order.
  [[nodiscard]] std::vector<std::string> subprograms() const {
    return {paths_.begin() + 1, paths_.end()};
  }

  /// Before and after the line that next() returned last.
  [[nodiscard]] Place line_begin() const noexcept { return line_begin_; }
  [[nodiscard]] Place line_end() const noexcept;
  /// False when the file cannot be read from there.
  [[nodiscard]] bool go(const Place& place) noexcept;
  /// The beginning of a subprogram's file; nothing when no readable file exists.
  [[nodiscard]] std::optional<Place> find(std::string_view name);
  /// The same for the first of `names` (with extension) that a folder has.
  [[nodiscard]] std::optional<Place> find(const std::vector<std::string>& names);

 private:
  static constexpr std::size_t kMostFiles = 1000;

  std::optional<Place> open(const std::string& path);

  std::vector<std::string> folders_;
  std::vector<read::LineSource> opened_;
  std::vector<read::LineSource*> sources_;
  std::vector<std::string> paths_;
  std::uint32_t current_ = 0;
  Place line_begin_;
};

}  // namespace steadyrest::nc::interpret
