// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>

#include <steadyrest/nc/read/heidenhain/klartext_value.hpp>
#include <steadyrest/nc/read/text/character.hpp>

namespace steadyrest::nc::read {

// The comma is what the control itself shows and writes in many languages.
Number read_klartext_number(std::string_view text) noexcept {
  std::size_t length = 0;
  std::array<char, 48> points{};
  bool comma = false;
  while (length < text.size() && length < points.size() &&
         (is_digit(text[length]) || text[length] == '.' || text[length] == ',' ||
          (length == 0 && (text[0] == '+' || text[0] == '-')))) {
    comma = comma || text[length] == ',';
    points[length] = text[length] == ',' ? '.' : text[length];
    ++length;
  }
  return comma ? read_number({points.data(), length}) : read_number(text);
}

QName read_q_name(std::string_view text) noexcept {
  if (text.empty() || upper(text[0]) != 'Q') {
    return {};
  }
  std::size_t at = 1;
  int index = 0;
  if (at < text.size() && (upper(text[at]) == 'L' || upper(text[at]) == 'R')) {
    index = upper(text[at]) == 'L' ? kFirstLocalQ : kFirstKeptQ;
    ++at;
  }
  const std::size_t digits = at;
  int number = 0;
  // Four digits are the most; a fifth leaves a number that no parameter has.
  for (; at < text.size() && is_digit(text[at]) && at - digits < 5; ++at) {
    number = number * 10 + (text[at] - '0');
  }
  if (at == digits) {
    return {};
  }
  constexpr int kNone = -1;
  return {.index = number < 10'000 ? index + number : kNone, .length = at};
}

LookupText klartext_lookup_text(Lookup lookup) noexcept {
  if (lookup == Lookup::no_such_number) {
    return {.reason = "no_such_parameter",
            .text =
                "a Q parameter that the control does not have; allowed: Q0 to Q1999, QL0 to "
                "QL499, QR0 to QR499"};
  }
  return {.reason = "unset_parameter",
          .text =
              "a Q parameter that was never set in this program; the value left in the control "
              "is unknown"};
}

}  // namespace steadyrest::nc::read
