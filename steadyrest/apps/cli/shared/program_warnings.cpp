// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <fmt/core.h>

#include <steadyrest/apps/cli/shared/program_warnings.hpp>

namespace steadyrest::apps::cli {

nc::plan::Known known_of(const ProgramOptions& options) {
  return {.offsets = !options.variables.empty(), .tools = !options.tools.empty()};
}

/// Ten for people, all that were kept for programs; `warning_count` also includes those not kept.
std::string put_warnings(Answer& answer, const std::vector<nc::plan::Warning>& warnings,
                         std::size_t count) {
  constexpr std::size_t kShown = 10;
  Json list = Json::array();
  for (const nc::plan::Warning& warning : warnings) {
    list.push_back({{"line", warning.line}, {"text", warning.text}});
  }
  answer.json["warnings"] = std::move(list);
  answer.json["warning_count"] = count;
  std::string text;
  for (std::size_t i = 0; i < std::min(warnings.size(), kShown); ++i) {
    text += fmt::format("warning: line {}: {}\n", warnings[i].line, warnings[i].text);
  }
  if (count > kShown) {
    text += fmt::format("… {} more warnings (--json has {})\n", count - kShown, warnings.size());
  }
  return text;
}

}  // namespace steadyrest::apps::cli
