// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

/// The one page for all reports, built from web/: its data decide what it shows.
namespace steadyrest::apps::page {

using Json = nlohmann::ordered_json;

/// What every page begins with: `schema` (`steadyrest-chatter/1`, …) and `version`; web/src/main.ts
/// knows each schema.
[[nodiscard]] Json page_head(std::string_view schema);

/// On one line; non-finite values become null, bytes that are not UTF-8 the replacement character.
[[nodiscard]] std::string text_of(const Json& page);

/// The page with the JSON inside. It opens from disk, without any server, and nothing in the data
/// can break out of its script element.
[[nodiscard]] std::string to_html(std::string_view json);

}  // namespace steadyrest::apps::page
