// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <exception>
#include <string>

#include <steadyrest/apps/page/cut/report.hpp>
#include <steadyrest/apps/page/cut/test/sample.hpp>
#include <steadyrest/apps/page/shared/provenance.hpp>
#include <steadyrest/apps/page/shared/write_files.hpp>

/// Writes a report into the directory that is named, for the browser test of the page.
int main(int argc, char** argv) {
  try {
    namespace page = steadyrest::apps::page;
    page::Json data = page::to_page(page::sample_report(2000));
    page::put_provenance(data, {.date = "2026-01-02T03:04:05Z",
                                .command = "steadyrest cut circle.mpf",
                                .inputs = {{.file = "circle.mpf", .sha256 = std::nullopt}}});
    const std::string json = page::text_of(data);
    const auto written = page::write_files(page::to_html(json), json, argc > 1 ? argv[1] : "");
    if (!written) {
      std::fputs(steadyrest::kernel::outcome::text(written.error()).c_str(), stderr);
      return 1;
    }
    return 0;
  } catch (const std::exception& error) {
    std::fputs(error.what(), stderr);
    return 1;
  }
}
