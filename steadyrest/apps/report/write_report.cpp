// SPDX-License-Identifier: Apache-2.0
#include <steadyrest/apps/report/report.hpp>

namespace steadyrest::apps::report {

kernel::outcome::Result<WrittenFiles> write_report(const ReportData& data,
                                                   const std::filesystem::path& directory) {
  const std::string json = to_json(data);
  return write_files(to_html(json), json, directory);
}

}  // namespace steadyrest::apps::report
