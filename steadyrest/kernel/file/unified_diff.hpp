// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace steadyrest::kernel::file {

/// Lines with their ends; only the last may have none. Joined they are the text again.
[[nodiscard]] std::vector<std::string> lines_of(std::string_view text);

/// A unified diff of two texts, for people to see and for `patch`. A text that is not there is
/// /dev/null's. Empty where nothing differs.
[[nodiscard]] std::string unified_diff(const std::string& file,
                                       const std::optional<std::string>& before,
                                       const std::optional<std::string>& after);

}  // namespace steadyrest::kernel::file
