// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <string>
#include <utility>

#include <steadyrest/apps/page/shared/write_files.hpp>
#include <steadyrest/kernel/file/output_file.hpp>

// report.html and report.json belong together: a program must not find new data next to an old
// page.
namespace steadyrest::apps::page {
namespace fs = std::filesystem;
using kernel::outcome::Kind;
using kernel::outcome::Refusal;
using kernel::outcome::Result;

Result<WrittenFiles> write_files(std::string_view html, std::string_view json,
                                 const fs::path& directory) {
  const auto made = kernel::file::MadeFolders::make(directory);
  if (!made) {
    Refusal refused = made.error();
    refused.to_do += " with --report";
    return std::unexpected(std::move(refused));
  }
  WrittenFiles files{.html = directory / "report.html", .json = directory / "report.json"};
  const std::array out = {
      kernel::file::FileText{.file = files.json.string(), .text = std::string(json) + "\n"},
      kernel::file::FileText{.file = files.html.string(), .text = std::string(html)}};
  if (auto written = kernel::file::write_files(out); !written) {
    Refusal refused = std::move(written.error());
    refused.kind = Kind::unavailable;  // the caller named only the folder
    return std::unexpected(std::move(refused));
  }
  return files;
}

}  // namespace steadyrest::apps::page
