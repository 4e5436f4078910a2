// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <steadyrest/apps/cli/shared/session.hpp>

/// `--report DIR`.
namespace steadyrest::apps::cli {

/// Hands the page to the session, which writes it into `directory`, and says in the answer where it
/// will be.
void put_report(Answer& answer, const std::string& directory, page::Json page);
/// The same for a report beside the main one: in the answer's text alone; gives its name.
std::string add_report(Answer& answer, const std::string& directory, page::Json page);

}  // namespace steadyrest::apps::cli
