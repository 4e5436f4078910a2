// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <steadyrest/apps/page/shared/page.hpp>
#include <steadyrest/kernel/outcome/result.hpp>

/// When, by what command and from what files a report was made.
namespace steadyrest::apps::page {

struct InputFile {
  std::string file;                   ///< as named on the command line or in one of its files
  std::optional<std::string> sha256;  ///< empty: not a file that could be read twice (stdin)
};

struct Provenance {
  std::optional<std::string> date;  ///< ISO 8601; empty: left out, so that bytes repeat
  std::string command;              ///< as for a shell, without the program's path
  std::vector<InputFile> inputs;
};

/// The command line on one line, words quoted where a shell would split them.
[[nodiscard]] std::string command_of(int argc, const char* const* argv);

/// Now, in UTC, to the second: 2026-01-02T03:04:05Z.
[[nodiscard]] std::string now_utc();

/// Whether it is a date of ISO 8601, with or without a time (to the minute or second) and a zone.
[[nodiscard]] bool is_iso_date(std::string_view text);

/// SHA-256 (FIPS 180-4) of the file's content, 64 hexadecimal digits; empty if it is not a readable
/// regular file.
[[nodiscard]] std::optional<std::string> sha256_of_file(const std::string& file);

/// Into the page, under `made`.
void put_provenance(Json& page, const Provenance& provenance);

}  // namespace steadyrest::apps::page
