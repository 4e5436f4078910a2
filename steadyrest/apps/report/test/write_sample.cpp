// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <exception>
#include <string>

#include <steadyrest/apps/report/provenance.hpp>
#include <steadyrest/apps/report/report.hpp>
#include <steadyrest/apps/report/test/sample.hpp>
#include <steadyrest/apps/report/write_files.hpp>

/// Writes a report into the directory that is named, for the browser test of the page.
int main(int argc, char** argv) {
  try {
    namespace report = steadyrest::apps::report;
    report::Json page = report::to_page(report::sample_report(2000));
    report::put_provenance(page, {.date = "2026-01-02T03:04:05Z",
                                  .command = "steadyrest cut circle.mpf",
                                  .inputs = {{.file = "circle.mpf", .sha256 = std::nullopt}}});
    const std::string json = report::text_of(page);
    const auto written = report::write_files(report::to_html(json), json, argc > 1 ? argv[1] : "");
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
