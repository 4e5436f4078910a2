// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <iterator>
#include <map>
#include <set>

#include "place.hpp"
#include "rules.hpp"

// The rules that need more than one file.
namespace house {

std::vector<Violation> check_built(const std::vector<SourceFile>& tree, const Rules& rules) {
  std::vector<Violation> found;
  for (const SourceFile& file : tree) {
    if (!file.path.ends_with(".cpp") || !is_within(file.path, rules.root)) {
      continue;
    }
    // A list names sources relative to its own folder.
    const bool named = std::ranges::any_of(tree, [&](const SourceFile& list) {
      const std::string_view folder = folder_of(list.path);
      return list.path.ends_with("CMakeLists.txt") && is_within(file.path, folder) &&
             list.text.find(file.path.substr(folder.size() + 1)) != std::string::npos;
    });
    if (!named) {
      found.push_back({"unbuilt", file.path, 1, "no CMakeLists.txt above it names it"});
    }
  }
  return found;
}

std::vector<Violation> check_crowded(const std::vector<SourceFile>& tree, const Rules& rules) {
  std::map<std::string, std::set<std::string>> folders;
  for (const SourceFile& file : tree) {
    if (is_cpp(file.path)) {
      // Without the ending, so a header and its source are one.
      folders[std::string(folder_of(file.path))].insert(file.path.substr(0, file.path.rfind('.')));
    }
  }
  std::vector<Violation> found;
  for (const auto& [folder, files] : folders) {
    if (files.size() > rules.most_files) {
      found.push_back({"crowded", folder, 1,
                       std::to_string(files.size()) + " files (a pair counts once), at most " +
                           std::to_string(rules.most_files) + ": make shelves"});
    }
  }
  return found;
}

std::vector<Violation> check_tree(const std::vector<SourceFile>& tree, const Rules& rules) {
  std::vector<Violation> found = check_built(tree, rules);
  std::ranges::move(check_crowded(tree, rules), std::back_inserter(found));
  std::ranges::move(check_stages(tree, rules), std::back_inserter(found));
  for (const SourceFile& file : tree) {
    std::ranges::move(check_file(file, rules), std::back_inserter(found));
  }
  return found;
}

}  // namespace house
