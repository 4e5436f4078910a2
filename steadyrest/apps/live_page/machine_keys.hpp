// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include <steadyrest/apps/live_page/desk.hpp>

namespace steadyrest::apps::live_page {

/// The sections that the page offers for a change, each key with `value` (null: not in the file,
/// the default holds), `unit`, `range`, `words` of a choice, `explanation` and whether it may
/// change while the layer runs.
[[nodiscard]] Json sections_json(std::string_view text);

}  // namespace steadyrest::apps::live_page
