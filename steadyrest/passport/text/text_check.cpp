// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <fmt/core.h>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/passport/text/text_check.hpp>

// What TOML's parser must never receive: bytes that are not text, and nesting that would overflow
// its stack. Checked on the raw text, with the line of the fault.
namespace steadyrest::passport {
namespace {

using kernel::outcome::bad_input;
using kernel::outcome::Refusal;

/// A machine file needs three parts; sixteen leaves room.
constexpr int kMaxKeyParts = 16;

/// Only for a refusal, so counting from the start is cheap enough.
std::size_t line_at(std::string_view text, std::size_t offset) {
  return 1 + static_cast<std::size_t>(std::count(
                 text.begin(), text.begin() + static_cast<std::ptrdiff_t>(offset), '\n'));
}

/// 0 beyond the end: never part of a sequence, so a truncated character fails its check.
unsigned byte_at(std::string_view text, std::size_t i) {
  return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U;
}

/// Length of the UTF-8 sequence that begins at i; 0 if there is none (RFC 3629, table of section 4:
/// the second byte excludes overlong forms, surrogates and code points above U+10FFFF).
std::size_t sequence_length(std::string_view text, std::size_t i) {
  const unsigned a = byte_at(text, i);
  const unsigned b = byte_at(text, i + 1);
  const auto tail = [&](std::size_t k) { return (byte_at(text, i + k) & 0xC0U) == 0x80U; };
  if (a < 0x80U) {
    return 1;
  }
  // C0 and C1 could only begin overlong forms.
  if (a >= 0xC2U && a <= 0xDFU) {
    return tail(1) ? 2 : 0;
  }
  if ((a & 0xF0U) == 0xE0U) {
    const bool overlong = a == 0xE0U && b < 0xA0U;
    const bool surrogate = a == 0xEDU && b > 0x9FU;
    return tail(1) && tail(2) && !overlong && !surrogate ? 3 : 0;
  }
  if (a >= 0xF0U && a <= 0xF4U) {
    const bool overlong = a == 0xF0U && b < 0x90U;
    const bool too_high = a == 0xF4U && b > 0x8FU;
    return tail(1) && tail(2) && tail(3) && !overlong && !too_high ? 4 : 0;
  }
  return 0;
}

std::optional<Refusal> unfit_bytes(std::string_view text) {
  for (std::size_t i = 0; i < text.size();) {
    // Control characters except tab and line ends: a TOML file has none, a binary file soon does.
    const unsigned c = byte_at(text, i);
    if ((c < 0x20U && c != '\t' && c != '\n' && c != '\r') || c == 0x7FU) {
      return bad_input("", line_at(text, i),
                       fmt::format("byte 0x{:02x} is not text; this looks like a binary file", c),
                       "give a TOML file in plain UTF-8");
    }
    const std::size_t length = sequence_length(text, i);
    if (length == 0) {
      return bad_input("", line_at(text, i), fmt::format("byte 0x{:02x} is not UTF-8", c),
                       "save the file as UTF-8 (iconv -f CP1252 -t UTF-8, for example)");
    }
    i += length;
  }
  return std::nullopt;
}

/// Length of the string that begins with the quote at i (TOML 1.0, section String): on one line, or
/// over several between three quotes; up to two more quotes of content may precede the last three.
/// An unclosed one runs up to where the parser gives up, the end of the line or of the text.
std::size_t string_length(std::string_view text, std::size_t i) {
  const char quote = text[i];
  const bool escapes = quote == '"';
  const std::string_view three = escapes ? R"(""")" : "'''";
  const bool many_lines = text.substr(i).starts_with(three);
  std::size_t at = i + (many_lines ? three.size() : 1);
  while (at < text.size()) {
    if (many_lines ? text.substr(at).starts_with(three) : text[at] == quote) {
      const std::size_t end = text.find_first_not_of(quote, at);
      const std::size_t quotes = std::min(end, text.size()) - at;
      return at - i + (many_lines ? std::min<std::size_t>(quotes, 5) : 1);
    }
    if (!many_lines && text[at] == '\n') {
      break;
    }
    // Whatever is escaped closes nothing. A line's end cannot be escaped on one line.
    const bool pair = escapes && text[at] == '\\' && (many_lines || byte_at(text, at + 1) != '\n');
    at += pair ? 2 : 1;
  }
  return std::min(at, text.size()) - i;
}

/// The TOML parser and the destructor of its tree recurse once for each part of a dotted key.
/// Strings and comments are skipped: their contents are neither a part nor the end of a key.
/// Numbers and dates have few dots and need no care.
std::optional<Refusal> too_deep(std::string_view text) {
  int parts = 1;
  for (std::size_t i = 0; i < text.size();) {
    const char c = text[i];
    if (c == '"' || c == '\'') {
      i += string_length(text, i);
      continue;
    }
    if (c == '#') {
      i = std::min(text.find('\n', i), text.size());
      continue;
    }
    if (c == '\n' || c == ',' || c == '=' || c == '{' || c == '[') {
      parts = 1;
    } else if (c == '.' && ++parts > kMaxKeyParts) {
      return bad_input("", line_at(text, i),
                       fmt::format("more than {} dots in one key or value", kMaxKeyParts),
                       "write plain keys below a [section]");
    }
    ++i;
  }
  return std::nullopt;
}

}  // namespace

/// Size first, before anything scans the text.
std::optional<Refusal> unfit_text(std::string_view text) {
  if (text.size() > kMaxFileBytes) {
    return bad_input(
        fmt::format("larger than {} MB; such a file has a few kB", kMaxFileBytes >> 20U),
        "give a TOML file, not a program or a log");
  }
  if (std::all_of(text.begin(), text.end(),
                  [](char c) { return c == ' ' || c == '\n' || c == '\r' || c == '\t'; })) {
    return bad_input("the file is empty", "start from a file in examples/machines/");
  }
  if (auto refusal = unfit_bytes(text)) {
    return refusal;
  }
  return too_deep(text);
}

}  // namespace steadyrest::passport
