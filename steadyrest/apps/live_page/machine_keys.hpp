// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include <steadyrest/apps/live_page/desk.hpp>

namespace steadyrest::apps::live_page {

/// The sections that the page offers for a change. Each key with its `value` in the key's unit
/// (`default`: it is not in the file), `unit`, `range` (or the words of a choice), `explanation`,
/// and whether it may change while the layer runs (`live`).
[[nodiscard]] Json sections_json(std::string_view text, const kernel::machine::Machine& machine);

}  // namespace steadyrest::apps::live_page
