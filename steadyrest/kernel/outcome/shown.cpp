// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <optional>

#include <steadyrest/kernel/outcome/shown.hpp>

namespace steadyrest::kernel::outcome {
namespace {

struct Range {
  char32_t from;
  char32_t to;
};

/// Characters that have no glyph (Unicode 15: Cc, Zl, Zp, most of Cf), and letters that have none:
/// the fillers of Hangul. web/src/frame/shown.ts has the same.
constexpr std::array<Range, 18> kUnseen = {{{0x00, 0x1f},
                                            {0x7f, 0x9f},
                                            {0xad, 0xad},
                                            {0x34f, 0x34f},
                                            {0x61c, 0x61c},
                                            {0x115f, 0x1160},
                                            {0x180b, 0x180f},
                                            {0x200b, 0x200f},
                                            {0x2028, 0x202e},
                                            {0x2060, 0x206f},
                                            {0x3164, 0x3164},
                                            {0xfe00, 0xfe0e},
                                            {0xfeff, 0xfeff},
                                            {0xffa0, 0xffa0},
                                            {0xfff9, 0xfffb},
                                            {0x1bca0, 0x1bca3},
                                            {0x1d173, 0x1d17a},
                                            {0xe0000, 0xe0fff}}};

/// The character that begins here, and its bytes; nothing where this is not UTF-8.
struct Character {
  char32_t code = 0;
  std::size_t bytes = 1;
};
std::optional<Character> character(std::string_view text) {
  const auto byte = [&text](std::size_t at) { return static_cast<unsigned char>(text[at]); };
  const unsigned first = byte(0);
  if (first < 0x80) {
    return Character{first, 1};
  }
  const std::size_t bytes = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
  if (first < 0xc2 || first > 0xf4 || text.size() < bytes) {
    return std::nullopt;
  }
  char32_t code = first & (0x7fU >> bytes);
  for (std::size_t i = 1; i < bytes; ++i) {
    if ((byte(i) & 0xc0U) != 0x80U) {
      return std::nullopt;
    }
    code = (code << 6U) | (byte(i) & 0x3fU);
  }
  constexpr std::array<char32_t, 5> kLeast = {0, 0, 0x80, 0x800, 0x10000};
  const bool surrogate = code >= 0xd800 && code <= 0xdfff;
  return code < kLeast[bytes] || code > 0x10ffff || surrogate
             ? std::nullopt
             : std::optional(Character{code, bytes});
}

bool is_unseen(char32_t code) {
  return std::ranges::any_of(
      kUnseen, [code](const Range& range) { return range.from <= code && code <= range.to; });
}

std::string printed(const char* form, unsigned value) {
  std::array<char, 16> out{};
  std::snprintf(out.data(), out.size(), form, value);
  return out.data();
}

std::string escaped(char32_t code) {
  if (code == '\n' || code == '\t' || code == '\r') {
    return code == '\n' ? "\\n" : code == '\t' ? "\\t" : "\\r";
  }
  return printed(code < 0x80 ? "\\x%02x" : code < 0x10000 ? "\\u%04x" : "\\U%08x", code);
}

/// JSON has 16 bits to an escape: two for the others.
std::string escaped_json(char32_t code) {
  if (code < 0x10000) {
    return printed("\\u%04x", code);
  }
  const char32_t over = code - 0x10000;
  return printed("\\u%04x", 0xd800 + (over >> 10U)) + printed("\\u%04x", 0xdc00 + (over & 0x3ffU));
}

template <class Escape>
std::string without_unseen(std::string_view text, std::string_view kept, const Escape& escape) {
  std::string out;
  while (!text.empty()) {
    const auto seen = character(text);
    const std::size_t bytes = seen ? seen->bytes : 1;
    if (!seen) {
      out += printed("\\x%02x", static_cast<unsigned char>(text[0]));
    } else if (is_unseen(seen->code) &&
               (bytes > 1 || kept.find(text[0]) == std::string_view::npos)) {
      out += escape(seen->code);
    } else {
      out += text.substr(0, bytes);
    }
    text.remove_prefix(bytes);
  }
  return out;
}

}  // namespace

std::string shown(std::string_view name) {
  return without_unseen(name, "", escaped);
}

std::string shown_lines(std::string_view text) {
  return without_unseen(text, "\n\t", escaped);
}

std::string shown_json(std::string_view json) {
  return without_unseen(json, "\n\t\r", escaped_json);
}

}  // namespace steadyrest::kernel::outcome
