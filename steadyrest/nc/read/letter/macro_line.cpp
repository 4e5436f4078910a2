// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <limits>

#include <steadyrest/nc/read/letter/letter_line.hpp>
#include <steadyrest/nc/read/letter/macro_expression.hpp>
#include <steadyrest/nc/read/text/character.hpp>
#include <steadyrest/nc/read/text/number.hpp>

// Custom macros in a line of the dialect `fanuc`.
namespace steadyrest::nc::read {
namespace {

// Statements of custom macros that begin with a word instead of an address.
// The first five control the flow; the others write to files and printers.
constexpr std::array<std::string_view, 11> kStatements = {
    "IF", "GOTO", "WHILE", "DO", "END", "THEN", "SETVN", "POPEN", "PCLOS", "DPRNT", "BPRNT"};

constexpr std::string_view kJumpText =
    "a jump, condition or loop is written GOTO 10, IF[#1 EQ 2]GOTO 10, IF[#1 EQ 2]THEN #3=4, "
    "WHILE[#1 LT 5]DO1, DO1 or END1, alone in its block";

}  // namespace

// False when a statement with a word of several letters begins here and is refused; `done` when it
// was read.
bool LetterLine::macro_keyword(bool& done) {
  // One letter is an address: `D1`, but `DO1` and `DPRNT[…]`.
  if (at_ + 1 == end_ || !is_letter(at_[1])) {
    return true;
  }
  const char* const from = at_;
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
  constexpr std::size_t kFlow = 5;
  if (found - kStatements.begin() < static_cast<std::ptrdiff_t>(kFlow) &&
      reading_.values != nullptr) {
    at_ = stop;
    return done = macro_flow(from, *found);
  }
  at_ = end_;
  return same("THEN") || found - kStatements.begin() < static_cast<std::ptrdiff_t>(kFlow)
             ? refuse(letters, "flow_control", kJumpText)
             : refuse(letters, "macro_output", "the output of a custom macro is not interpreted");
}

// FANUC Series 30i operator's manual, "Branch and repetition".
bool LetterLine::macro_flow(const char* from, std::string_view keyword) {
  if (assigned_ || !block_.words().empty() || block_.flow().kind != FlowKind::none) {
    at_ = end_;
    return refuse(since(from), "flow_control", kJumpText);
  }
  Flow& flow = block_.flow();
  flow.label.clear();
  flow.count = 0;
  flow.unknown = 0;
  flow.holds = true;
  flow.towards = Towards::anywhere;
  if (keyword == "GOTO") {
    return macro_jump(from);
  }
  if (keyword == "IF") {
    return macro_condition(from);
  }
  flow.kind = FlowKind::end_loop;
  if (keyword == "WHILE") {
    double holds = 0.0;
    MacroExpression condition(line(), offset(), *reading_.values, 1.0);
    if (!behind(from, condition, condition.read_condition(holds))) {
      return false;
    }
    flow.holds = holds != 0.0;
    flow.unknown = reading_.values->take_unknown() ? 1U : 0U;
    skip_blanks();
    if (!rest().starts_with("DO") && !rest().starts_with("do")) {
      at_ = end_;
      return refuse(since(from), "flow_control", kJumpText);
    }
    at_ += 2;
    flow.kind = FlowKind::loop_while;
  } else if (keyword == "DO") {
    flow.kind = FlowKind::loop;
  }
  return macro_loop_number(from);
}

bool LetterLine::macro_loop_number(const char* from) {
  skip_blanks();
  const Number number = read_number(rest());
  at_ += number.length;
  const bool one_to_three = number.value == 1.0 || number.value == 2.0 || number.value == 3.0;
  return (number.length == 1 && one_to_three) ||
         refuse(since(from), "loop_number", "a loop is numbered DO1 to DO3 and END1 to END3");
}

// IF[…]GOTO n, IF[…]THEN #i=…
bool LetterLine::macro_condition(const char* from) {
  Flow& flow = block_.flow();
  double holds = 0.0;
  MacroExpression condition(line(), offset(), *reading_.values, 1.0);
  if (!behind(from, condition, condition.read_condition(holds))) {
    return false;
  }
  flow.holds = holds != 0.0;
  skip_blanks();
  const auto next = [&](std::string_view keyword) {
    const bool is = std::ranges::equal(rest().substr(0, keyword.size()), keyword, {}, upper);
    at_ += is ? keyword.size() : 0;
    return is;
  };
  if (next("GOTO")) {
    flow.unknown = reading_.values->take_unknown() ? 1U : 0U;
    return macro_jump(from);
  }
  if (next("THEN")) {
    return macro_then();
  }
  at_ = end_;
  return refuse(since(from), "flow_control", kJumpText);
}

// The target is a number, a variable or an expression.
bool LetterLine::macro_jump(const char* from) {
  Flow& flow = block_.flow();
  flow.kind = FlowKind::jump;
  if (!flow.holds && flow.unknown == 0) {
    at_ = end_;  // the control does not look at the target either
    return true;
  }
  double number = 0.0;
  MacroExpression target(line(), offset(), *reading_.values, 1.0);
  if (!behind(from, target, target.read(number))) {
    return false;
  }
  flow.unknown |= reading_.values->take_unknown() ? Flow::kUnknownLabel | 1U : 0U;
  constexpr double kMost = 99'999'999.0;
  if (!(number >= 1.0 && number <= kMost) || number != std::round(number)) {
    return refuse(since(from), "no_jump_target",
                  "a jump to a block number that is not a whole number from 1 to 99999999");
  }
  std::array<char, 16> digits{};
  const auto written = std::to_chars(digits.begin(), digits.end(), static_cast<long>(number));
  flow.label.push('N');
  for (const char* digit = digits.begin(); digit != written.ptr; ++digit) {
    flow.label.push(*digit);
  }
  return true;
}

// The assignment follows. Where the control decides about it, it has an unknown value if it is made
// here, and is noted as a jump in doubt if not.
bool LetterLine::macro_then() {
  Flow& flow = block_.flow();
  skip_blanks();
  if (at_ == end_ || *at_ != '#') {
    at_ = end_;
    return refuse(rest(), "flow_control", kJumpText);
  }
  if (flow.holds) {
    return true;
  }
  at_ = end_;
  if (reading_.values->take_unknown()) {
    flow.kind = FlowKind::jump;
    flow.unknown = 1U;
  }
  return true;
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
  if (std::isnan(word.value)) {
    if (word.letter == 'G' || word.letter == 'M' || word.letter == 'N') {
      const LookupText why = macro_lookup_text(Lookup::no_such_name);
      return refuse(since(word_begin), why.reason, why.text);
    }
    return true;
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
    const bool variable = at_ != end_ && *at_ == '#';
    MacroExpression right(line(), offset(), *reading_.values, 1.0);
    if (!behind(from, right, right.read_sum(value))) {
      return false;
    }
    // `#5=#1` makes #5 vacant as #1 is; whether `#5=-#1` does is not certain.
    if (std::isnan(value) && !variable) {
      const LookupText why = macro_lookup_text(Lookup::no_such_name);
      return refuse(since(from), why.reason, why.text);
    }
  }
  assigned_ = true;
  const Lookup lookup = reading_.values->set_number(index, value);
  // The same texts as for reading a variable.
  const LookupText why = macro_lookup_text(lookup);
  return lookup == Lookup::found || refuse(since(from), why.reason, why.text);
}

}  // namespace steadyrest::nc::read
