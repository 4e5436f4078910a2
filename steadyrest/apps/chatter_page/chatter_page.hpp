// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

/// The pages of the chatter verbs: one template from web/, whose data say which page it is.
///
/// report.json is one object: `schema`, `version`, `kind`, `process`, under `answer` what the verb
/// prints with --json, and the page's own columns. Schema: web/src/chatter/data.ts.
namespace steadyrest::apps::chatter_page {

using Json = nlohmann::ordered_json;

/// What every page begins with.
[[nodiscard]] Json page_head(std::string_view kind, std::string_view process, const Json& answer);

/// In one line; what is not finite becomes null, bytes that are not UTF-8 the replacement
/// character.
[[nodiscard]] std::string text_of(const Json& page);

/// The page with the JSON inside; it opens from disk.
[[nodiscard]] std::string to_html(std::string_view json);

}  // namespace steadyrest::apps::chatter_page
