// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include <steadyrest/nc/read/letter/macro_expression.hpp>
#include <steadyrest/nc/read/text/character.hpp>
#include <steadyrest/nc/read/text/number.hpp>

namespace steadyrest::nc::read {
namespace {

// FANUC stores decimal numbers; 1e-9 takes up what a double leaves of 0.1·10.
constexpr double kWhole = 1e-9;  // how far a number may be from the whole one that is meant

}  // namespace

// Why a variable cannot be read or set, in FANUC's terms.
LookupText macro_lookup_text(Lookup lookup) noexcept {
  switch (lookup) {
    // Vacant is not 0: G0 X#1 with a vacant #1 does not move X at all. So a variable that may be
    // vacant is refused.
    case Lookup::no_such_name:
      return {.reason = "vacant_variable",
              .text =
                  "a variable that was never set in this program: it is vacant, or has what the "
                  "control has kept in it; set it first"};
    case Lookup::read_only:
      return {.reason = "read_only_parameter", .text = "a read-only variable"};
    case Lookup::not_known_here:
    case Lookup::kept_by_control:
      return {.reason = "system_variable",
              .text = "a system variable whose value only the running control knows"};
    case Lookup::vacant:  // has no value, which is none of these
    case Lookup::found:
    case Lookup::not_while_compensating:
    case Lookup::assigned_in_block:
    case Lookup::no_such_number:
      break;
  }
  return {
      .reason = "no_such_parameter",
      .text =
          "a variable the control does not have; #1-#33, #100-#199 and #500-#999 are supported"};
}

// Two levels, from left to right: * / MOD AND before + - OR XOR (manual, "Arithmetic and logic
// operation").
constexpr std::array<Sign, 8> MacroExpression::kSigns = {{
    {"*", Operator::times, 2},
    {"/", Operator::over, 2},
    {"MOD", Operator::modulo, 2},
    {"AND", Operator::both, 2},
    {"+", Operator::plus, 1},
    {"-", Operator::minus, 1},
    {"OR", Operator::either, 1},
    {"XOR", Operator::one, 1},
}};

bool MacroExpression::read_sum(double& out) {
  return climb(out, 1);
}

// Brackets, variables, numbers and functions; an operand may carry signs.
bool MacroExpression::operand(double& out) {
  const bool negative = turned();
  const char c = peek();
  bool read = false;
  if (c == '[') {
    read = bracket(out);
  } else if (c == '#') {
    read = variable(out);
  } else if (is_digit(c) || c == '.') {
    const Number number = read_number({at_, static_cast<std::size_t>(end_ - at_)});
    at_ += number.length;
    out = number.value;
    read = number.length != 0 ||
           fail("bad_number", "not a number; write one sign at most, digits and one point");
  } else if (is_letter(c)) {
    read = function(out);
  } else {
    read = fail("missing_value", "a value is missing: a number, a variable or [ ] belongs here");
  }
  if (read && negative) {
    out = -out;
  }
  return read;
}

bool MacroExpression::bracket(double& out) {
  // FANUC allows five levels of brackets.
  if (++depth_ > kDeepest) {
    return fail("expression_too_deep", "brackets nested more than five deep");
  }
  ++at_;
  if (!(conditional_ ? comparison(out) : read_sum(out))) {
    return false;
  }
  if (std::isnan(out)) {  // whether [#1] is as vacant as #1 is not certain
    const LookupText why = macro_lookup_text(Lookup::no_such_name);
    return fail(why.reason, why.text);
  }
  const char c = peek();
  if (c != ']') {
    // EQ, NE, GT, GE, LT and LE only occur in conditions.
    const bool compares = c == 'E' || c == 'N' || c == 'G' || c == 'L';
    return compares ? fail("flow_control", "a comparison; conditions are not interpreted here")
           : at_ == end_
               ? fail("unclosed_expression", "an expression that is not closed; write ] at its end")
               : fail("unclosed_expression", "an operator or ] belongs here");
  }
  ++at_;
  --depth_;
  return true;
}

bool MacroExpression::read_condition(double& out) {
  if (peek() != '[') {
    return fail("missing_value", "a condition in brackets belongs here: [#1 EQ 2]");
  }
  conditional_ = true;
  return bracket(out) && (compared_ || fail("flow_control",
                                            "a condition compares: [#1 EQ 2], with EQ NE GT GE LT "
                                            "or LE"));
}

// What may be in a bracket of a condition.
bool MacroExpression::comparison(double& out) {
  if (!climb(out, 1)) {
    return false;
  }
  const std::array<char, 2> how = {peek(), at_ == end_ || at_ + 1 == end_ ? '\0' : upper(at_[1])};
  const std::string_view name{how.data(), how.size()};
  constexpr std::array<std::string_view, 6> kComparisons = {"EQ", "NE", "GT", "GE", "LT", "LE"};
  if (std::ranges::find(kComparisons, name) == kComparisons.end()) {
    return true;
  }
  at_ += 2;
  double right = 0.0;
  return climb(right, 1) && compare(name, out, right, out);
}

bool MacroExpression::compare(std::string_view how, double left, double right, double& out) {
  compared_ = true;
  const bool vacant = std::isnan(left) || std::isnan(right);
  if (vacant && (how == "EQ" || how == "NE")) {
    out = (std::isnan(left) && std::isnan(right)) == (how == "EQ") ? 1.0 : 0.0;
    return true;
  }
  const double a = std::isnan(left) ? 0.0 : left;
  const double b = std::isnan(right) ? 0.0 : right;
  if (a != b && std::abs(a - b) <= kWhole * std::max(std::abs(a), std::abs(b))) {
    return fail("comparison_near",
                "a comparison of numbers that are equal but for rounding: its result depends on "
                "the control; compare with a margin");
  }
  const bool holds = how == "EQ"   ? a == b
                     : how == "NE" ? a != b
                     : how == "GT" ? a > b
                     : how == "GE" ? a >= b
                     : how == "LT" ? a < b
                                   : a <= b;
  out = holds ? 1.0 : 0.0;
  return true;
}

// Logical operators work on bits here, where LinuxCNC's work on truth values.
bool MacroExpression::apply(Operator op, double& left, double right) {
  left = std::isnan(left) ? 0.0 : left;  // vacant
  right = std::isnan(right) ? 0.0 : right;
  switch (op) {
    case Operator::both:
    case Operator::either:
    case Operator::one:
      return bits(op, left, right);
    case Operator::over:
    case Operator::modulo:
      // Controls raise an alarm here.
      if (right == 0.0) {
        return fail("division_by_zero", "a division by zero");
      }
      left = op == Operator::over ? left / right : std::fmod(left, right);
      break;
    case Operator::times:
      left *= right;
      break;
    case Operator::plus:
      left += right;
      break;
    default:  // minus
      left -= right;
      break;
  }
  return finite(left);
}

bool MacroExpression::bits(Operator op, double& left, double right) {
  // Bits of a 32-bit number: fractions, negative and larger numbers are refused.
  constexpr double kMost = 2147483647.0;
  const auto whole = [](double x) {
    return x >= 0.0 && x <= kMost && std::abs(x - std::round(x)) <= kWhole;
  };
  if (!whole(left) || !whole(right)) {
    return fail("not_an_integer", "AND, OR and XOR work on whole numbers from 0");
  }
  const auto a = static_cast<std::uint32_t>(std::round(left));
  const auto b = static_cast<std::uint32_t>(std::round(right));
  left = op == Operator::both ? a & b : op == Operator::either ? a | b : a ^ b;
  return true;
}

// A plain number, or any expression in brackets.
bool MacroExpression::variable_number(int& index) {
  double number = 0.0;
  // FANUC does not know `##5`; #[#5] is its form.
  const char c = peek();
  if (c == '[') {
    if (!bracket(number)) {
      return false;
    }
  } else if (is_digit(c)) {
    // The bound keeps a long row of digits from becoming an infinity.
    for (char digit = peek(); is_digit(digit) && number < 1e9; digit = peek()) {
      number = number * 10.0 + (digit - '0');
      ++at_;
    }
  } else {
    return fail("bad_parameter", "a # without its number; write #5 or #[#5]");
  }
  const double whole = std::round(number);
  if (!(std::abs(number - whole) <= kWhole)) {
    return fail("not_an_integer", "a variable number that is not a whole number");
  }
  if (!(whole >= 0.0 && whole < 1e9)) {
    return fail("no_such_parameter", macro_lookup_text(Lookup::no_such_number).text);
  }
  index = static_cast<int>(whole);
  return true;
}

// The value is looked up while the block is read; vacant variables and those of the running control
// are refused by name.
bool MacroExpression::variable(double& out) {
  ++at_;
  int index = 0;
  if (!variable_number(index)) {
    return false;
  }
  const Lookup lookup = index == 0 ? Lookup::vacant : values_.number(index, out);
  if (lookup == Lookup::vacant) {
    out = std::numeric_limits<double>::quiet_NaN();
    return true;
  }
  const LookupText why = macro_lookup_text(lookup);
  return lookup == Lookup::found || fail(why.reason, why.text);
}

}  // namespace steadyrest::nc::read
