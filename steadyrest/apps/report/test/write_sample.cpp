// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <exception>
#include <string>

#include <steadyrest/apps/report/report.hpp>
#include <steadyrest/apps/report/test/sample.hpp>

/// Writes a report into the directory that is named, for the browser test of the page.
int main(int argc, char** argv) {
  try {
    const auto written = steadyrest::apps::report::write_report(
        steadyrest::apps::report::sample_report(2000), argc > 1 ? argv[1] : "");
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
