// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <utility>

#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/nc/read/text/line_source.hpp>

namespace steadyrest::nc::rewrite {

/// The lines of a file together with their line ends, for copying byte for byte.
class SourceLines {
 public:
  static kernel::outcome::Result<SourceLines> open(const std::string& path);
  /// Of a text that outlives it; `path` names it in refusals.
  static SourceLines of(std::string_view text, std::string path);

  bool next() noexcept {
    status_ = source_.next();
    return status_ == read::LineSource::Status::line;
  }
  /// Skips the next line if it is this one with this line end; else does nothing.
  bool skip(std::string_view line, std::string_view ending) noexcept {
    return !ending.empty() && line.data() + line.size() == ending.data() &&
           source_.skip({line.data(), line.size() + ending.size()});
  }
  [[nodiscard]] std::string_view line() const noexcept { return source_.line(); }
  [[nodiscard]] std::uint32_t number() const noexcept { return source_.number(); }
  [[nodiscard]] std::string_view ending() const noexcept {
    // It follows the line in the buffer: LF, CR LF, or at the file's end a lone CR.
    return {source_.line().data() + source_.line().size(), source_.ending_length()};
  }
  /// Refused when next() ended before the end of the file.
  [[nodiscard]] kernel::outcome::Result<void> whole() const;

 private:
  SourceLines(read::LineSource source, std::string path)
      : source_(std::move(source)), path_(std::move(path)) {}
  read::LineSource source_;
  std::string path_;
  read::LineSource::Status status_ = read::LineSource::Status::line;
};

}  // namespace steadyrest::nc::rewrite
