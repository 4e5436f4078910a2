// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <steadyrest/passport/edit/text_edit.hpp>

namespace steadyrest::passport {

Places::Places(std::string_view text) : text_(text), lines_{0} {
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '\n') {
      lines_.push_back(i + 1);
    }
  }
}

std::size_t Places::at(const toml::source_position& place) const {
  std::size_t i = lines_[std::min<std::size_t>(place.line, lines_.size()) - 1];
  for (std::size_t column = 1; column < place.column && i < text_.size(); ++column) {
    ++i;
    while (i < text_.size() && (static_cast<unsigned char>(text_[i]) & 0xC0U) == 0x80U) {
      ++i;
    }
  }
  return i;
}

std::size_t Places::line_end(std::size_t i) const {
  const std::size_t end = text_.find('\n', i);
  return end == std::string_view::npos ? text_.size() : end + 1;
}

const toml::table* axis_of(const toml::table& root, std::string_view name) {
  if (const toml::array* axes = root["axis"].as_array()) {
    for (const toml::node& element : *axes) {
      const toml::table* axis = element.as_table();
      if (axis != nullptr && (*axis)["name"].value<std::string_view>() == name) {
        return axis;
      }
    }
  }
  return nullptr;
}

std::string applied(std::string_view text, std::vector<Edit> edits) {
  // Edits do not overlap; applied in order, each leaves the text in between untouched.
  std::ranges::stable_sort(edits, {}, &Edit::from);
  std::string out;
  std::size_t at = 0;
  for (const Edit& edit : edits) {
    out += text.substr(at, edit.from - at);
    out += edit.text;
    at = edit.to;
  }
  out += text.substr(at);
  return out;
}

std::string with_line_ends(std::string text, std::string_view of) {
  if (of.find("\r\n") == std::string_view::npos) {
    return text;
  }
  std::string out;
  for (const char c : text) {
    out += c == '\n' ? "\r\n" : std::string(1, c);
  }
  return out;
}

}  // namespace steadyrest::passport
