// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <steadyrest/table/text.hpp>

namespace steadyrest::table {

// A CR counts as a blank: logs with CR LF read the same.
std::string_view trimmed(std::string_view text) noexcept {
  const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  while (!text.empty() && blank(text.front())) {
    text.remove_prefix(1);
  }
  while (!text.empty() && blank(text.back())) {
    text.remove_suffix(1);
  }
  return text;
}

// ASCII only, whatever the locale: units and keys are ASCII.
std::string lower(std::string_view text) {
  std::string out(text);
  std::ranges::transform(out, out.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c;
  });
  return out;
}

// For refusals: garbage from a log must not move the terminal's cursor.
std::string shown(std::string_view text) {
  constexpr std::size_t kMost = 40;
  std::string out(text.substr(0, kMost));
  std::ranges::replace_if(
      out,
      [](char c) {
        const auto byte = static_cast<unsigned char>(c);
        return byte < 0x20 || byte >= 0x7F;
      },
      '?');
  return text.size() > kMost ? out + "…" : out;
}

}  // namespace steadyrest::table
