// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include <steadyrest/nc/read/letter/letter_line.hpp>
#include <steadyrest/nc/read/letter/macro_expression.hpp>
#include <steadyrest/nc/read/text/character.hpp>

// Custom macros in a line of the dialect `fanuc`.
namespace steadyrest::nc::read {
namespace {

// Statements of custom macros that begin with a word instead of an address.
// The first six control the flow; the others write to files and printers.
constexpr std::array<std::string_view, 11> kStatements = {
    "IF", "THEN", "GOTO", "WHILE", "DO", "END", "SETVN", "POPEN", "PCLOS", "DPRNT", "BPRNT"};

}  // namespace

// False when a statement with a word of several letters begins here.
bool LetterLine::macro_keyword() {
  // One letter is an address: `D1`, but `DO1` and `DPRNT[…]`.
  if (at_ + 1 == end_ || !is_letter(at_[1])) {
    return true;
  }
  const char* stop = at_;
  while (stop != end_ && is_letter(*stop)) {
    ++stop;
  }
  const std::string_view letters{at_, static_cast<std::size_t>(stop - at_)};
  const auto same = [&](std::string_view keyword) {
    return std::ranges::equal(letters, keyword, {}, upper);
  };
  const auto* const found = std::ranges::find_if(kStatements, same);
  if (found == kStatements.end()) {
    return true;
  }
  at_ = end_;
  constexpr std::size_t kFlow = 6;  // the keywords before are of flow control
  return found - kStatements.begin() < static_cast<std::ptrdiff_t>(kFlow)
             ? refuse(letters, "flow_control",
                      "a jump, condition or loop of a custom macro is not interpreted")
             : refuse(letters, "macro_output", "the output of a custom macro is not interpreted");
}

// A value that is not a plain number: `X#5`, `X[…]`, `X-#5`. It is rounded to the address's
// increment.
bool LetterLine::macro_value(const char* word_begin, Word& word) {
  // 0 for addresses whose increment depends on the control's settings: their values are not
  // rounded.
  const double increment = reading_.values->increment(word.letter);
  MacroExpression expression(line(), offset(), *reading_.values, increment);
  if (!behind(word_begin, expression, expression.read(word.value))) {
    return false;
  }
  // IS-B: the control works in increments, so X12.3456 moves to 12.346.
  if (increment > 0.0) {
    word.value = std::round(word.value / increment) * increment;
  }
  word.decimal_point = true;  // a calculated value is in units, never in increments
  word.calculated = true;
  return true;
}

// `#5 = …`; `#5 = #0` makes #5 vacant.
bool LetterLine::macro_statement() {
  const char* const from = at_++;
  // On the control an assignment is a block of its own, executed as it is read, ahead of the
  // motion.
  if (assigned_ || !block_.words().empty() || block_.flow().kind != FlowKind::none) {
    at_ = end_;
    return refuse(since(from), "macro_statement",
                  "in this dialect an assignment needs a separate block");
  }
  int index = 0;
  // Within a variable's own number or value ROUND rounds to whole numbers.
  MacroExpression number(line(), offset(), *reading_.values, 1.0);
  if (!behind(from, number, number.variable_number(index))) {
    return false;
  }
  skip_blanks();
  if (at_ == end_ || *at_ != '=') {
    return refuse(since(from), "bad_assignment", "a variable without an assignment; write #5=2");
  }
  ++at_;
  skip_blanks();
  double value = 0.0;
  // Only #0 itself makes a variable vacant, never a calculation with it.
  const bool vacant = end_ - at_ >= 2 && at_[0] == '#' && at_[1] == '0' &&
                      (end_ - at_ == 2 || is_blank(at_[2]) || at_[2] == ';' || at_[2] == '(');
  if (vacant) {
    at_ += 2;
    value = std::numeric_limits<double>::quiet_NaN();
  } else {
    MacroExpression right(line(), offset(), *reading_.values, 1.0);
    if (!behind(from, right, right.read_sum(value))) {
      return false;
    }
  }
  assigned_ = true;
  const Lookup lookup = reading_.values->set_number(index, value);
  // The same texts as for reading a variable.
  const LookupText why = macro_lookup_text(lookup);
  return lookup == Lookup::found || refuse(since(from), why.reason, why.text);
}

}  // namespace steadyrest::nc::read
