// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdint>
#include <string_view>
#include <vector>

#include <fmt/core.h>

#include <steadyrest/kernel/file/unified_diff.hpp>

// The files of a machine have hundreds of lines, and a change concerns a few: the plain quadratic
// table is small once the common head and tail are cut off.
namespace steadyrest::kernel::file {
namespace {

struct DiffLine {
  char sign = ' ';
  std::string text;
};

/// The longest common subsequence of the two middles.
void middle(const std::vector<std::string>& a, const std::vector<std::string>& b, std::size_t first,
            std::size_t a_end, std::size_t b_end, std::vector<DiffLine>& out) {
  const std::size_t rows = a_end - first;
  const std::size_t columns = b_end - first;
  constexpr std::size_t kMostCells = std::size_t{1} << 24U;
  if (rows * columns > kMostCells) {
    for (std::size_t i = first; i < a_end; ++i) {
      out.push_back({'-', a[i]});
    }
    for (std::size_t j = first; j < b_end; ++j) {
      out.push_back({'+', b[j]});
    }
    return;
  }
  std::vector<std::uint32_t> longest((rows + 1) * (columns + 1), 0);
  const auto at = [&](std::size_t i, std::size_t j) -> std::uint32_t& {
    return longest[i * (columns + 1) + j];
  };
  for (std::size_t i = rows; i-- > 0;) {
    for (std::size_t j = columns; j-- > 0;) {
      at(i, j) = a[first + i] == b[first + j] ? at(i + 1, j + 1) + 1
                                              : std::max(at(i + 1, j), at(i, j + 1));
    }
  }
  std::size_t i = 0;
  std::size_t j = 0;
  while (i < rows || j < columns) {
    if (i < rows && j < columns && a[first + i] == b[first + j]) {
      out.push_back({' ', a[first + i]});
      ++i;
      ++j;
    } else if (i < rows && (j == columns || at(i + 1, j) >= at(i, j + 1))) {
      out.push_back({'-', a[first + i++]});
    } else {
      out.push_back({'+', b[first + j++]});
    }
  }
}

std::vector<DiffLine> diff_lines(const std::vector<std::string>& a,
                                 const std::vector<std::string>& b) {
  std::vector<DiffLine> out;
  std::size_t first = 0;
  while (first < std::min(a.size(), b.size()) && a[first] == b[first]) {
    out.push_back({' ', a[first++]});
  }
  std::size_t a_end = a.size();
  std::size_t b_end = b.size();
  while (a_end > first && b_end > first && a[a_end - 1] == b[b_end - 1]) {
    --a_end;
    --b_end;
  }
  middle(a, b, first, a_end, b_end, out);
  for (; a_end < a.size(); ++a_end) {
    out.push_back({' ', a[a_end]});
  }
  return out;
}

std::string hunk(const std::vector<DiffLine>& lines, std::size_t begin, std::size_t end) {
  const auto count = [&lines](std::size_t from, std::size_t to, char other) {
    return static_cast<std::size_t>(
        std::count_if(lines.begin() + static_cast<std::ptrdiff_t>(from),
                      lines.begin() + static_cast<std::ptrdiff_t>(to),
                      [other](const DiffLine& line) { return line.sign != other; }));
  };
  const std::size_t old_lines = count(begin, end, '+');
  const std::size_t new_lines = count(begin, end, '-');
  // An empty side begins at the line before it.
  std::string out =
      fmt::format("@@ -{},{} +{},{} @@\n", count(0, begin, '+') + (old_lines > 0 ? 1 : 0),
                  old_lines, count(0, begin, '-') + (new_lines > 0 ? 1 : 0), new_lines);
  for (std::size_t i = begin; i < end; ++i) {
    out += lines[i].sign + lines[i].text;
    out += lines[i].text.ends_with('\n') ? "" : "\n\\ No newline at end of file\n";
  }
  return out;
}

}  // namespace

std::vector<std::string> lines_of(std::string_view text) {
  std::vector<std::string> out;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    const std::size_t size = end == std::string_view::npos ? text.size() : end + 1;
    out.emplace_back(text.substr(0, size));
    text.remove_prefix(size);
  }
  return out;
}

std::string unified_diff(const std::string& file, const std::optional<std::string>& before,
                         const std::optional<std::string>& after) {
  constexpr std::size_t kContext = 3;
  const auto lines = diff_lines(lines_of(before.value_or("")), lines_of(after.value_or("")));
  std::string out;
  for (std::size_t i = 0; i < lines.size();) {
    if (lines[i].sign == ' ') {
      ++i;
      continue;
    }
    const std::size_t begin = i - std::min(i, kContext);
    std::size_t last = i;  // the last changed line of this hunk
    for (std::size_t j = i; j < lines.size() && j <= last + 2 * kContext + 1; ++j) {
      last = lines[j].sign == ' ' ? last : j;
    }
    const std::size_t end = std::min(last + 1 + kContext, lines.size());
    out += hunk(lines, begin, end);
    i = end;
  }
  if (out.empty()) {
    return {};
  }
  return fmt::format("--- {}\n+++ {}\n{}", before ? file : "/dev/null", after ? file : "/dev/null",
                     out);
}

}  // namespace steadyrest::kernel::file
