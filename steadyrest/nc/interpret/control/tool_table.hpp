// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include <steadyrest/nc/interpret/control/control.hpp>

namespace steadyrest::nc::interpret {

/// Without a table every tool exists with length 0; with one, tool 0 always does. nullptr: no such
/// tool.
[[nodiscard]] const Tool* find_tool(const Config& config, std::int32_t number) noexcept;

/// The table's own entry, for changes.
[[nodiscard]] Tool* place_of_tool(Config& config, std::int32_t number);

/// The number in a word; refused when there is no such tool.
bool tool_number(Control& control, const Step& step, char letter, std::int32_t& number);

/// #5401 … show the tool of the last change; rs274 leaves them as they are at T0 M6.
void load_tool(Control& control);

}  // namespace steadyrest::nc::interpret
