// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <steadyrest/apps/cli/shared/session.hpp>

/// `--report DIR`.
namespace steadyrest::apps::cli {

/// Hands the page to the session, which writes it into `directory`, and states its place in the
/// answer.
void put_report(Answer& answer, const std::string& directory, page::Json page);
/// The same for an additional report: only in the answer's text; returns its name.
std::string add_report(Answer& answer, const std::string& directory, page::Json page);

}  // namespace steadyrest::apps::cli
