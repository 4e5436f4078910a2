// SPDX-License-Identifier: Apache-2.0
#include <charconv>

#include <fmt/core.h>

#include <steadyrest/nc/rewrite/text/replaced_text.hpp>

namespace steadyrest::nc::rewrite {
namespace {

using read::Dialect;

constexpr std::string_view kWas = "STEADYREST was ";
constexpr std::string_view kNew = "STEADYREST new";

bool in_brackets(Dialect dialect) noexcept {
  switch (dialect) {
    case Dialect::fanuc:
    case Dialect::haas:
      return true;
    case Dialect::linuxcnc:
    case Dialect::sinumerik:
    case Dialect::grbl:
    case Dialect::mach3:
      break;
  }
  return false;
}

/// Shorter than the reader's own limits by what a control may add.
std::size_t longest_block(Dialect dialect) noexcept {
  switch (dialect) {
    case Dialect::linuxcnc:
    case Dialect::fanuc:
    case Dialect::haas:
    case Dialect::mach3:
      return 250;
    case Dialect::grbl:
      return 70;
    case Dialect::sinumerik:
      return 500;
  }
  return 0;
}

bool is_safe(char c) noexcept {
  constexpr std::string_view kUnsafe = "()=%;";
  return c >= ' ' && c <= '~' && kUnsafe.find(c) == std::string_view::npos;
}

std::string escaped(std::string_view line) {
  std::string text;
  for (const char c : line) {
    text += is_safe(c)
                ? std::string(1, c)
                : fmt::format("={:02X}", static_cast<unsigned>(static_cast<unsigned char>(c)));
  }
  return text;
}

/// Nothing for a text that escaped() does not write.
std::optional<std::string> unescaped(std::string_view text) {
  std::string line;
  while (!text.empty()) {
    if (text[0] != '=') {
      line += text[0];
      text.remove_prefix(1);
      continue;
    }
    unsigned byte = 0;
    if (text.size() < 3 || std::from_chars(&text[1], &text[1] + 2, byte, 16).ptr != &text[1] + 2) {
      return std::nullopt;
    }
    line += static_cast<char>(byte);
    text.remove_prefix(3);
  }
  return line;
}

}  // namespace

std::string was_text(Dialect dialect, std::string_view line, std::size_t new_lines) {
  return in_brackets(dialect) ? fmt::format("({}{} {})", kWas, new_lines, escaped(line))
                              : fmt::format(";{}{} {}", kWas, new_lines, line);
}

std::string new_text(Dialect dialect, std::string_view code) {
  return in_brackets(dialect) ? fmt::format("{} ({})", code, kNew)
                              : fmt::format("{} ;{}", code, kNew);
}

bool too_long_to_keep(Dialect dialect, std::string_view line) {
  return was_text(dialect, line, 9999).size() > longest_block(dialect);
}

std::optional<Was> read_was(std::string_view line) {
  const bool round = line.starts_with('(') && line.ends_with(')');
  if ((!round && !line.starts_with(';')) || !line.substr(1).starts_with(kWas)) {
    return std::nullopt;
  }
  line.remove_prefix(1 + kWas.size());
  line.remove_suffix(round ? 1 : 0);
  Was was;
  const auto read = std::from_chars(line.data(), line.data() + line.size(), was.new_lines);
  line.remove_prefix(static_cast<std::size_t>(read.ptr - line.data()));
  if (read.ec != std::errc{} || !line.starts_with(' ')) {
    return std::nullopt;
  }
  line.remove_prefix(1);
  auto text = round ? unescaped(line) : std::optional(std::string(line));
  if (!text) {
    return std::nullopt;
  }
  was.line = std::move(*text);
  return was;
}

bool is_new(std::string_view line) noexcept {
  if (line.ends_with(')')) {
    line.remove_suffix(1);
    return line.ends_with(kNew) && line.substr(0, line.size() - kNew.size()).ends_with('(');
  }
  return line.ends_with(kNew) && line.substr(0, line.size() - kNew.size()).ends_with(';');
}

std::string_view new_code(std::string_view line) noexcept {
  line.remove_suffix(kNew.size() + (line.ends_with(')') ? 3U : 2U));
  return line;
}

std::string changed_mark(std::string_view line) {
  constexpr std::string_view kLetters = "STEADYREST";
  std::string plain;
  for (const char c : line) {
    if (c > ' ') {
      plain += c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
    }
  }
  for (std::size_t at = plain.find(kLetters); at != std::string::npos;
       at = plain.find(kLetters, at + 1)) {
    if (at > 0 && (plain[at - 1] == '(' || plain[at - 1] == ';')) {
      return plain.substr(at + kLetters.size());
    }
  }
  return {};
}

bool was_replacing(std::string_view line) {
  const std::string mark = changed_mark(line);
  constexpr std::string_view kDigits = "0123456789";
  return mark == "NEW" || mark == "NEW)" || mark.starts_with("HEADMADE--") ||
         (mark.starts_with("WAS") && mark.size() > 3 &&
          kDigits.find(mark[3]) != std::string_view::npos);
}

}  // namespace steadyrest::nc::rewrite
