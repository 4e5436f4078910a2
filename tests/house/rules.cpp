// SPDX-License-Identifier: Apache-2.0
#include "rules.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <map>
#include <set>
#include <utility>

#include <toml++/toml.h>

namespace house {
namespace {

bool is_within(std::string_view path, std::string_view folder) {
  return path == folder ||
         (path.starts_with(folder) && path.substr(folder.size()).starts_with('/'));
}

/// The actual folder that a pattern with one trailing `*` covers: `adapters/*` and
/// `adapters/replay/x` give `adapters/replay`.
std::optional<std::string> covered(std::string_view pattern, std::string_view folder) {
  if (!pattern.ends_with("/*")) {
    return is_within(folder, pattern) ? std::optional(std::string(pattern)) : std::nullopt;
  }
  const std::string_view stem = pattern.substr(0, pattern.size() - 1);
  if (!folder.starts_with(stem) || folder.size() == stem.size()) {
    return std::nullopt;
  }
  return std::string(folder.substr(0, folder.find('/', stem.size())));
}

struct Location {
  const Place* place = nullptr;
  std::string folder;
};

/// Where a folder (relative to the root) stands; the longest entry counts.
std::optional<Location> locate(const Rules& rules, std::string_view folder) {
  std::optional<Location> best;
  for (const Place& place : rules.places) {
    auto actual = covered(place.folder, folder);
    if (actual && (!best || actual->size() > best->folder.size())) {
      best = Location{&place, *std::move(actual)};
    }
  }
  return best;
}

/// The shelf that a folder lies on, or is.
std::optional<std::size_t> shelf_of(const Location& at, std::string_view folder) {
  for (std::size_t i = 0; i < at.place->shelves.size(); ++i) {
    if (is_within(folder, at.folder + "/" + at.place->shelves[i])) {
      return i;
    }
  }
  return std::nullopt;
}

std::size_t shelf_rank(const Location& at, std::string_view folder) {
  return shelf_of(at, folder).value_or(at.place->shelves.size());
}

/// The folder whose name is the namespace: the place for what lies on a shelf of it.
std::string home_of(const Rules& rules, const std::string& folder) {
  std::string home = folder;
  if (home.ends_with("/test")) {
    home.resize(home.size() - 5);
  }
  const auto at = locate(rules, folder);
  return at && shelf_of(*at, home) ? at->folder : home;
}

/// `contour/online` for `steadyrest/contour/online/x.hpp`; nothing for what is not ours.
std::optional<std::string> folder_under_root(const Rules& rules, std::string_view path) {
  if (!is_within(path, rules.root) || path.size() == rules.root.size()) {
    return std::nullopt;
  }
  path.remove_prefix(rules.root.size() + 1);
  return std::string(folder_of(path));
}

bool is_permitted(const Place& place, std::string_view target_folder) {
  return std::ranges::any_of(place.includes, [&](std::string_view allowed) {
    return allowed == "*" || is_within(target_folder, allowed);
  });
}

bool is_cpp(std::string_view path) {
  return path.ends_with(".hpp") || path.ends_with(".cpp");
}

bool is_in_cycle(const Rules& rules, std::string_view path) {
  if (has_folder(path, "test") || has_folder(path, "testing")) {
    return false;
  }
  return std::ranges::any_of(rules.in_cycle_folders, [&](std::string_view folder) {
    return folder.find('/') != std::string_view::npos ? is_within(path, folder)
                                                      : has_folder(path, folder);
  });
}

bool header_matches(std::string_view pattern, std::string_view header) {
  return pattern.ends_with('*') ? header.starts_with(pattern.substr(0, pattern.size() - 1))
                                : header == pattern;
}

class FileCheck {
 public:
  FileCheck(const SourceFile& file, const Rules& rules)
      : file_(file), rules_(rules), blanked_(blank_comments_and_literals(file.text)) {}

  std::vector<Violation> run() {
    check_spdx();
    check_shared_data();
    const auto folder = folder_under_root(rules_, file_.path);
    if (!folder || !is_cpp(file_.path)) {
      return std::move(found_);
    }
    check_includes(*folder);
    check_namespaces();
    if (is_in_cycle(rules_, file_.path)) {
      check_words();
      check_loops();
      if (file_.path.ends_with(".hpp")) {
        check_noexcept();
      }
    }
    return std::move(found_);
  }

 private:
  void report(std::string_view rule, std::size_t line, std::string what) {
    found_.push_back({std::string(rule), file_.path, line, std::move(what)});
  }

  void check_spdx() {
    std::string_view text = file_.text;
    if (text.starts_with("#!")) {
      text.remove_prefix(std::min(text.find('\n'), text.size() - 1) + 1);
    }
    for (const std::string_view comment : {"// ", "# ", "<!-- ", "/* "}) {
      if (text.starts_with(std::string(comment) + "SPDX-License-Identifier: Apache-2.0")) {
        return;
      }
    }
    report("spdx", 1, "the first line must be the SPDX line of Apache-2.0");
  }

  /// The variable may move the shared data; a test that knows no other place is skipped for ever.
  void check_shared_data() {
    const std::size_t at = file_.text.find("getenv(\"STEADYREST_SHARED_DATA\")");
    if (at != std::string::npos && file_.text.find("shared/data") == std::string::npos) {
      report("shared-data", line_of(file_.text, at),
             "read the data in ../shared/data where the variable is not set");
    }
  }

  void check_includes(const std::string& folder) {
    const auto here = locate(rules_, folder);
    if (!here) {
      report("place", 1, "the folder " + folder + " has no place in floors.toml");
      return;
    }
    const bool in_cycle = is_in_cycle(rules_, file_.path);
    for (const Include& include : includes(file_.text)) {
      if (in_cycle) {
        check_in_cycle_header(include);
      }
      const auto target = folder_under_root(rules_, include.target);
      if (!target) {
        if (include.quoted) {
          report("quoted-include", include.line,
                 "\"" + include.target + "\": own headers are <" + rules_.root + "/…>");
        }
        continue;
      }
      check_floor(*here, *target, include);
      check_half(*target, include);
    }
  }

  void check_floor(const Location& here, const std::string& target, const Include& include) {
    const auto there = locate(rules_, target);
    if (!there) {
      report("place", include.line, include.target + " has no place in floors.toml");
      return;
    }
    if (is_within(target, here.folder)) {
      check_shelf(here, target, include);
      return;
    }
    const bool higher = there->place->floor > here.place->floor;
    if (higher || !is_permitted(*here.place, target)) {
      report("floor", include.line,
             here.folder + " (F" + std::to_string(here.place->floor) + ") must not include " +
                 include.target + " (F" + std::to_string(there->place->floor) + ")");
    }
  }

  /// Within a place with shelves: only what lies lower. Tests may use the helpers of other tests.
  void check_shelf(const Location& here, const std::string& target, const Include& include) {
    if (has_folder(file_.path, "test") || has_folder(include.target, "test")) {
      return;
    }
    const auto folder = folder_under_root(rules_, file_.path);
    if (shelf_rank(here, target) > shelf_rank(here, *folder)) {
      report(
          "shelf", include.line,
          *folder + " must not include " + include.target + ", a higher shelf of " + here.folder);
    }
  }

  void check_half(const std::string& target, const Include& include) {
    if (has_folder(file_.path, "online") && has_folder(target + "/", "offline")) {
      report("half", include.line, "online must not include offline: " + include.target);
    }
  }

  void check_in_cycle_header(const Include& include) {
    for (const std::string& pattern : rules_.in_cycle_headers) {
      if (header_matches(pattern, include.target)) {
        report("in-cycle", include.line, "<" + include.target + "> has no business in the cycle");
      }
    }
  }

  void check_words() {
    for (const Word& word : words(blanked_)) {
      if (std::ranges::find(rules_.in_cycle_words, word.text) != rules_.in_cycle_words.end() &&
          !is_in_preprocessor_line(word.offset)) {
        report("in-cycle", line_of(blanked_, word.offset),
               "'" + std::string(word.text) + "' has no business in the cycle");
      }
    }
  }

  /// <new> as a header is fine; check_in_cycle_header looks at headers.
  [[nodiscard]] bool is_in_preprocessor_line(std::size_t offset) const {
    const std::size_t newline = blanked_.rfind('\n', offset);
    const std::size_t start = newline == std::string::npos ? 0 : newline + 1;
    const std::size_t first = blanked_.find_first_not_of(" \t", start);
    return first != std::string::npos && blanked_[first] == '#';
  }

  void check_loops() {
    std::string dense;
    std::vector<std::size_t> origin;
    for (std::size_t i = 0; i < blanked_.size(); ++i) {
      if (blanked_[i] != ' ' && blanked_[i] != '\n') {
        dense += blanked_[i];
        origin.push_back(i);
      }
    }
    for (const std::string_view loop : {"while(true)", "while(1)", "for(;;)"}) {
      for (std::size_t at = dense.find(loop); at != std::string::npos;
           at = dense.find(loop, at + 1)) {
        report("in-cycle", line_of(blanked_, origin[at]), "a loop without a bound");
      }
    }
  }

  /// `Output update(Input) noexcept`: in each declaration before its end.
  void check_noexcept() {
    for (const Word& word : words(blanked_)) {
      const std::size_t open = word.offset + word.text.size();
      const bool is_declaration =
          std::ranges::find(rules_.noexcept_functions, word.text) !=
              rules_.noexcept_functions.end() &&
          open < blanked_.size() && blanked_[open] == '(' && word.offset > 0 &&
          (blanked_[word.offset - 1] == ' ' || blanked_[word.offset - 1] == '&') &&
          !follows_return(word.offset);
      if (!is_declaration) {
        continue;
      }
      const std::size_t end = blanked_.find_first_of(";{", open);
      if (blanked_.substr(open, end - open).find("noexcept") == std::string::npos) {
        report("in-cycle", line_of(blanked_, word.offset),
               std::string(word.text) + "() must be noexcept");
      }
    }
  }

  /// A call stands after `return`, `=` or at the start of a statement; a declaration after a type.
  [[nodiscard]] bool follows_return(std::size_t offset) const {
    const std::size_t last = blanked_.find_last_not_of(" \n", offset - 1);
    if (last == std::string::npos) {
      return true;
    }
    const bool is_type = std::isalnum(static_cast<unsigned char>(blanked_[last])) != 0 ||
                         blanked_[last] == '_' || blanked_[last] == '>' || blanked_[last] == '&' ||
                         blanked_[last] == '*';
    return !is_type || (last >= 5 && blanked_.substr(last - 5, 6) == "return");
  }

  void check_namespaces() {
    std::string expected =
        rules_.root + "/" + home_of(rules_, *folder_under_root(rules_, file_.path));
    for (std::size_t at = expected.find('/'); at != std::string::npos; at = expected.find('/')) {
      expected.replace(at, 1, "::");
    }
    bool matched = false;
    const auto all = words(blanked_);
    for (std::size_t i = 0; i + 1 < all.size(); ++i) {
      if (all[i].text != "namespace" || all[i + 1].text != rules_.root ||
          (i > 0 && all[i - 1].text == "using")) {
        continue;
      }
      const std::size_t start = all[i + 1].offset;
      const std::size_t end = blanked_.find_first_of(" \n{;=", start);
      const std::string actual = blanked_.substr(start, end - start);
      const bool alias = i > 0 && blanked_.find_first_of("{;=", start) != std::string::npos &&
                         blanked_[blanked_.find_first_of("{;=", start)] == ';';
      if (actual == expected || actual.starts_with(expected + "::")) {
        matched = true;
      } else if (!alias) {
        report("namespace", line_of(blanked_, start),
               "namespace " + actual + " in the folder of " + expected);
      }
    }
    if (!matched && file_.path.ends_with(".hpp")) {
      report("namespace", 1, "the header declares nothing in namespace " + expected);
    }
  }

  const SourceFile& file_;
  const Rules& rules_;
  std::string blanked_;
  std::vector<Violation> found_;
};

std::vector<std::string> strings(const toml::node_view<const toml::node>& node) {
  std::vector<std::string> out;
  if (const toml::array* array = node.as_array()) {
    for (const toml::node& item : *array) {
      out.push_back(item.value_or<std::string>(""));
    }
  }
  return out;
}

}  // namespace

std::expected<Rules, std::string> read_rules(std::string_view toml_text) {
  try {
    const toml::table table = toml::parse(toml_text);
    Rules rules;
    rules.root = table["root"].value_or<std::string>("");
    if (const toml::array* places = table["place"].as_array()) {
      for (const toml::node& node : *places) {
        const toml::table& entry = *node.as_table();
        rules.places.push_back({entry["folder"].value_or<std::string>(""),
                                entry["floor"].value_or(0), strings(entry["includes"]),
                                strings(entry["shelves"])});
      }
    }
    rules.in_cycle_folders = strings(table["in_cycle"]["folders"]);
    rules.in_cycle_headers = strings(table["in_cycle"]["headers"]);
    rules.in_cycle_words = strings(table["in_cycle"]["words"]);
    rules.noexcept_functions = strings(table["in_cycle"]["noexcept_functions"]);
    if (rules.root.empty() || rules.places.empty() || rules.in_cycle_folders.empty()) {
      return std::unexpected("root, [[place]] and in_cycle.folders are needed");
    }
    return rules;
  } catch (const toml::parse_error& error) {
    return std::unexpected(std::string(error.description()));
  }
}

std::vector<Violation> check_file(const SourceFile& file, const Rules& rules) {
  return FileCheck(file, rules).run();
}

std::vector<Violation> check_built(const std::vector<SourceFile>& tree, const Rules& rules) {
  std::vector<Violation> found;
  for (const SourceFile& file : tree) {
    if (!file.path.ends_with(".cpp") || !is_within(file.path, rules.root)) {
      continue;
    }
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

std::vector<Violation> check_crowded(const std::vector<SourceFile>& tree) {
  constexpr std::size_t kMostFiles = 15;
  std::map<std::string, std::set<std::string>> folders;
  for (const SourceFile& file : tree) {
    if (is_cpp(file.path)) {
      folders[std::string(folder_of(file.path))].insert(file.path.substr(0, file.path.rfind('.')));
    }
  }
  std::vector<Violation> found;
  for (const auto& [folder, files] : folders) {
    if (files.size() > kMostFiles) {
      found.push_back({"crowded", folder, 1,
                       std::to_string(files.size()) + " files (a pair counts once), at most " +
                           std::to_string(kMostFiles) + ": make shelves"});
    }
  }
  return found;
}

std::vector<Violation> check_tree(const std::vector<SourceFile>& tree, const Rules& rules) {
  std::vector<Violation> found = check_built(tree, rules);
  std::ranges::move(check_crowded(tree), std::back_inserter(found));
  for (const SourceFile& file : tree) {
    std::ranges::move(check_file(file, rules), std::back_inserter(found));
  }
  return found;
}

}  // namespace house
