// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <steadyrest/apps/cli/shared/table.hpp>
#include <steadyrest/kernel/outcome/shown.hpp>

namespace steadyrest::apps::cli {
namespace {

/// Continuation bytes of UTF-8 (10xxxxxx) take no column: µ, ° and ε are one wide.
std::size_t width_of(std::string_view text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U;
  }));
}

void append(std::string& out, const std::vector<std::string>& cells,
            const std::vector<std::size_t>& widths) {
  std::string line;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const std::string pad(widths[i] - width_of(cells[i]), ' ');
    line += i == 0 ? "" : "  ";
    line += i == 0 ? cells[i] + pad : pad + cells[i];
  }
  // No blanks at line ends, so that tables can be compared and pasted.
  line.erase(line.find_last_not_of(' ') + 1);
  out += line + "\n";
}

}  // namespace

/// Two passes: widths first, then lines. A cell may be a name that others chose.
std::string Table::text() const {
  auto rows = rows_;
  for (auto& cells : rows) {
    std::ranges::transform(cells, cells.begin(), kernel::outcome::shown);
  }
  std::vector<std::size_t> widths(head_.size(), 0);
  const auto widen = [&widths](const std::vector<std::string>& cells) {
    widths.resize(std::max(widths.size(), cells.size()), 0);
    for (std::size_t i = 0; i < cells.size(); ++i) {
      widths[i] = std::max(widths[i], width_of(cells[i]));
    }
  };
  widen(head_);
  for (const auto& cells : rows) {
    widen(cells);
  }
  std::string out;
  if (!head_.empty()) {
    append(out, head_, widths);
  }
  for (const auto& cells : rows) {
    append(out, cells, widths);
  }
  return out;
}

}  // namespace steadyrest::apps::cli
