// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "rules.hpp"

/// Where a folder belongs in the house.
namespace house {

[[nodiscard]] bool is_within(std::string_view path, std::string_view folder);

struct Location {
  const Place* place = nullptr;
  std::string folder;
};

/// The place of a folder (relative to the root); the longest entry counts.
[[nodiscard]] std::optional<Location> locate(const Rules& rules, std::string_view folder);

/// The rank of the shelf that a folder is on, or is itself; anything outside the shelves is above
/// them.
[[nodiscard]] std::size_t shelf_rank(const Location& at, std::string_view folder);

/// The folder whose name is the namespace: the place itself for anything on one of its shelves.
[[nodiscard]] std::string home_of(const Rules& rules, const std::string& folder);

/// `contour/online` for `steadyrest/contour/online/x.hpp`; nothing for files outside the root.
[[nodiscard]] std::optional<std::string> folder_under_root(const Rules& rules,
                                                           std::string_view path);

[[nodiscard]] bool is_cpp(std::string_view path);

/// Whether the file runs in the control cycle.
[[nodiscard]] bool is_in_cycle(const Rules& rules, std::string_view path);

}  // namespace house
