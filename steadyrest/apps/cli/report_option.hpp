// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include <steadyrest/apps/cli/session.hpp>
#include <steadyrest/kernel/outcome/result.hpp>

/// `--report DIR` of the chatter and thermal verbs.
namespace steadyrest::apps::cli {

/// Writes the page with `page_json` inside and says in the answer where it is.
[[nodiscard]] kernel::outcome::Result<void> put_report(Answer& answer, const std::string& directory,
                                                       std::string_view page_json);
/// The same with another page than that of the chatter verbs.
[[nodiscard]] kernel::outcome::Result<void> put_report(Answer& answer, const std::string& directory,
                                                       std::string_view page_json,
                                                       std::string_view html);

}  // namespace steadyrest::apps::cli
