// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include <steadyrest/apps/page/shared/page.hpp>

/// The pages of the chatter verbs.
///
/// A page is one object: `schema`, `version`, `kind`, `process`, the verb's --json output under
/// `answer`, and the page's own columns. Schema: web/src/chatter/data.ts.
namespace steadyrest::apps::page {

/// What every page begins with.
[[nodiscard]] Json chatter_head(std::string_view kind, std::string_view process,
                                const Json& answer);

}  // namespace steadyrest::apps::page
