// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

namespace steadyrest::thermal::offline {

inline std::string_view trimmed(std::string_view text) {
  const std::size_t from = text.find_first_not_of(" \t\r\"");
  const std::size_t to = text.find_last_not_of(" \t\r\"");
  return from == std::string_view::npos ? std::string_view{} : text.substr(from, to - from + 1);
}

/// The fields of a table's rows. The first of comma, semicolon and tab in the head parts them.
class RowSplitter {
 public:
  void head(std::string_view row) {
    const std::size_t mark = row.find_first_of(",;\t");
    separator_ = mark == std::string_view::npos ? ',' : row[mark];
  }
  /// They stand in `row`, blanks about them left out.
  void split(std::string_view row, std::vector<std::string_view>& fields) const {
    fields.clear();
    while (true) {
      const std::size_t end = row.find(separator_);
      fields.push_back(trimmed(row.substr(0, end)));
      if (end == std::string_view::npos) {
        return;
      }
      row.remove_prefix(end + 1);
    }
  }

 private:
  char separator_ = ',';
};

}  // namespace steadyrest::thermal::offline
