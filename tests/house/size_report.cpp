// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>

#include "rules.hpp"
#include <fmt/format.h>

// Figures about the tree, for people: only the length of a file can fail.
namespace house {
namespace {

struct Count {
  std::size_t files = 0;
  std::size_t lines = 0;
  std::size_t test_lines = 0;
  std::size_t comment_lines = 0;
  std::size_t longest = 0;
};

/// Trailing comments count too.
std::size_t comment_lines_in(std::string_view text) {
  std::size_t count = 0;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size() - 1);
    const std::string_view line = text.substr(0, end);
    count += line.find("//") != std::string_view::npos ? 1 : 0;
    text.remove_prefix(end + 1);
  }
  return count;
}

std::string room_of(std::string_view path, std::string_view root) {
  if (!path.starts_with(root)) {
    return std::string(path.substr(0, path.find('/')));
  }
  path.remove_prefix(std::min(root.size() + 1, path.size()));
  return std::string(path.substr(0, path.find('/')));
}

void add(Count& count, const SourceFile& file) {
  const std::size_t lines = lines_in(file.text);
  ++count.files;
  count.lines += lines;
  count.comment_lines += comment_lines_in(file.text);
  count.longest = std::max(count.longest, lines);
  if (has_folder(file.path, "test") || file.path.starts_with("tests/")) {
    count.test_lines += lines;
  }
}

std::size_t percent(std::size_t part, std::size_t whole) {
  return whole == 0 ? 0 : 100 * part / whole;
}

std::string row(std::string_view name, const Count& count) {
  return fmt::format("{:<12} {:>6} {:>8} {:>7} % {:>8} % {:>8}\n", name, count.files, count.lines,
                     percent(count.test_lines, count.lines),
                     percent(count.comment_lines, count.lines), count.longest);
}

}  // namespace

std::string size_report(const std::vector<SourceFile>& tree, const Rules& rules) {
  std::map<std::string, Count> rooms;
  Count total;
  std::vector<std::size_t> sizes;
  std::string longest;
  for (const SourceFile& file : tree) {
    if (!file.path.ends_with(".hpp") && !file.path.ends_with(".cpp")) {
      continue;
    }
    add(rooms[room_of(file.path, rules.root)], file);
    add(total, file);
    sizes.push_back(lines_in(file.text));
    if (sizes.back() > rules.most_lines) {
      longest += fmt::format("  {} ({} lines)\n", file.path, sizes.back());
    }
  }
  std::ranges::sort(sizes);
  std::string out = fmt::format("{:<12} {:>6} {:>8} {:>9} {:>10} {:>8}\n", "room", "files", "lines",
                                "tests", "comments", "longest");
  for (const auto& [name, count] : rooms) {
    out += row(name, count);
  }
  out += row("all", total);
  out += fmt::format("median file {} lines, nine in ten at most {}\n",
                     sizes.empty() ? 0 : sizes[sizes.size() / 2],
                     sizes.empty() ? 0 : sizes[sizes.size() * 9 / 10]);
  if (!longest.empty()) {
    out += fmt::format("longer than {} lines:\n{}", rules.most_lines, longest);
  }
  return out;
}

}  // namespace house
