// SPDX-License-Identifier: Apache-2.0
#include "file_check.hpp"

#include <algorithm>
#include <utility>

#include "place.hpp"

// Rules that a single file can be checked for. Comments and literals are blanked first where a word
// in them must not count.
namespace house {
namespace {

void check_spdx(FileCheck& check) {
  std::string_view text = check.file.text;
  // A script's first line must stay its shebang.
  if (text.starts_with("#!")) {
    text.remove_prefix(std::min(text.find('\n'), text.size() - 1) + 1);
  }
  for (const std::string_view comment : {"// ", "# ", "<!-- ", "/* "}) {
    if (text.starts_with(std::string(comment) + "SPDX-License-Identifier: Apache-2.0")) {
      return;
    }
  }
  check.report("spdx", 1, "the first line must be the SPDX line of Apache-2.0");
}

/// The variable may move the shared data; a test that ignores it would be skipped forever.
void check_shared_data(FileCheck& check) {
  const std::string& text = check.file.text;
  const std::size_t at = text.find("getenv(\"STEADYREST_SHARED_DATA\")");
  if (at != std::string::npos && text.find("shared/data") == std::string::npos) {
    check.report("shared-data", line_of(text, at),
                 "read the data in ../shared/data where the variable is not set");
  }
}

void check_length(FileCheck& check) {
  const std::string& path = check.file.path;
  const std::size_t lines = lines_in(check.file.text);
  const std::size_t most = check.rules.most_lines;
  if (lines > most && (is_cpp(path) || path.ends_with(".ts") || path.ends_with(".py"))) {
    check.report("long-file", most + 1,
                 std::to_string(lines) + " lines, at most " + std::to_string(most) +
                     ": split it by what it does");
  }
}

}  // namespace

void FileCheck::report(std::string_view rule, std::size_t line, std::string what) {
  found.push_back({std::string(rule), file.path, line, std::move(what)});
}

std::vector<Violation> check_file(const SourceFile& file, const Rules& rules) {
  const auto folder = folder_under_root(rules, file.path);
  FileCheck check{.file = file,
                  .rules = rules,
                  .folder = folder.value_or(""),
                  .blanked = blank_comments_and_literals(file.text),
                  .found = {}};
  check_spdx(check);
  check_shared_data(check);
  check_length(check);
  if (folder && is_cpp(file.path)) {
    check_includes(check);
    check_namespaces(check);
    if (is_in_cycle(rules, file.path)) {
      check_code_in_cycle(check);
    }
  }
  return std::move(check.found);
}

}  // namespace house
