// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cctype>
#include <chrono>
#include <ctime>
#include <filesystem>
#include <iterator>
#include <string_view>
#include <system_error>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/record/run_folder.hpp>

namespace steadyrest::record {
namespace {

namespace fs = std::filesystem;
using kernel::outcome::refuse;
using kernel::outcome::Result;

constexpr const char* kBeside[] = {"-wal", "-shm", "-journal"};

std::uint64_t size_of(const fs::path& file) {
  std::error_code error;
  const auto bytes = fs::file_size(file, error);
  return error ? 0 : bytes;
}

constexpr auto kLately = std::chrono::seconds(10);

constexpr std::string_view kEnding = ".sqlite";

std::string_view stem_of(std::string_view name) {
  return name.substr(0, name.size() - std::min(name.size(), kEnding.size()));
}

bool is_digit(char c) {
  return std::isdigit(static_cast<unsigned char>(c)) != 0;
}

/// `#` is a digit; a run's number may follow.
bool is_run_name(std::string_view name) {
  constexpr std::string_view kForm = "run-########T######Z";
  const std::string_view stem = stem_of(name);
  const std::string_view number = stem.substr(std::min(stem.size(), kForm.size()));
  return name.ends_with(kEnding) &&
         std::ranges::equal(
             stem.substr(0, kForm.size()), kForm,
             [](char c, char form) { return form == '#' ? is_digit(c) : c == form; }) &&
         (number.empty() || (number.size() > 1 && number[0] == '-' &&
                             std::ranges::all_of(number.substr(1), is_digit)));
}

std::string named(std::string name, const std::string& utc, int number = 1) {
  std::ranges::copy_if(utc, std::back_inserter(name), [](char c) { return c != '-' && c != ':'; });
  return name + (number > 1 ? "-" + std::to_string(number) : "") + ".sqlite";
}

}  // namespace

std::string utc_now() {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  char text[32];
  const std::size_t length = std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &utc);
  return {text, length};
}

std::string run_name(const std::string& utc, int number) {
  return named("run-", utc, number);
}

std::string fault_name(const std::string& utc, int number) {
  return named("fault-", utc, number);
}

Result<std::vector<RunFile>> run_files(const std::string& folder) {
  std::error_code error;
  fs::directory_iterator entries(folder, error);
  if (error) {
    return refuse(folder, "is no folder that can be read: " + error.message(),
                  "name the folder of the records");
  }
  std::vector<RunFile> files;
  for (const fs::directory_iterator end; entries != end && !error; entries.increment(error)) {
    const fs::path& path = entries->path();
    if (path.extension() != ".sqlite") {
      continue;
    }
    RunFile file{.file = path.string(),
                 .bytes = size_of(path),
                 .rotates = is_run_name(path.filename().string())};
    for (const char* const beside : kBeside) {
      file.bytes += size_of(path.string() + beside);
    }
    files.push_back(std::move(file));
  }
  // A second run of the same second has the longer name and comes after the first.
  std::ranges::sort(files, {}, [](const RunFile& file) { return stem_of(file.file); });
  return files;
}

// By the times of the files alone: a lock would also be a reader's, and to look for it would drop
// those of this process.
bool written_lately(const std::string& file) {
  const auto now = fs::file_time_type::clock::now();
  return std::ranges::any_of(std::array{file, file + "-wal"}, [&](const std::string& at) {
    std::error_code error;
    const auto written = fs::last_write_time(at, error);
    return !error && std::chrono::abs(now - written) < kLately;
  });
}

void rotate(const std::string& current, std::uint64_t max_bytes) {
  const fs::path folder = fs::path(current).parent_path();
  const auto files = run_files(folder.empty() ? "." : folder.string());
  if (!files) {
    return;
  }
  std::uint64_t bytes = 0;
  for (const RunFile& file : *files) {
    bytes += file.bytes;
  }
  for (const RunFile& file : *files) {
    std::error_code error;
    if (bytes <= max_bytes) {
      return;
    }
    if (!file.rotates || fs::equivalent(file.file, current, error) ||
        !fs::remove(file.file, error)) {
      continue;
    }
    for (const char* const beside : kBeside) {
      fs::remove(file.file + beside, error);
    }
    bytes -= file.bytes;
  }
}

}  // namespace steadyrest::record
