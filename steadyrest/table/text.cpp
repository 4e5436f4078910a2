// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>

#include <steadyrest/table/text.hpp>

namespace steadyrest::table {

using namespace std::string_view_literals;

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

// ASCII first, at the speed of reading: most lines have nothing else.
bool is_utf8(std::string_view text) noexcept {
  const auto byte = [&text](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (byte(i) < 0x80) {
      continue;
    }
    const std::size_t more = byte(i) >= 0xC2 && byte(i) < 0xE0   ? 1
                             : byte(i) >= 0xE0 && byte(i) < 0xF0 ? 2
                             : byte(i) >= 0xF0 && byte(i) < 0xF5 ? 3
                                                                 : 0;
    if (more == 0 || i + more > text.size() - 1) {
      return false;
    }
    for (std::size_t k = 1; k <= more; ++k) {
      if ((byte(i + k) & 0xC0U) != 0x80U) {
        return false;
      }
    }
    i += more;
  }
  return true;
}

std::string from_cp1252(std::string_view text) {
  std::string out;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x80) {
      out += c;
    } else if (byte < 0xA0) {  // quotes and dashes: no unit has one
      out += '?';
    } else {
      out += static_cast<char>(0xC0U | (byte >> 6U));
      out += static_cast<char>(0x80U | (byte & 0x3FU));
    }
  }
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

std::optional<Fault> fault_of_kind(std::string_view first_bytes) {
  struct Kind {
    std::string_view magic;
    std::string_view what;
    std::string_view to_do;
  };
  static constexpr std::array kKinds{
      Kind{"\x1f\x8b"sv, "is gzip-compressed", "unpack it: zcat LOG.gz > LOG"},
      Kind{"\xfd"
           "7zXZ"sv,
           "is xz-compressed", "unpack it: xzcat LOG.xz > LOG"},
      Kind{"\x28\xb5\x2f\xfd"sv, "is zstd-compressed", "unpack it: zstdcat LOG.zst > LOG"},
      Kind{"BZh"sv, "is bzip2-compressed", "unpack it: bzcat LOG.bz2 > LOG"},
      Kind{"PK\x03\x04"sv, "is a zip archive", "unpack it first"},
      Kind{"\xff\xfe"sv, "is UTF-16 text", "save it as UTF-8"},
      Kind{"\xfe\xff"sv, "is UTF-16 text", "save it as UTF-8"},
  };
  for (const Kind& kind : kKinds) {
    if (first_bytes.starts_with(kind.magic)) {
      return Fault{0, std::string(kind.what), std::string(kind.to_do)};
    }
  }
  return std::nullopt;
}

}  // namespace steadyrest::table
