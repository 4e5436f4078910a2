// SPDX-License-Identifier: Apache-2.0
#include "file_check.hpp"

#include <algorithm>
#include <utility>

#include "place.hpp"

namespace house {
namespace {

void check_spdx(FileCheck& check) {
  std::string_view text = check.file.text;
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

/// The variable may move the shared data; a test that knows no other place is skipped for ever.
void check_shared_data(FileCheck& check) {
  const std::string& text = check.file.text;
  const std::size_t at = text.find("getenv(\"STEADYREST_SHARED_DATA\")");
  if (at != std::string::npos && text.find("shared/data") == std::string::npos) {
    check.report("shared-data", line_of(text, at),
                 "read the data in ../shared/data where the variable is not set");
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
