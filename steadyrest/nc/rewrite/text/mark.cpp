// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <charconv>

#include <fmt/core.h>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/nc/rewrite/text/mark.hpp>
#include <steadyrest/nc/rewrite/text/replaced_text.hpp>
#include <steadyrest/nc/rewrite/text/settings.hpp>
#include <steadyrest/nc/rewrite/text/source_lines.hpp>
#include <steadyrest/nc/rewrite/text/tag.hpp>

namespace steadyrest::nc::rewrite {
namespace {

constexpr std::string_view kSum = "sum";
// A comment must not contain brackets, and a control may capitalise letters or drop blanks: any
// character but these is written as =XX.
constexpr std::string_view kPlain = "-_./+,:";

bool is_plain(char c) noexcept {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
         kPlain.find(c) != std::string_view::npos;
}

std::string decoded(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    unsigned byte = 0;
    if (text[i] == '=' && i + 2 < text.size() &&
        std::from_chars(&text[i + 1], &text[i + 1] + 2, byte, 16).ptr == &text[i + 1] + 2) {
      // Two hexadecimal digits are a byte; anything else after = stays as it is.
      out += static_cast<char>(byte);
      i += 2;
    } else {
      out += text[i];
    }
  }
  return out;
}

// FNV-1a.
constexpr std::uint32_t kBasis = 2166136261U;

std::uint32_t with(std::uint32_t sum, char c) noexcept {
  constexpr std::uint32_t kPrime = 16777619U;
  return (sum ^ static_cast<unsigned char>(c)) * kPrime;
}

/// Over the words as they are written.
/// Not against forgery: it shows that the line was edited or truncated.
std::string sum_of(const std::vector<Told>& told) {
  std::uint32_t sum = kBasis;
  for (const Told& one : told) {
    for (const char c : told_as_text(one) + " ") {
      sum = with(sum, c);
    }
  }
  return fmt::format("{:08x}", sum);
}

void read_line(std::string_view text, std::vector<Told>& told) {
  // Words as on a command line: --name value, or --name alone.
  while (!text.empty()) {
    const std::string_view word = text.substr(0, text.find(' '));
    text.remove_prefix(std::min(text.size(), word.size() + 1));
    if (word.starts_with("--")) {
      told.push_back({.name = decoded(word.substr(2)), .value = {}});
    } else if (!word.empty() && !told.empty()) {
      told.back().value = decoded(word);
    }
  }
}

}  // namespace

std::string told_as_text(const Told& one) {
  std::string text = "--" + one.name + (one.value.empty() ? "" : " ");
  for (const char c : one.value) {
    text += is_plain(c)
                ? std::string(1, c)
                : fmt::format("={:02X}", static_cast<unsigned>(static_cast<unsigned char>(c)));
  }
  return text;
}

std::string mark_text(const Way& way, std::vector<Told> told, std::string_view ending,
                      std::string_view begin) {
  if (told.empty()) {
    return {};
  }
  // Last, over all others: a truncated mark has no sum.
  told.push_back({.name = std::string{kSum}, .value = sum_of(told)});
  const bool sinumerik = of_sinumerik(way.method);
  std::string text;
  std::string line;
  const auto put = [&] {
    if (!line.empty()) {
      text += fmt::format("{}{}{}{}{}", sinumerik ? ";" : "(", begin, line, sinumerik ? "" : ")",
                          ending);
      line.clear();
    }
  };
  for (const Told& one : told) {
    const std::string word = told_as_text(one);
    // Controls limit the line length, so the record may take several lines; a word is never split.
    if (line.size() + 1 + word.size() > kLongestTold) {
      put();
    }
    line += (line.empty() ? "" : " ") + word;
  }
  put();
  return text;
}

void BlocksSum::add(std::string_view line) noexcept {
  for (const char c : line) {
    if (static_cast<unsigned char>(c) > ' ') {
      sum_ = with(sum_, c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c);
    }
  }
}

std::string BlocksSum::text() const {
  return fmt::format("{:08x}", sum_);
}

kernel::outcome::Result<Blocks> compare_blocks(const std::string& changed,
                                               const std::vector<Told>& told) {
  const auto written = std::ranges::find(told, kBlocksSum, &Told::name);
  auto lines = SourceLines::open(changed);
  if (!lines) {
    return std::unexpected(lines.error());
  }
  BlocksSum sum;
  while (lines->next()) {
    if (is_new(lines->line()) || read_was(lines->line())) {
      sum.add(lines->line());
    }
  }
  if (written == told.end()) {
    return Blocks::unknown;
  }
  return written->value == sum.text() ? Blocks::whole : Blocks::edited;
}

bool is_mark(std::string_view line, std::string_view begin) noexcept {
  const bool round = line.starts_with('(') && line.ends_with(')');
  return (round || line.starts_with(';')) && line.substr(1).starts_with(begin);
}

namespace {

/// The mark of a file, and whether there are lines that need one.
struct Found {
  std::vector<Told> told;
  bool needed = false;
};

template <class Needs>
kernel::outcome::Result<Found> find_mark(const std::string& changed, std::string_view begin,
                                         Needs&& needs) {
  auto lines = SourceLines::open(changed);
  if (!lines) {
    return std::unexpected(lines.error());
  }
  Found found;
  while (lines->next()) {
    std::string_view line = lines->line();
    found.needed = found.needed || needs(line);
    if (is_mark(line, begin)) {
      line.remove_suffix(line.starts_with('(') ? 1 : 0);
      line.remove_prefix(1 + begin.size());
      read_line(line, found.told);
      found.needed = true;
    } else if (!found.told.empty()) {
      // A second mark further down would be another program's.
      break;  // it is in one piece
    }
  }
  return found;
}

/// The options without the sum that covers them.
kernel::outcome::Result<std::vector<Told>> checked(const std::string& changed, Found found,
                                                   std::string_view to_do) {
  Told sum;
  if (!found.told.empty()) {
    sum = std::move(found.told.back());
    found.told.pop_back();
  }
  if (found.needed && (sum.name != kSum || sum.value != sum_of(found.told))) {
    return kernel::outcome::refuse(
        changed, "the record in its head of how it was made is missing or changed",
        std::string(to_do));
  }
  return std::move(found.told);
}

}  // namespace

// A program without inserted lines needs no mark.
kernel::outcome::Result<std::vector<Told>> read_mark(const std::string& changed) {
  auto found = find_mark(changed, kInsertedMark, [](std::string_view line) {
    return (is_inserted(line) && !was_replacing(line)) ||
           changed_mark(line).starts_with("HEADTOLD--");
  });
  return found ? checked(changed, std::move(*found), kAgainstOtherLines)
               : std::unexpected(found.error());
}

kernel::outcome::Result<std::vector<Told>> read_replaced_mark(const std::string& changed) {
  auto found = find_mark(changed, kReplacedMark, was_replacing);
  return found ? checked(changed, std::move(*found),
                         "make the program again from its original; a control or an editor may "
                         "have changed its comments")
               : std::unexpected(found.error());
}

}  // namespace steadyrest::nc::rewrite
