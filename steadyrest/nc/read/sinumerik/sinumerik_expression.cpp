// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <system_error>

#include <steadyrest/nc/read/sinumerik/sinumerik_expression.hpp>
#include <steadyrest/nc/read/sinumerik/sinumerik_names.hpp>
#include <steadyrest/nc/read/text/character.hpp>
#include <steadyrest/nc/read/text/name.hpp>
#include <steadyrest/nc/read/text/number.hpp>

namespace steadyrest::nc::read {
namespace {

constexpr double kRelativelyEqual = 1e-12;  // the manual: relative equality of the comparisons
// Ranks as in kSigns: comparisons are the weakest, signs and NOT the strongest.
constexpr int kComparison = 0;
constexpr int kStrongest = 9;

bool whole(double x) noexcept {
  return x == std::floor(x);
}

}  // namespace

// Priorities of "Job Planning". Unlike in C, comparisons bind last, even after AND and OR.
// Longer signs come before their own beginnings: <> and <= before <.
constexpr std::array<Sign, 18> SinumerikExpression::kSigns = {{
    {"*", Operator::times, 8},
    {"/", Operator::over, 8},
    {"DIV", Operator::div, 8},
    {"MOD", Operator::modulo, 8},
    {"+", Operator::plus, 7},
    {"-", Operator::minus, 7},
    {"B_AND", Operator::bit_and, 6},
    {"B_XOR", Operator::bit_xor, 5},
    {"B_OR", Operator::bit_or, 4},
    {"AND", Operator::both, 3},
    {"XOR", Operator::one, 2},
    {"OR", Operator::either, 1},
    {"==", Operator::eq, 0},
    {"<>", Operator::ne, 0},
    {"<=", Operator::le, 0},
    {">=", Operator::ge, 0},
    {"<", Operator::lt, 0},
    {">", Operator::gt, 0},
}};

// The control does not tell case apart in names.
bool lower_name(std::string_view written, Name& name) noexcept {
  name.clear();
  return std::ranges::all_of(written, [&](char c) { return name.push(lower(c)); });
}

// Why a parameter or variable cannot be read or set, in SINUMERIK's terms.
LookupText sinumerik_lookup_text(Lookup lookup) noexcept {
  switch (lookup) {
    case Lookup::no_such_name:
      return {.reason = "unset_parameter",
              .text =
                  "a parameter or variable that was never set in this program; the value left in "
                  "the control is unknown"};
    // The order of assignments within a block is not certain: a variable set there may not be read
    // there.
    case Lookup::not_while_compensating:
    case Lookup::assigned_in_block:
      return {.reason = "order_of_assignments",
              .text = "a value set and used in one block; write two blocks"};
    case Lookup::read_only:
    case Lookup::not_known_here:
    case Lookup::kept_by_control:
    case Lookup::vacant:
    case Lookup::found:
    case Lookup::no_such_number:
      break;
  }
  return {.reason = "no_such_parameter", .text = "an R-parameter outside R0 to R999"};
}

bool SinumerikExpression::looked_up(Lookup lookup) {
  const LookupText why = sinumerik_lookup_text(lookup);
  return lookup == Lookup::found || fail(why.reason, why.text);
}

// Every open bracket is closed here, so the depth is counted down in one place.
bool SinumerikExpression::closing(char bracket) {
  if (peek() != bracket) {
    return fail("unclosed_expression", at_ == end_
                                           ? "an expression that is not closed"
                                           : "an operator or a closing bracket belongs here");
  }
  ++at_;
  --depth_;
  return true;
}

// A whole expression: from the weakest operator down.
bool SinumerikExpression::read(double& out) {
  return climb(out, kComparison);
}

// Truth values are 1 and 0, and everything but 0 is true.
bool SinumerikExpression::apply(Operator op, double& left, double right) {
  const double a = left;
  // Relative: 0.1 + 0.2 == 0.3 holds on the control.
  const bool equals = a == right || std::abs(a - right) <=
                                        kRelativelyEqual * std::max(std::abs(a), std::abs(right));
  const auto truth = [&](bool yes) {
    left = yes ? 1.0 : 0.0;
    return true;
  };
  switch (op) {
    case Operator::bit_and:
    case Operator::bit_xor:
    case Operator::bit_or:
      return bits(op, left, right);
    case Operator::both:
      return truth(a != 0.0 && right != 0.0);
    case Operator::one:
      return truth((a != 0.0) != (right != 0.0));
    case Operator::either:
      return truth(a != 0.0 || right != 0.0);
    case Operator::eq:
      return truth(equals);
    case Operator::ne:
      return truth(!equals);
    // Equal within the tolerance counts as ≤ and ≥, and as neither < nor >; the manual's example of
    // TRUNC depends on it.
    case Operator::le:
      return truth(equals || a < right);
    case Operator::ge:
      return truth(equals || a > right);
    case Operator::lt:
      return truth(!equals && a < right);
    case Operator::gt:
      return truth(!equals && a > right);
    default:
      return arithmetic(op, left, right);
  }
}

bool SinumerikExpression::arithmetic(Operator op, double& left, double right) {
  const bool divides = op == Operator::over || op == Operator::div || op == Operator::modulo;
  if (divides && right == 0.0) {
    return fail("division_by_zero", "a division by zero");
  }
  // What the control returns for negative numbers is not certain: refused.
  if ((op == Operator::div || op == Operator::modulo) && (left < 0.0 || right < 0.0)) {
    return fail("out_of_domain", "DIV or MOD of a negative number");
  }
  if (op == Operator::modulo && !(whole(left) && whole(right))) {
    return fail("not_an_integer", "MOD works on whole numbers");
  }
  left = op == Operator::times    ? left * right
         : op == Operator::over   ? left / right
         : op == Operator::div    ? std::trunc(left / right)
         : op == Operator::modulo ? std::fmod(left, right)
         : op == Operator::plus   ? left + right
                                  : left - right;
  return finite(left);
}

// Bits of 32-bit whole numbers; other values are refused.
bool SinumerikExpression::bits(Operator op, double& left, double right) {
  constexpr double kMost = 2147483647.0;
  if (!whole(left) || !whole(right) || left < 0.0 || right < 0.0 || left > kMost || right > kMost) {
    return fail("not_an_integer", "B_AND, B_OR and B_XOR work on whole numbers from 0");
  }
  const auto a = static_cast<std::uint32_t>(left);
  const auto b = static_cast<std::uint32_t>(right);
  left = op == Operator::bit_and ? a & b : op == Operator::bit_or ? a | b : a ^ b;
  return true;
}

// A signed operand, a bracket, a number, or a word: parameter, variable, function or constant.
bool SinumerikExpression::operand(double& out) {
  const char c = peek();
  const bool sign = c == '-' || c == '+';
  // A sign opens another level, so signs count for the depth as well.
  if ((sign || c == '(') && ++depth_ > kDeepest) {
    return fail("expression_too_deep", "brackets or signs nested more than 64 deep");
  }
  if (sign) {
    ++at_;
    // The sign binds tightest: -2+5 is 3.
    if (!climb(out, kStrongest)) {
      return false;
    }
    out = c == '-' ? -out : out;
    --depth_;
    return true;
  }
  if (c == '(') {
    ++at_;
    return climb(out, kComparison) && closing(')');
  }
  if (is_digit(c) || c == '.') {
    return number(out);
  }
  if (is_letter(c) || c == '_') {
    return word(out);
  }
  if (c == '$') {
    return system_variable(out);
  }
  return c == '"' && typed_ != nullptr ? text_comparison(out)
         : c == '\'' || c == '"'
             ? fail("bad_value", "a string or a binary number where a plain number belongs")
             : fail("missing_value", "a value is missing");
}

// 1.5, 1.5EX-3
bool SinumerikExpression::number(double& out) {
  const Number mantissa = read_number({at_, static_cast<std::size_t>(end_ - at_)});
  if (mantissa.length == 0) {
    return fail("bad_number", "not a number; write digits and one point");
  }
  at_ += mantissa.length;
  out = mantissa.value;
  if (at_ != end_ && *at_ == '.') {
    return fail("bad_number", "not a number; write digits and one point");
  }
  // Powers of ten are written EX on this control, since E could be an address.
  if (end_ - at_ >= 3 && upper(*at_) == 'E' && upper(at_[1]) == 'X') {
    const Number power = read_number({at_ + 2, static_cast<std::size_t>(end_ - at_ - 2)});
    if (power.length == 0 || power.decimal_point || std::abs(power.value) > 300.0) {
      return fail("bad_number", "not a number; EX takes a whole number from -300 to 300");
    }
    // Mantissa times power of ten would round twice.
    std::array<char, 80> written{};  // as C++ writes it: correctly rounded
    const std::size_t digits = mantissa.length;
    if (digits + power.length + 1 > written.size()) {
      return fail("bad_number", "a number with too many digits");
    }
    std::copy_n(at_ - digits, digits, written.begin());
    written[digits] = 'e';
    const char* const sign = at_[2] == '+' ? at_ + 3 : at_ + 2;
    const char* const stop = at_ + 2 + power.length;
    const char* const end = std::copy(sign, stop, written.begin() + static_cast<long>(digits) + 1);
    if (std::from_chars(written.data(), end, out).ec != std::errc{}) {
      return fail("bad_number", "a number outside the range of a double");
    }
    at_ = stop;
  }
  return finite(out);
}

// Names mean, in this order: constants, NOT, R-parameters, variables, functions.
bool SinumerikExpression::word(double& out) {
  const char* const first = at_;
  while (at_ != end_ && in_name(*at_)) {
    ++at_;
  }
  const std::string_view name{first, static_cast<std::size_t>(at_ - first)};
  if (equal(name, "TRUE") || equal(name, "FALSE")) {
    out = equal(name, "TRUE") ? 1.0 : 0.0;
    return true;
  }
  // NOT of a number: true for 0 alone.
  if (equal(name, "NOT") || equal(name, "B_NOT")) {
    if (name.size() > 3) {
      return fail("function_not_interpreted", "B_NOT is not interpreted");
    }
    if (++depth_ > kDeepest || !climb(out, kStrongest)) {
      return reason_.empty() ? fail("expression_too_deep", "more than 64 deep") : false;
    }
    --depth_;
    out = out == 0.0 ? 1.0 : 0.0;
    return true;
  }
  // R1 and R[…] are parameters; a name that begins with R and goes on with letters is not.
  const bool digits = name.size() > 1 && std::ranges::all_of(name.substr(1), is_digit);
  if (upper(name.front()) == 'R' && (digits || (name.size() == 1 && peek() == '['))) {
    return parameter(out, name);
  }
  Name variable;
  const bool short_enough = lower_name(name, variable);
  if (short_enough && typed_ != nullptr && typed_->text(variable.view()) != nullptr) {
    at_ = first;
    return text_comparison(out);
  }
  if (short_enough && peek() == '[') {
    return element(out, variable);
  }
  if (short_enough && peek() != '(' && peek() != '[') {
    const Lookup lookup = values_.name(variable.view(), out);
    return lookup == Lookup::no_such_name
               ? fail("variable", "a variable not defined (DEF) in this program")
               : looked_up(lookup);
  }
  return peek() == '(' ? function(name, out)
                       : fail("variable", "an array, or a word with no known value");
}

// R5 or R[…], whose index is an expression.
bool SinumerikExpression::parameter(double& out, std::string_view name) {
  double index = 0.0;
  // Past the [ that peek() has found.
  if (name.size() == 1) {
    ++at_;
    if (++depth_ > kDeepest) {
      return fail("expression_too_deep", "brackets nested more than 64 deep");
    }
    if (!climb(index, kComparison) || !closing(']')) {
      return false;
    }
  } else {
    index = read_number(name.substr(1)).value;
  }
  if (!whole(index) || index < 0.0 || index > 99999.0) {
    return fail("no_such_parameter", "an R-parameter outside R0 to R999");
  }
  return looked_up(values_.number(static_cast<int>(index), out));
}

}  // namespace steadyrest::nc::read
