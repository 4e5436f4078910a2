// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include <fmt/core.h>

#include <steadyrest/motion/offline/edge_log_header.hpp>

namespace steadyrest::motion::offline {
namespace {

using namespace std::string_view_literals;

constexpr std::string_view kWanted = "the header names the columns t_s and count";

bool is_control(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return (byte < 0x20 && c != '\t') || byte == 0x7F;
}

std::vector<std::string_view> split(std::string_view line, char separator) {
  std::vector<std::string_view> out;
  for (;;) {
    const std::size_t end = line.find(separator);
    std::string_view name = trimmed(line.substr(0, end));
    if (name.size() >= 2 && name.front() == '"' && name.back() == '"') {
      name = name.substr(1, name.size() - 2);
    }
    out.push_back(name);
    if (end == std::string_view::npos) {
      return out;
    }
    line.remove_prefix(end + 1);
  }
}

/// The place of a column that must stand there exactly once.
std::expected<std::size_t, LogFault> place(const std::vector<std::string_view>& names,
                                           std::string_view wanted, std::string_view header) {
  const auto count = std::ranges::count(names, wanted);
  if (count == 1) {
    return static_cast<std::size_t>(std::ranges::find(names, wanted) - names.begin());
  }
  return std::unexpected(
      LogFault{fmt::format("the column {} {} in \"{}\"", wanted,
                           count == 0 ? "is missing" : "stands twice", shown(header)),
               fmt::format("see to it that {} once, with , or ; or tab between them", kWanted)});
}

}  // namespace

std::string_view trimmed(std::string_view text) {
  const auto blank = [](char c) { return c == ' ' || c == '\t'; };
  while (!text.empty() && blank(text.front())) {
    text.remove_prefix(1);
  }
  while (!text.empty() && blank(text.back())) {
    text.remove_suffix(1);
  }
  return text;
}

std::string shown(std::string_view field) {
  constexpr std::size_t kMost = 40;
  std::string out(field.substr(0, kMost));
  std::ranges::replace_if(
      out, [](char c) { return is_control(c) || static_cast<unsigned char>(c) >= 0x80; }, '?');
  return field.size() > kMost ? out + "…" : out;
}

LogFault fault_of_kind(std::string_view first_bytes) {
  struct Kind {
    std::string_view magic;
    std::string_view what;
    std::string_view to_do;
  };
  static constexpr std::array kKinds{
      Kind{"\x1f\x8b"sv, "is compressed by gzip",
           "unpack it: zcat LOG.gz | steadyrest motion estimate - …"},
      Kind{"\xfd"
           "7zXZ"sv,
           "is compressed by xz", "unpack it: xzcat LOG.xz | steadyrest motion estimate - …"},
      Kind{"\x28\xb5\x2f\xfd"sv, "is compressed by zstd",
           "unpack it: zstdcat LOG.zst | steadyrest motion estimate - …"},
      Kind{"BZh"sv, "is compressed by bzip2",
           "unpack it: bzcat LOG.bz2 | steadyrest motion estimate - …"},
      Kind{"PK\x03\x04"sv, "is a zip archive", "unpack it first"},
      Kind{"\xff\xfe"sv, "is UTF-16 text", "save it as UTF-8"},
      Kind{"\xfe\xff"sv, "is UTF-16 text", "save it as UTF-8"},
  };
  for (const Kind& kind : kKinds) {
    if (first_bytes.starts_with(kind.magic)) {
      return {std::string(kind.what), std::string(kind.to_do)};
    }
  }
  return {};
}

std::expected<LogColumns, LogFault> columns_of(std::string_view header) {
  if (header.find('\r') != std::string_view::npos) {
    return std::unexpected(LogFault{"the lines end with a carriage return alone",
                                    "save the log with LF or CR LF as line ends"});
  }
  if (std::ranges::any_of(header, is_control)) {
    return std::unexpected(
        LogFault{"the header has control characters: this is no text", "give a text file"});
  }
  const std::size_t mark = header.find_first_of(",;\t");
  LogColumns columns;
  columns.separator = mark == std::string_view::npos ? ',' : header[mark];
  const std::vector<std::string_view> names = split(header, columns.separator);
  if (!names.front().empty() &&
      names.front().find_first_not_of("0123456789.+-eE") == std::string_view::npos) {
    return std::unexpected(
        LogFault{fmt::format("there is no header before \"{}\"", shown(header)),
                 fmt::format("see to it that {}, without # before it", kWanted)});
  }
  const auto time = place(names, "t_s", header);
  if (!time) {
    return std::unexpected(time.error());
  }
  const auto count = place(names, "count", header);
  if (!count) {
    return std::unexpected(count.error());
  }
  columns.time = *time;
  columns.count = *count;
  columns.all = names.size();
  return columns;
}

}  // namespace steadyrest::motion::offline
