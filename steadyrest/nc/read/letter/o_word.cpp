// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <charconv>
#include <cmath>

#include <steadyrest/nc/read/letter/expression.hpp>
#include <steadyrest/nc/read/letter/o_word.hpp>
#include <steadyrest/nc/read/text/character.hpp>
#include <steadyrest/nc/read/text/name.hpp>

namespace steadyrest::nc::read {
namespace {

/// How many values follow a keyword.
/// `return` and `endsub` may return a value; `sub` and `call` have up to 30.
enum class Takes : unsigned char { nothing, one, perhaps_one, any };

struct Keyword {
  std::string_view name;
  FlowKind kind;
  Takes takes;
};
// LinuxCNC 2.9's O-words and how many values each takes.
constexpr std::array kOWords = {
    Keyword{"sub", FlowKind::sub, Takes::any},
    Keyword{"endsub", FlowKind::endsub, Takes::perhaps_one},
    Keyword{"return", FlowKind::back, Takes::perhaps_one},
    Keyword{"call", FlowKind::call, Takes::any},
    Keyword{"if", FlowKind::when, Takes::one},
    Keyword{"elseif", FlowKind::elseif, Takes::one},
    Keyword{"else", FlowKind::otherwise, Takes::nothing},
    Keyword{"endif", FlowKind::endif, Takes::nothing},
    Keyword{"while", FlowKind::loop_while, Takes::one},
    Keyword{"endwhile", FlowKind::endwhile, Takes::nothing},
    Keyword{"do", FlowKind::loop_do, Takes::nothing},
    Keyword{"repeat", FlowKind::repeat, Takes::one},
    Keyword{"endrepeat", FlowKind::endrepeat, Takes::nothing},
    Keyword{"break", FlowKind::leave_loop, Takes::nothing},
    Keyword{"continue", FlowKind::next_turn, Takes::nothing},
};

// By kind, since a lone label has no keyword to look up.
constexpr Takes takes(FlowKind kind) noexcept {
  for (const Keyword& keyword : kOWords) {
    if (keyword.kind == kind) {
      return keyword.takes;
    }
  }
  return Takes::nothing;
}

}  // namespace

// Finds an O-word without reading the rest: skipped lines may hold anything.
std::size_t o_word_at(std::string_view line) noexcept {
  std::size_t at = 0;
  const auto skip = [&](auto unwanted) {
    while (at < line.size() && unwanted(line[at])) {
      ++at;
    }
  };
  // The block-delete mark and a line number may come first.
  skip([](char c) { return is_blank(c) || c == '/'; });
  if (at < line.size() && upper(line[at]) == 'N') {
    ++at;
    skip([](char c) { return is_blank(c) || is_digit(c) || c == '.'; });
  }
  return at < line.size() && upper(line[at]) == 'O' ? at + 1 : 0;
}

bool OWord::fail(std::string_view reason, std::string_view text) noexcept {
  reason_ = reason;
  text_ = text;
  return false;
}

// In small letters, past blanks; NUL at the end of the line.
char OWord::peek() noexcept {
  while (at_ < line_.size() && is_blank(line_[at_])) {
    ++at_;
  }
  return at_ < line_.size() ? lower(line_[at_]) : '\0';
}

// The Expression works on the same line, from the position of this word.
bool OWord::value(double& out) {
  Expression expression(line_, at_, values_);
  const bool read = expression.read(out);
  at_ += expression.length();
  return read || fail(expression.reason(), expression.text());
}

// Without `evaluate` only label and keyword are read, so a value that does not exist yet cannot
// stop a skipped line.
bool OWord::read(Flow& flow, bool evaluate) {
  flow.kind = FlowKind::none;
  flow.count = 0;
  flow.unknown = 0;
  if (!label(flow) || !keyword(flow)) {
    return false;
  }
  return !evaluate || arguments(flow);
}

// O100, O<name>, O#1 or O[…]. Numbers and names share one space: a label is text from here on.
bool OWord::label(Flow& flow) {
  constexpr std::string_view kText =
      "an O-word without its label; write O and a whole number, or O<name>";
  flow.label.clear();
  const char first = peek();
  if (first == '<') {
    const char* const after =
        read_name(line_.data() + at_, line_.data() + line_.size(), flow.label);
    if (after == nullptr) {
      return fail("o_word", "an O-word name that is empty, too long or not closed by >");
    }
    at_ = static_cast<std::size_t>(after - line_.data());
    return true;
  }
  // A label may be calculated: O#1, O[100+#2]. Its digits are its name from then on.
  double number = 0.0;
  if (is_digit(first)) {
    for (char c = peek(); is_digit(c); c = peek()) {
      number = number * 10.0 + (c - '0');
      ++at_;
    }
  } else if (first != '#' && first != '[') {
    return fail("o_word", kText);
  } else if (!value(number)) {
    return false;
  } else if (values_.take_unknown()) {
    flow.unknown |= Flow::kUnknownLabel;
  }
  const double whole = std::round(number);
  // As for parameter numbers: within 0.0001 of a whole one.
  if (!(std::abs(number - whole) < 1e-4) || !(whole >= 0.0 && whole < 1e9)) {
    return fail("o_word", "an O-word whose label is not a whole number from 0");
  }
  std::array<char, 16> digits{};
  const auto end =
      std::to_chars(digits.data(), digits.data() + digits.size(), static_cast<long>(whole)).ptr;
  for (const char* at = digits.data(); at != end; ++at) {
    flow.label.push(*at);
  }
  return true;
}

// In small letters: LinuxCNC does not tell case apart.
bool OWord::keyword(Flow& flow) {
  std::array<char, 12> name{};
  std::size_t length = 0;
  // Twelve letters hold the longest keyword, endrepeat.
  for (char c = peek(); is_letter(c) && length < name.size(); c = peek()) {
    name[length++] = c;
    ++at_;
  }
  // A number alone heads a program for M98, as on FANUC controls.
  if (length == 0) {
    flow.kind = FlowKind::label;
    return true;
  }
  for (const Keyword& keyword : kOWords) {
    if (keyword.name == std::string_view{name.data(), length}) {
      flow.kind = keyword.kind;
      return true;
    }
  }
  return fail("o_word",
              "an O-word with an unknown keyword; the known ones are sub endsub return call if "
              "elseif else endif while endwhile do repeat endrepeat break continue");
}

// Values in [ ], one after another, as many as the keyword takes.
bool OWord::arguments(Flow& flow) {
  const Takes wanted = takes(flow.kind);
  if (wanted == Takes::nothing) {
    return true;
  }
  while (peek() == '[') {
    // A condition takes one value; what follows it is left to the line, which refuses it.
    if (flow.count == (wanted == Takes::any ? Flow::kMostArguments : 1)) {
      return wanted == Takes::any ? fail("o_word", "more than 30 arguments") : true;
    }
    if (!value(flow.values[flow.count])) {
      return false;
    }
    flow.unknown |= values_.take_unknown() ? std::uint32_t{1} << flow.count : 0U;
    ++flow.count;
  }
  return wanted != Takes::one || flow.count == 1 ||
         fail("o_word", "this O-word needs a value in [ ]: a condition or a count");
}

}  // namespace steadyrest::nc::read
