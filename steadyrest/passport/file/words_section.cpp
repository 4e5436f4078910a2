// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <charconv>
#include <optional>
#include <string>
#include <string_view>

#include <fmt/core.h>

#include <steadyrest/passport/file/words_section.hpp>

namespace steadyrest::passport {
namespace {

using kernel::machine::BuildersWord;
using Does = BuildersWord::Does;

constexpr std::string_view kAllowed =
    "write \"none\", \"stop\", \"dwell 0.5\" (seconds), \"moves X Z\" (axes) or \"opaque\"";
constexpr std::size_t kMostWords = 1000;
constexpr std::size_t kLongest = 60;

std::string in_capitals(std::string_view text) {
  std::string out;
  for (const char c : text) {
    out += c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  }
  return out;
}

/// A letter with its number without leading zeros or sign, or a name.
bool is_word(std::string_view word) {
  const auto letter = [](char c) { return (c >= 'A' && c <= 'Z') || c == '_'; };
  const auto digit = [](char c) { return c >= '0' && c <= '9'; };
  return !word.empty() && word.size() <= kLongest && letter(word.front()) &&
         std::ranges::all_of(word, [&](char c) { return letter(c) || digit(c) || c == '.'; });
}

/// `M08` is M8, as controls read it.
std::string without_zeros(std::string word) {
  while (word.size() > 2 && word[1] == '0' && word[2] >= '0' && word[2] <= '9') {
    word.erase(1, 1);
  }
  return word;
}

std::optional<BuildersWord> meaning(std::string_view text) {
  const std::size_t space = std::min(text.find(' '), text.size());
  const std::string_view verb = text.substr(0, space);
  const std::string_view rest = text.substr(std::min(space + 1, text.size()));
  BuildersWord out;
  if (rest.empty()) {
    out.does = verb == "none" ? Does::nothing : verb == "stop" ? Does::stop : Does::opaque;
    return verb == "none" || verb == "stop" || verb == "opaque" ? std::optional(out) : std::nullopt;
  }
  if (verb == "dwell") {
    constexpr double kLongest_s = 3600.0;
    out.does = Does::dwell;
    const auto end = std::from_chars(rest.data(), rest.data() + rest.size(), out.dwell_s);
    return end.ptr == rest.data() + rest.size() && out.dwell_s >= 0.0 && out.dwell_s <= kLongest_s
               ? std::optional(out)
               : std::nullopt;
  }
  out.does = Does::moves;
  for (const char c : rest) {
    const bool axis = std::string_view{"XYZABCUVW"}.find(c) != std::string_view::npos;
    if (verb != "moves" || (c != ' ' && (!axis || out.axes.find(c) != std::string::npos))) {
      return std::nullopt;
    }
    out.axes += axis ? std::string(1, c) : "";
  }
  return out.axes.empty() ? std::nullopt : std::optional(out);
}

}  // namespace

void read_words(const toml::table& table, std::vector<BuildersWord>& out, Faults& faults) {
  for (const auto& [name, node] : table) {
    const std::string word = without_zeros(in_capitals(name.str()));
    const auto text = node.value<std::string>();
    if (!is_word(word)) {
      faults.add(line_of(name.source()),
                 fmt::format("[program.words] has {}, which is no word", cut(name.str())),
                 "write a letter with its number (M50, G187), or a name (L_TIME)");
      continue;
    }
    auto does = text ? meaning(*text) : std::nullopt;
    if (!does) {
      faults.add(line_of(name.source()), fmt::format("{} = {}", cut(name.str()), shown(node)),
                 std::string(kAllowed));
      continue;
    }
    if (std::ranges::find(out, word, &BuildersWord::word) != out.end()) {
      faults.add(line_of(name.source()), fmt::format("[program.words] has {} twice", word),
                 "keep one of the lines");
      continue;
    }
    if (out.size() == kMostWords) {
      faults.add(line_of(name.source()),
                 fmt::format("[program.words] has more than {} words", kMostWords),
                 "keep those that the programs have");
      return;
    }
    does->word = word;
    out.push_back(std::move(*does));
  }
}

}  // namespace steadyrest::passport
