// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <fmt/core.h>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/passport/text/text_check.hpp>

// What TOML's parser must not be given at all: bytes that are no text, and nesting that would
// overflow its stack. Checked on the raw text, with the line of the fault.
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

/// 0 beyond the end: no byte of a sequence, so a cut-off character fails its check.
unsigned byte_at(std::string_view text, std::size_t i) {
  return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U;
}

/// Length of the UTF-8 sequence that begins at i; 0 when it is none (RFC 3629, table of section 4:
/// overlong forms, surrogates and code points above U+10FFFF are excluded by the second byte).
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
    // Control characters but tab and line ends: a TOML file has none, a binary file soon does.
    const unsigned c = byte_at(text, i);
    if ((c < 0x20U && c != '\t' && c != '\n' && c != '\r') || c == 0x7FU) {
      return bad_input("", line_at(text, i),
                       fmt::format("byte 0x{:02x} is not text; this looks like a binary file", c),
                       "give a machine file: TOML in plain UTF-8");
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

/// The TOML parser and the destructor of its tree recurse once for each part of a dotted key.
/// Counted roughly, without reading strings: numbers and dates have few dots.
std::optional<Refusal> too_deep(std::string_view text) {
  int parts = 1;
  bool comment = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '\n') {
      parts = 1;
      comment = false;
    } else if (c == '#') {
      comment = true;
    } else if (c == ',' || c == '=' || c == '{' || c == '[') {
      parts = 1;
    } else if (c == '.' && !comment && ++parts > kMaxKeyParts) {
      return bad_input("", line_at(text, i),
                       fmt::format("more than {} dots in one key or value", kMaxKeyParts),
                       "write plain keys below a [section]");
    }
  }
  return std::nullopt;
}

}  // namespace

/// Size first, before anything walks through the text.
std::optional<Refusal> unfit_text(std::string_view text) {
  if (text.size() > kMaxFileBytes) {
    return bad_input(
        fmt::format("larger than {} MB; a machine file has a few kB", kMaxFileBytes >> 20U),
        "give a machine file, not a program or a log");
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
