// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <steadyrest/kernel/signal/path.hpp>

namespace steadyrest::nc::follow {

/// The planned path of a program, with its segments by program line. Made outside of the cycle,
/// then only read.
class Route {
 public:
  /// `from_start`: the segments whose place follows from where the axes stood at the program's
  /// start; empty: none.
  /// `original`: the path that the part should have, where the program's text corrects it.
  explicit Route(std::vector<kernel::signal::PathSegment> path, std::vector<bool> from_start = {},
                 std::vector<kernel::signal::PathSegment> original = {});

  [[nodiscard]] kernel::signal::PathView path() const noexcept { return path_; }
  [[nodiscard]] kernel::signal::PathView original() const noexcept { return original_; }
  [[nodiscard]] bool from_start(std::size_t index) const noexcept {
    return index < from_start_.size() && from_start_[index];
  }
  /// The segments of a program line, in the order of the path; of a line without one, those of the
  /// nearest line before it: a control merges short blocks.
  [[nodiscard]] std::span<const std::uint32_t> of_line(std::uint32_t line) const noexcept;
  /// The segments of the next line that has any. A merged block ends just before one of these, in
  /// whichever pass of a loop it was merged.
  [[nodiscard]] std::span<const std::uint32_t> after_line(std::uint32_t line) const noexcept;
  /// The nearest line below that has a segment; `line` itself where none has.
  [[nodiscard]] std::uint32_t line_before(std::uint32_t line) const noexcept;

 private:
  std::vector<kernel::signal::PathSegment> path_;
  std::vector<kernel::signal::PathSegment> original_;
  std::vector<bool> from_start_;
  std::vector<std::uint32_t> by_line_;  ///< segments, sorted by line
};

}  // namespace steadyrest::nc::follow
