// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <utility>

#include <fmt/core.h>

#include <steadyrest/apps/cli/shared/report_option.hpp>

// The session writes the page, not this file, since date, command and hashes belong to the whole
// run.
namespace steadyrest::apps::cli {

std::string add_report(Answer& answer, const std::string& directory, page::Json page) {
  const std::string html = (std::filesystem::path(directory) / "report.html").string();
  answer.pages.push_back({.folder = directory, .file = {}, .data = std::move(page)});
  answer.text += fmt::format("report: {}\n", html);
  return html;
}

void put_report(Answer& answer, const std::string& directory, page::Json page) {
  answer.json["report"] = add_report(answer, directory, std::move(page));
}

}  // namespace steadyrest::apps::cli
