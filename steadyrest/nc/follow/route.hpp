// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <steadyrest/kernel/signal/path.hpp>

namespace steadyrest::nc::follow {

/// The planned path of a program, with its segments by program line. Made outside of the cycle,
/// then only read.
class Route {
 public:
  explicit Route(std::vector<kernel::signal::PathSegment> path);

  [[nodiscard]] kernel::signal::PathView path() const noexcept { return path_; }
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
  std::vector<std::uint32_t> by_line_;  ///< segments, sorted by line
};

}  // namespace steadyrest::nc::follow
