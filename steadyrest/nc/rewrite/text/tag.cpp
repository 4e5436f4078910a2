// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <steadyrest/kernel/file/output_file.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/nc/rewrite/text/mark.hpp>
#include <steadyrest/nc/rewrite/text/put_back.hpp>
#include <steadyrest/nc/rewrite/text/source_lines.hpp>
#include <steadyrest/nc/rewrite/text/tag.hpp>
#include <steadyrest/nc/rewrite/text/written_lines.hpp>

namespace steadyrest::nc::rewrite {
namespace {

/// A SINUMERIK line without its comment: a `;` within quotation marks begins none.
std::string_view code_of(std::string_view line) noexcept {
  bool quoted = false;
  const auto* const end = std::ranges::find_if(line, [&quoted](char c) {
    quoted = quoted != (c == '"');
    return c == ';' && !quoted;
  });
  return line.substr(0, static_cast<std::size_t>(end - line.begin()));
}

}  // namespace

// The mark must begin a comment: in the middle of a text the word is the user's own.
bool is_inserted(std::string_view line) noexcept {
  for (std::size_t at = line.find(kTag); at != std::string_view::npos;
       at = line.find(kTag, at + 1)) {
    const std::string_view before = line.substr(0, at);
    if (before.ends_with('(') || before.ends_with("(ABORT,") || before.ends_with("(MSG,") ||
        before.ends_with(';')) {
      return true;
    }
  }
  return false;
}

bool is_head(std::string_view inserted_line) noexcept {
  // The four kinds of lines in a head.
  return inserted_line.find("(STEADYREST head ") != std::string_view::npos ||
         inserted_line.find(";STEADYREST head ") != std::string_view::npos ||
         inserted_line.find("(ABORT,STEADYREST ") != std::string_view::npos ||
         inserted_line.find("(MSG,STEADYREST ") != std::string_view::npos;
}

// R50, r 50, R[50]; an expression in brackets could be any number, so it counts as this one. An R
// within a name (CR=) does not.
bool uses_parameter(std::string_view line, std::uint32_t number) noexcept {
  line = code_of(line);
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  const auto in_name = [](char c) {
    return c == '_' || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z');
  };
  for (std::size_t at = line.find_first_of("Rr"); at != std::string_view::npos;
       at = line.find_first_of("Rr", at + 1)) {
    if (at > 0 && in_name(line[at - 1])) {
      continue;  // within another name
    }
    std::size_t next = line.find_first_not_of(" \t", at + 1);
    if (next == std::string_view::npos) {
      return false;
    }
    if (line[next] == '[') {
      return true;
    }
    std::uint64_t value = 0;
    const std::size_t first = next;
    for (; next < line.size() && is_digit(line[next]); ++next) {
      // Bounded: a number of many digits must not wrap round to this one.
      value =
          std::min<std::uint64_t>(value * 10 + static_cast<unsigned>(line[next] - '0'), 1U << 20U);
    }
    if (next > first && value == number) {
      return true;
    }
  }
  return false;
}

bool uses_own_names(std::string_view line) noexcept {
  // LinuxCNC ignores blanks and case within a name, so a plain search could miss it.
  for (std::size_t at = line.find('#'); at != std::string_view::npos; at = line.find('#', at + 1)) {
    std::size_t next = at;
    const bool same = std::ranges::all_of(kOwnNames, [&](char wanted) {
      while (next < line.size() && (line[next] == ' ' || line[next] == '\t')) {
        ++next;
      }
      const char c = next < line.size() ? line[next++] : '\0';
      return wanted == (c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c);
    });
    if (same) {
      return true;
    }
  }
  return false;
}

bool names_variable(std::string_view line, std::string_view upper_begin) noexcept {
  const std::string_view code = code_of(line);
  return !std::ranges::search(code, upper_begin, {}, [](char c) {
            return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
          }).empty();
}

namespace {

constexpr std::string_view kAgainstOthers =
    "change its comment if the line is your own, else take the line out by hand";

}  // namespace

kernel::outcome::Result<std::size_t> strip(const std::string& program, const std::string& output) {
  // Only a program with replaced blocks is held in memory.
  const auto replaced = read_replaced_mark(program);
  auto back = !replaced           ? std::unexpected(replaced.error())
              : replaced->empty() ? kernel::outcome::Result<PutBack>{}
                                  : put_back(program);
  if (!back) {
    return std::unexpected(back.error());
  }
  auto lines = replaced->empty()
                   ? SourceLines::open(program)
                   : kernel::outcome::Result<SourceLines>(SourceLines::of(back->text, program));
  if (!lines) {
    return std::unexpected(lines.error());
  }
  auto writer = kernel::file::OutputFile::open(output);
  if (!writer) {
    return std::unexpected(writer.error());
  }
  const WrittenLines written_lines;
  std::size_t removed = 0;
  std::uint32_t first = 0;
  bool headed = false;
  // Byte for byte: remaining lines keep their own line ends.
  while (lines->next()) {
    if (is_inserted(lines->line())) {
      // The mark alone proves nothing: the line may be the author's own move.
      if (!written_lines.has(lines->line())) {
        return kernel::outcome::refuse(
            program, lines->number(),
            "has a STEADYREST comment, but `program compensate` writes no such line",
            std::string(kAgainstOthers));
      }
      first = removed == 0 ? lines->number() : first;
      headed = headed || is_head(lines->line());
      ++removed;
    } else {
      writer->write(lines->line());
      writer->write(lines->ending());
    }
  }
  if (auto whole = lines->whole(); !whole) {
    return std::unexpected(whole.error());
  }
  // compensate() puts a head into every program it corrects.
  if (removed > 0 && !headed) {
    return kernel::outcome::refuse(
        program, first, "has a STEADYREST comment, but the program has no head of corrections",
        std::string(kAgainstOthers));
  }
  if (auto written = writer->commit(); !written) {
    return std::unexpected(written.error());
  }
  return removed + back->removed;
}

}  // namespace steadyrest::nc::rewrite
