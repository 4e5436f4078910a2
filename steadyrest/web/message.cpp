// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <optional>

#include <steadyrest/web/message.hpp>

namespace steadyrest::web {
namespace {

/// The hexadecimal digit at a place; nothing where there is none.
std::optional<unsigned> digit(std::string_view text, std::size_t at) {
  constexpr std::string_view kDigits = "0123456789abcdef0123456789ABCDEF";
  const std::size_t found = at < text.size() ? kDigits.find(text[at]) : std::string_view::npos;
  return found == std::string_view::npos ? std::nullopt
                                         : std::optional(static_cast<unsigned>(found % 16));
}

/// `%41` → `A`; nothing where an escape is none, or is a control character.
std::optional<std::string> decoded(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    unsigned value = static_cast<unsigned char>(text[i]);
    if (text[i] == '%') {
      const auto high = digit(text, i + 1);
      const auto low = digit(text, i + 2);
      if (!high || !low) {
        return std::nullopt;
      }
      value = 16 * *high + *low;
      i += 2;
    }
    if (value < 0x20 || value == 0x7f) {
      return std::nullopt;
    }
    out += static_cast<char>(value);
  }
  return out;
}

bool climbs(std::string_view path) {
  return path.find("/../") != std::string_view::npos || path.ends_with("/..") ||
         path.find('\\') != std::string_view::npos || path.find("//") != std::string_view::npos;
}

bool parse_query(std::string_view query, std::map<std::string, std::string>& into) {
  while (!query.empty()) {
    const std::size_t end = query.find('&');
    const std::string_view pair = query.substr(0, end);
    const std::size_t is = pair.find('=');
    const auto key = decoded(pair.substr(0, is));
    const auto value = is == std::string_view::npos ? std::optional<std::string>("")
                                                    : decoded(pair.substr(is + 1));
    if (!key || !value) {
      return false;
    }
    into[*key] = *value;
    query = end == std::string_view::npos ? std::string_view() : query.substr(end + 1);
  }
  return true;
}

}  // namespace

std::string lower(std::string text) {
  std::ranges::transform(text, text.begin(), [](char c) {
    return 'A' <= c && c <= 'Z' ? static_cast<char>(c + 32) : c;
  });
  return text;
}

std::string media_type(std::string_view content_type) {
  const std::string_view type = content_type.substr(0, content_type.find(';'));
  const std::size_t first = std::min(type.find_first_not_of(" \t"), type.size());
  return lower(std::string(type.substr(first, type.find_last_not_of(" \t") + 1 - first)));
}

bool parse_target(std::string_view target, Request& into) {
  const std::size_t question = target.find('?');
  const auto path = decoded(target.substr(0, question));
  if (!path || !path->starts_with('/') || climbs(*path)) {
    return false;
  }
  into.path = *path;
  return question == std::string_view::npos || parse_query(target.substr(question + 1), into.query);
}

std::string cookie(const Request& request, std::string_view name) {
  std::string_view rest = request.cookie;
  while (!rest.empty()) {
    const std::size_t end = rest.find(';');
    std::string_view pair = rest.substr(0, end);
    pair.remove_prefix(std::min(pair.find_first_not_of(' '), pair.size()));
    if (pair.starts_with(name) && pair.substr(name.size()).starts_with('=')) {
      return std::string(pair.substr(name.size() + 1));
    }
    rest = end == std::string_view::npos ? std::string_view() : rest.substr(end + 1);
  }
  return {};
}

}  // namespace steadyrest::web
