// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string_view>

#include <steadyrest/kernel/outcome/result.hpp>

namespace steadyrest::apps::cli {

/// Writes the whole file anew; refuses (as unavailable) where that cannot be done.
[[nodiscard]] kernel::outcome::Result<void> write_text(const std::filesystem::path& path,
                                                       std::string_view text);

}  // namespace steadyrest::apps::cli
