// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace steadyrest::nc::rewrite {

/// The numbers of the inserted lines of a changed program, for lookups while it runs: cheap for
/// consecutive lines.
class InsertedLines {
 public:
  InsertedLines() = default;
  /// `lines` ascend.
  explicit InsertedLines(std::vector<std::uint32_t> lines) : lines_(std::move(lines)) {}

  [[nodiscard]] bool has(std::uint32_t line) noexcept {
    while (before_ > 0 && lines_[before_ - 1] >= line) {
      --before_;
    }
    while (before_ < lines_.size() && lines_[before_] < line) {
      ++before_;
    }
    return before_ < lines_.size() && lines_[before_] == line;
  }
  /// How many precede the line looked up last.
  [[nodiscard]] std::uint32_t before() const noexcept {
    return static_cast<std::uint32_t>(before_);
  }
  [[nodiscard]] std::size_t size() const noexcept { return lines_.size(); }

 private:
  std::vector<std::uint32_t> lines_;
  std::size_t before_ = 0;
};

}  // namespace steadyrest::nc::rewrite
