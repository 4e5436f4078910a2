// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>
#include <optional>
#include <regex>
#include <string>
#include <string_view>
#include <vector>

#include "rules.hpp"

// Members that the supervisor's headers hold and update in the cycle have one shape.
namespace house {
namespace {

struct Class {
  std::string path;
  std::size_t line = 0;
  std::string body;
};

/// From the brace at `open` to its partner. Literals are blanked, so no brace in a string counts.
std::string_view braced(std::string_view blanked, std::size_t open) {
  std::size_t depth = 0;
  for (std::size_t at = open; at < blanked.size(); ++at) {
    depth += blanked[at] == '{' ? 1U : 0U;
    depth -= blanked[at] == '}' ? 1U : 0U;
    if (depth == 0) {
      return blanked.substr(open, at - open);
    }
  }
  return blanked.substr(open);
}

/// The classes that a header defines, including nested ones.
void collect(const SourceFile& file, std::map<std::string, Class>& classes) {
  const std::string blanked = blank_comments_and_literals(file.text);
  const auto all = words(blanked);
  for (std::size_t i = 0; i + 1 < all.size(); ++i) {
    if (all[i].text != "class" && all[i].text != "struct") {
      continue;
    }
    const std::size_t stop = blanked.find_first_of(";{(", all[i + 1].offset);
    if (stop == std::string::npos || blanked[stop] != '{') {
      continue;
    }
    const std::string_view body = braced(blanked, stop);
    if (body.find(" update(") != std::string_view::npos) {
      classes.emplace(all[i + 1].text,
                      Class{file.path, line_of(blanked, all[i].offset), std::string(body)});
    }
  }
}

/// Types of the data members that a header declares; a lookalike matches no class and drops out.
std::vector<std::string> held_in(const SourceFile& file) {
  static const std::regex kMember(R"((\w+)>?\s+\w+\s*(;|=|\{))");
  const std::string blanked = blank_comments_and_literals(file.text);
  std::vector<std::string> types;
  for (auto at = std::sregex_iterator(blanked.begin(), blanked.end(), kMember);
       at != std::sregex_iterator(); ++at) {
    types.push_back((*at)[1].str());
  }
  return types;
}

bool is_header_within(const SourceFile& file, std::string_view folder) {
  return file.path.starts_with(folder) && file.path.ends_with(".hpp") &&
         !has_folder(file.path, "test");
}

std::optional<std::string> lacks(const Class& stage, const std::vector<std::string>& shape) {
  for (const std::string& part : shape) {
    if (stage.body.find(part) == std::string::npos) {
      return part;
    }
  }
  return std::nullopt;
}

}  // namespace

std::vector<Violation> check_stages(const std::vector<SourceFile>& tree, const Rules& rules) {
  std::map<std::string, Class> classes;
  for (const SourceFile& file : tree) {
    if (is_header_within(file, rules.root + "/")) {
      collect(file, classes);
    }
  }
  std::vector<Violation> found;
  for (const SourceFile& file : tree) {
    if (rules.stage_folder.empty() || !is_header_within(file, rules.stage_folder + "/")) {
      continue;
    }
    for (const std::string& type : held_in(file)) {
      const auto stage = classes.find(type);
      if (stage == classes.end()) {
        continue;
      }
      if (const auto part = lacks(stage->second, rules.stage_shape)) {
        found.push_back({"stage", stage->second.path, stage->second.line,
                         type + " lacks '" + *part + "', and " + file.path + " holds it"});
      }
      // Reported once, however many members have the type.
      classes.erase(stage);
    }
  }
  return found;
}

}  // namespace house
