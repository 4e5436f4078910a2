// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <steadyrest/apps/chatter_page/chatter_page.hpp>
#include <steadyrest/apps/cli/report_option.hpp>
#include <steadyrest/apps/report/write_files.hpp>

namespace steadyrest::apps::cli {

using kernel::outcome::Result;

Result<void> put_report(Answer& answer, const std::string& directory, std::string_view page_json) {
  return put_report(answer, directory, page_json, chatter_page::to_html(page_json));
}

Result<void> put_report(Answer& answer, const std::string& directory, std::string_view page_json,
                        std::string_view html) {
  const auto written = report::write_files(html, page_json, directory);
  if (!written) {
    return std::unexpected(written.error());
  }
  answer.json["report"] = written->html.string();
  answer.text += fmt::format("report: {}\n", written->html.string());
  return {};
}

}  // namespace steadyrest::apps::cli
