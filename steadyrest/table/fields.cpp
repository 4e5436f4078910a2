// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>
#include <cstring>

#include <steadyrest/table/fields.hpp>
#include <steadyrest/table/number.hpp>
#include <steadyrest/table/stamp.hpp>
#include <steadyrest/table/text.hpp>

namespace steadyrest::table {
namespace {

using namespace std::string_view_literals;

/// The bytes of the field at the front of `text`, including quotes and their contents.
std::size_t size_of_field(std::string_view text, char separator) {
  const std::size_t begin = text.find_first_not_of(" \t");
  if (begin != std::string_view::npos && text[begin] == '"') {
    // A quote ends at one followed by the separator or the line's end.
    for (std::size_t at = text.find('"', begin + 1); at != std::string_view::npos;
         at = text.find('"', at + 1)) {
      const std::size_t next = text.find_first_not_of(separator == '\t' ? " "sv : " \t"sv, at + 1);
      // A tab is a separator there, so it must not be skipped like a blank.
      if (next == std::string_view::npos) {
        return text.size();
      }
      if (text[next] == separator) {
        return next;
      }
    }
  }
  const void* const at = text.empty() ? nullptr : std::memchr(text.data(), separator, text.size());
  return at == nullptr ? text.size()
                       : static_cast<std::size_t>(static_cast<const char*>(at) - text.data());
}

}  // namespace

// Quotes are decoration here: their contents are read like any other field.
std::string_view field_of(std::string_view text) {
  text = trimmed(text);
  const bool quoted = text.size() >= 2 && text.front() == '"' && text.back() == '"';
  return quoted ? trimmed(text.substr(1, text.size() - 2)) : text;
}

void split_fields(std::string_view text, char separator, std::vector<std::string_view>& fields) {
  fields.clear();
  // Blanks separate only where the command line names the columns; any number of them counts as
  // one.
  if (separator == ' ') {
    for (text = trimmed(text); !text.empty();) {
      const std::size_t end = std::min(text.find_first_of(" \t"), text.size());
      fields.push_back(text.substr(0, end));
      text = trimmed(text.substr(end));
    }
    return;
  }
  for (;;) {
    const std::size_t size = size_of_field(text, separator);
    fields.push_back(field_of(text.substr(0, size)));
    if (size == text.size()) {
      return;
    }
    text.remove_prefix(size + 1);
  }
}

// A head has names, a row has at least one number or stamp.
bool holds_value(std::string_view field) {
  return like_a_number(field) || stamp_of(field).has_value();
}

/// The first mark of the head that splits head and first row alike, else the first one. A head may
/// contain other marks in its names, a row may contain decimal commas: only a mark that cuts both
/// into the same number of fields is believed.
char separator_of(std::string_view head, std::string_view row) {
  std::vector<std::string_view> of_head;
  std::vector<std::string_view> of_row;
  char first = '\0';
  for (const char c : head) {
    if (c != ',' && c != ';' && c != '\t') {
      continue;
    }
    first = first == '\0' ? c : first;
    split_fields(head, c, of_head);
    split_fields(row, c, of_row);
    if (of_head.size() == of_row.size() && of_row.size() > 1) {
      return c;
    }
  }
  return first == '\0' ? ',' : first;
}

}  // namespace steadyrest::table
