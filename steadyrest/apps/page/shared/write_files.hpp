// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string_view>

#include <steadyrest/kernel/outcome/result.hpp>

/// The files of every report: report.html for people, report.json for programs.
namespace steadyrest::apps::page {

struct WrittenFiles {
  std::filesystem::path html;
  std::filesystem::path json;
};

/// Writes both files into `directory`, creating it if missing. Each appears whole or not at all,
/// and neither before both are on the disk.
[[nodiscard]] kernel::outcome::Result<WrittenFiles> write_files(
    std::string_view html, std::string_view json, const std::filesystem::path& directory);

}  // namespace steadyrest::apps::page
