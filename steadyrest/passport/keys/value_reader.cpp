// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdlib>

#include <steadyrest/passport/keys/section_reader.hpp>

// Reads one value and reports what is wrong with it: what was seen, its type, what is allowed, what
// to write. A value is never repaired.
namespace steadyrest::passport {
namespace {

constexpr std::size_t kShownCharacters = 40;
/// Every whole number up to here is a double, the next one is not.
constexpr double kMostExact = 0x1p53;

/// TOML's types in words a user knows.
std::string_view type_name(const toml::node& node) {
  switch (node.type()) {
    case toml::node_type::table:
      return "a table";
    case toml::node_type::array:
      return "a list";
    case toml::node_type::string:
      return "a text";
    case toml::node_type::integer:
      return "a whole number";
    case toml::node_type::floating_point:
      return "a number";
    case toml::node_type::boolean:
      return "a switch, true or false";
    default:
      return "a date or time";
  }
}

}  // namespace

/// A value in a message must not flood the terminal.
std::string cut(std::string_view text) {
  if (text.size() <= kShownCharacters) {
    return std::string(text);
  }
  std::size_t end = kShownCharacters;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) {
    --end;  // not in the middle of a character
  }
  return std::string(text.substr(0, end)) + "…";
}

/// Ten digits; a whole number keeps all its digits, as it may be the end of a range.
std::string shown(double value) {
  std::string out = fmt::format("{:.10g}", value);
  const bool whole = std::abs(value) <= kMostExact && value == std::floor(value);
  return whole && std::strtod(out.c_str(), nullptr) != value ? fmt::format("{:.0f}", value) : out;
}

/// A value as written in the file; lists and tables only by their type.
std::string shown(const toml::node& node) {
  if (const auto* text = node.as_string()) {
    return fmt::format("\"{}\"", cut(text->get()));
  }
  if (const auto* integer = node.as_integer()) {
    return fmt::format("{}", integer->get());
  }
  if (const auto* number = node.as_floating_point()) {
    return shown(number->get());
  }
  if (const auto* boolean = node.as_boolean()) {
    return boolean->get() ? "true" : "false";
  }
  return std::string(type_name(node));
}

/// toml++ counts lines from 1; 0 means the file as a whole.
const toml::table* table_below(Faults& faults, const toml::table& parent, std::string_view name,
                               std::string_view shown_name) {
  const toml::node* node = parent.get(name);
  if (node == nullptr) {
    return nullptr;
  }
  const toml::table* table = node->as_table();
  if (table == nullptr) {
    faults.add(line_of(node->source()), fmt::format("{} = {} is not a section", name, shown(*node)),
               fmt::format("write {} on a separate line, with its keys below", shown_name));
  }
  return table;
}

std::size_t line_of(const toml::source_region& source) {
  return source.begin.line;
}

/// One form for all: what the key was given, its type, what it needs.
void ValueReader::wrong_type(const toml::node& node, std::string_view needed,
                             std::string_view way) const {
  // Lists, tables and dates are shown by their type only.
  const bool by_type = shown(node) == type_name(node);
  faults_.add(line_of(node.source()),
              fmt::format("{}{} is {}; {} is needed", key_,
                          by_type ? std::string() : " = " + shown(node), type_name(node), needed),
              std::string(way));
}

bool ValueReader::in_range(const toml::node& node, double value) const {
  // TOML has inf and nan. Neither is a limit: a missing key means no limit.
  if (std::isfinite(value) && value >= min_ && value <= max_) {
    return true;
  }
  const std::string_view unit = unit_of(key_).shown;
  const std::string range =
      fmt::format("{} … {}{}{}", shown(min_), shown(max_), unit.empty() ? "" : " ", unit);
  faults_.add(line_of(node.source()),
              fmt::format("{} = {} is {}; allowed: {}", key_, shown(node),
                          std::isfinite(value) ? "out of range" : "not a finite number", range),
              std::isfinite(value) ? "give a value in that range"
                                   : "give a finite value; leave the key out if there is no limit");
  return false;
}

bool ValueReader::number(const toml::node& node, double& out) const {
  // Whole numbers are fine where a number is needed; quoted ones are not, for "50" is a text and a
  // unit in quotes would be lost.
  if (!node.is_integer() && !node.is_floating_point()) {
    const std::string_view unit = unit_of(key_).shown;
    wrong_type(node, unit.empty() ? "a number" : fmt::format("a number in {}", unit),
               "write the bare number, without quotes or unit");
    return false;
  }
  const double value = node.value<double>().value_or(std::numeric_limits<double>::quiet_NaN());
  if (!in_range(node, value)) {
    return false;
  }
  out = value;
  return true;
}

/// To TOML 1e3 is floating point even though it is whole.
bool ValueReader::integer(const toml::node& node, std::int64_t& out) const {
  const auto* value = node.as_integer();
  if (value == nullptr) {
    wrong_type(node, "a whole number", "write it without decimal point, exponent or quotes");
    return false;
  }
  // Ranges of whole keys end at 2^53 at the latest. Up to there a double is exact; 2^53 + 1 would
  // be rounded into such a range.
  constexpr auto kMost = static_cast<std::int64_t>(kMostExact);
  const bool exact = value->get() >= -kMost && value->get() <= kMost;
  const auto rounded = static_cast<double>(value->get());
  if (!in_range(node, exact ? rounded : 2.0 * rounded)) {
    return false;
  }
  out = value->get();
  return true;
}

bool ValueReader::boolean(const toml::node& node, bool& out) const {
  const auto* value = node.as_boolean();
  if (value == nullptr) {
    wrong_type(node, "true or false", "write true or false, without quotes");
    return false;
  }
  out = value->get();
  return true;
}

bool ValueReader::text(const toml::node& node, std::string& out) const {
  const auto* value = node.as_string();
  if (value == nullptr) {
    wrong_type(node, "a text", "put it in quotes");
    return false;
  }
  const std::string& text = value->get();
  // The length is in bytes; names are short enough for that not to matter.
  if (static_cast<double>(text.size()) < min_ || static_cast<double>(text.size()) > max_) {
    faults_.add(line_of(node.source()),
                fmt::format("{} = {} has {} characters; allowed: {} … {}", key_, shown(node),
                            text.size(), shown(min_), shown(max_)),
                "shorten or fill it");
    return false;
  }
  // A name is printed into tables, comments and pages, so no line breaks.
  if (std::any_of(text.begin(), text.end(),
                  [](char c) { return static_cast<unsigned char>(c) < 0x20U || c == 0x7F; })) {
    faults_.add(line_of(node.source()), fmt::format("{} has a control character", key_),
                "write one line of plain text");
    return false;
  }
  out = text;
  return true;
}

/// Words are compared exactly: case and blanks count, and the refusal lists what is allowed.
bool ValueReader::choice(const toml::node& node, std::span<const std::string_view> words,
                         std::size_t& out) const {
  std::string allowed;
  for (const std::string_view word : words) {
    allowed += allowed.empty() ? "" : ", ";
    allowed += word;
  }
  const auto* value = node.as_string();
  if (value == nullptr) {
    wrong_type(node, fmt::format("one of {}", allowed), "put one of these words in quotes");
    return false;
  }
  const auto found = std::find(words.begin(), words.end(), value->get());
  if (found == words.end()) {
    // A typing error gets the nearest word as a suggestion.
    const std::string_view close = kernel::outcome::nearest(value->get(), words);
    faults_.add(line_of(node.source()),
                fmt::format("{} = {} is unknown; allowed: {}{}", key_, shown(node),
                            words.size() > 1 ? "one of " : "only ", allowed),
                words.size() == 1 ? fmt::format("write \"{}\"", words.front())
                : close.empty()   ? "choose one of them"
                                  : fmt::format("write \"{}\" if that is what you mean", close));
    return false;
  }
  out = static_cast<std::size_t>(found - words.begin());
  return true;
}

const toml::array* ValueReader::list(const toml::node& node, std::string_view of) const {
  const auto* array = node.as_array();
  if (array == nullptr) {
    wrong_type(node, fmt::format("a list of {}", of), "write [first, second, …]");
    return nullptr;
  }
  // Limited, because a list of a million entries in place of four is a wrong file.
  if (array->empty() || array->size() > max_entries_) {
    faults_.add(
        line_of(node.source()),
        fmt::format("{} has {} entries; allowed: 1 … {}", key_, array->size(), max_entries_),
        "give a list of that length");
    return nullptr;
  }
  return array;
}

/// A list of numbers, each within the key's range.
bool ValueReader::numbers(const toml::node& node, std::vector<double>& out) const {
  const toml::array* array = list(node, "numbers");
  if (array == nullptr) {
    return false;
  }
  out.reserve(array->size());
  // The first bad element ends the list: a thousand identical faults help nobody.
  for (const toml::node& element : *array) {
    double value = 0.0;
    if (!number(element, value)) {
      return false;
    }
    out.push_back(value);
  }
  return true;
}

bool ValueReader::integers(const toml::node& node, std::vector<std::uint32_t>& out) const {
  const toml::array* array = list(node, "whole numbers");
  if (array == nullptr) {
    return false;
  }
  for (const toml::node& element : *array) {
    std::int64_t value = 0;
    if (!integer(element, value)) {
      return false;
    }
    out.push_back(static_cast<std::uint32_t>(value));
  }
  return true;
}

}  // namespace steadyrest::passport
