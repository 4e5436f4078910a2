// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>

#include <nlohmann/json.hpp>

namespace steadyrest::kernel::file {

/// JSON that somebody else has written. Nothing where it is no object, or where lists and objects
/// are nested more than 32 deep: copies of such a value go as deep down the stack.
[[nodiscard]] std::optional<nlohmann::ordered_json> json_object(std::string_view text);

}  // namespace steadyrest::kernel::file
