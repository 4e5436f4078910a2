// SPDX-License-Identifier: Apache-2.0
#include <fstream>
#include <ios>
#include <string>
#include <system_error>
#include <utility>

#include <unistd.h>

#include <steadyrest/apps/report/write_files.hpp>

namespace steadyrest::apps::report {
namespace {

namespace fs = std::filesystem;
using kernel::outcome::Kind;
using kernel::outcome::Refusal;
using kernel::outcome::Result;

Refusal refusal(Kind kind, const fs::path& path, std::string what, std::string to_do) {
  return {.kind = kind,
          .file = path.string(),
          .line = 0,
          .what = std::move(what),
          .to_do = std::move(to_do)};
}

/// Writes beside the target and renames: whoever reads `path` sees the old file or the new one.
Result<void> write_whole(const fs::path& path, std::string_view text) {
  const fs::path beside = path.string() + ".part-" + std::to_string(::getpid());
  std::ofstream out(beside, std::ios::binary | std::ios::trunc);
  out.write(text.data(), static_cast<std::streamsize>(text.size()));
  out.close();
  std::error_code error;
  if (out) {
    fs::rename(beside, path, error);
    if (!error) {
      return {};
    }
  }
  const std::string why = error ? error.message() : "the write failed";
  fs::remove(beside, error);
  return std::unexpected(refusal(Kind::unavailable, path, "the report could not be written: " + why,
                                 "see whether the disk is full and the name is free"));
}

}  // namespace

Result<void> make_directory(const fs::path& directory) {
  std::error_code error;
  fs::create_directories(directory, error);
  if (!fs::is_directory(directory)) {
    const std::string why = fs::exists(fs::symlink_status(directory)) && !error
                                ? "it is not a directory"
                                : error.message();
    return std::unexpected(refusal(Kind::bad_input, directory,
                                   "the directory of the report cannot be made: " + why,
                                   "name another directory with --report"));
  }
  if (::access(directory.c_str(), W_OK | X_OK) != 0) {
    return std::unexpected(refusal(Kind::bad_input, directory,
                                   "the directory of the report cannot be written",
                                   "give it write permission or name another one with --report"));
  }
  return {};
}

Result<WrittenFiles> write_files(std::string_view html, std::string_view json,
                                 const fs::path& directory) {
  if (const auto made = make_directory(directory); !made) {
    return std::unexpected(made.error());
  }
  WrittenFiles files{.html = directory / "report.html", .json = directory / "report.json"};
  if (const auto written = write_whole(files.json, std::string(json) + "\n"); !written) {
    return std::unexpected(written.error());
  }
  if (const auto written = write_whole(files.html, html); !written) {
    return std::unexpected(written.error());
  }
  return files;
}

}  // namespace steadyrest::apps::report
