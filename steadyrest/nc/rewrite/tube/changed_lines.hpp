// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <steadyrest/kernel/outcome/result.hpp>

namespace steadyrest::nc::rewrite {

/// What the lines of a program with blocks replaced are, by number from 1.
class ChangedLines {
 public:
  enum class Kind : std::uint8_t {
    kept,   ///< of the original
    head,   ///< the mark that says how the program was made
    was,    ///< the comment that keeps a line of the original
    fresh,  ///< in its place
    same    ///< the first of these, and it is the original's line itself
  };

  /// Compares a changed program with its original: with its replaced lines put back it must be the
  /// original byte for byte. Refused with the line of the changed program otherwise, and where a
  /// new line names a parameter or has a comment that the original does not have.
  static kernel::outcome::Result<ChangedLines> compare(const std::string& original,
                                                       const std::string& changed);

  [[nodiscard]] Kind kind(std::uint32_t line) const noexcept {
    return line < kind_.size() ? kind_[line] : Kind::kept;
  }
  /// The original's line; 0 for the mark.
  [[nodiscard]] std::uint32_t origin(std::uint32_t line) const noexcept {
    return line < origin_.size() ? origin_[line] : 0;
  }
  /// New lines in place of a line of the original; kNone where it is kept.
  [[nodiscard]] std::uint32_t in_place_of(std::uint32_t original_line) const noexcept {
    return original_line < new_lines_.size() ? new_lines_[original_line] : kNone;
  }
  /// The line of the changed program where this one of the original is, or was.
  [[nodiscard]] std::uint32_t place_of(std::uint32_t original_line) const noexcept;
  [[nodiscard]] std::uint64_t replaced() const noexcept { return replaced_; }
  [[nodiscard]] std::uint64_t fresh() const noexcept { return fresh_; }

  static constexpr std::uint32_t kNone = ~std::uint32_t{0};

 private:
  std::vector<Kind> kind_ = {Kind::head};
  std::vector<std::uint32_t> origin_ = {0};
  std::vector<std::uint32_t> new_lines_ = {kNone};  ///< by line of the original
  std::uint64_t replaced_ = 0;
  std::uint64_t fresh_ = 0;
};

}  // namespace steadyrest::nc::rewrite
