// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

namespace steadyrest::kernel::file {

/// JSON that somebody else has written. Nothing where it is no object, or where lists and objects
/// are nested more than 32 deep: copies of such a value go as deep down the stack.
[[nodiscard]] std::optional<nlohmann::ordered_json> json_object(std::string_view text);

/// Why a text is not JSON, and in which line: its form, or a number that no double can hold.
struct JsonFault {
  std::size_t line = 0;
  std::string what;
};
/// Nothing: the text is JSON.
[[nodiscard]] std::optional<JsonFault> json_fault(std::string_view text);

}  // namespace steadyrest::kernel::file
