// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <cstddef>

#include <steadyrest/nc/read/letter/expression.hpp>
#include <steadyrest/nc/read/text/character.hpp>
#include <steadyrest/nc/read/text/name.hpp>
#include <steadyrest/nc/read/text/number.hpp>

namespace steadyrest::nc::read {
namespace {

constexpr double kEqual =
    1e-4;  // LinuxCNC: EQ, NE, and how far an index may be from a whole number

constexpr int kWeakest = 1;  // AND OR XOR

}  // namespace

// LinuxCNC 2.9: five levels, all from left to right, so that 2 ** 3 ** 2 is 64.
constexpr std::array<Sign, 15> Expression::kSigns = {{
    {"**", Operator::power, 5},
    {"*", Operator::times, 4},
    {"/", Operator::over, 4},
    {"MOD", Operator::modulo, 4},
    {"+", Operator::plus, 3},
    {"-", Operator::minus, 3},
    {"EQ", Operator::eq, 2},
    {"NE", Operator::ne, 2},
    {"GT", Operator::gt, 2},
    {"GE", Operator::ge, 2},
    {"LT", Operator::lt, 2},
    {"LE", Operator::le, 2},
    {"AND", Operator::both, 1},
    {"OR", Operator::either, 1},
    {"XOR", Operator::one, 1},
}};

// LinuxCNC drops blanks and case within names: #<A b> is #<ab>.
const char* read_name(const char* at, const char* end, Name& name) noexcept {
  name.clear();
  for (++at; at != end && *at != '>'; ++at) {
    if (!is_blank(*at) && (is_control(*at) || !name.push(lower(*at)))) {
      return nullptr;
    }
  }
  return at == end || name.view().empty() ? nullptr : at + 1;
}

bool Expression::read(double& out) {
  return operand(out);
}

// A signed value: bracket, parameter, number or function.
bool Expression::operand(double& out) {
  const bool negative = turned();
  const char c = peek();
  const bool read =
      c == '['                  ? bracket(out)
      : c == '#'                ? parameter(out)
      : is_digit(c) || c == '.' ? spaced_number(out)
      : is_letter(c)
          ? function(out)
          : fail("missing_value", "a value is missing: a number, a parameter or [ ] belongs here");
  if (read && negative) {
    out = -out;
  }
  // The control checks only the final value: 4 MOD 0 inside a comparison passes.
  return read && finite(out);
}

// Blanks may lie between the digits of one number: LinuxCNC drops them before it reads the line. A
// number that ends where its text ends, or before something else, needs no copy.
bool Expression::spaced_number(double& out) {
  const Number number = read_number({at_, static_cast<std::size_t>(end_ - at_)});
  const char* const after = at_ + number.length;
  const char* look = after;
  while (look != end_ && is_blank(*look)) {
    ++look;
  }
  // Nothing follows that could belong to the number.
  if (number.length != 0 && (look == after || look == end_ || !(is_digit(*look) || *look == '.'))) {
    at_ = after;
    out = number.value;
    return true;
  }
  // The number without its blanks; a line of this dialect has at most 253 characters.
  std::array<char, 256> packed{};
  std::size_t length = 0;
  for (; at_ != end_ && length < packed.size(); ++at_) {
    if (is_digit(*at_) || *at_ == '.') {
      packed[length++] = *at_;
    } else if (!is_blank(*at_)) {
      break;
    }
  }
  const Number whole = read_number({packed.data(), length});
  out = whole.value;
  // Refuses two points, or no number at all.
  return (whole.length != 0 && whole.length == length) ||
         fail("bad_number", "not a number; write digits and one point");
}

// [ … ] with any expression inside, down to the weakest operator.
bool Expression::bracket(double& out) {
  // A bound on the recursion: a line of 250 brackets would otherwise be 250 calls deep.
  if (++depth_ > kDeepest) {
    return fail("expression_too_deep", "brackets nested more than 64 deep");
  }
  ++at_;
  if (!climb(out, kWeakest)) {
    return false;
  }
  if (peek() != ']') {
    return fail("unclosed_expression", at_ == end_
                                           ? "an expression that is not closed; write ] at its end"
                                           : "an operator or ] belongs here");
  }
  ++at_;
  --depth_;
  return true;
}

/// The truth value of a comparison or a logical operator.
bool Expression::holds(Operator op, double a, double b) noexcept {
  const double apart = std::abs(a - b);  // NaN after 4 MOD 0: neither EQ nor NE
  switch (op) {
    // Numbers nearer than 0.0001 count as equal, so that loops over decimal steps end where they
    // seem to. The order comparisons have no such tolerance.
    case Operator::eq:
      return apart < kEqual;
    case Operator::ne:
      return apart >= kEqual;
    case Operator::gt:
      return a > b;
    case Operator::ge:
      return a >= b;
    case Operator::lt:
      return a < b;
    case Operator::le:
      return a <= b;
    case Operator::both:
      return a != 0.0 && b != 0.0;
    case Operator::either:
      return a != 0.0 || b != 0.0;
    default:  // XOR
      return (a != 0.0) != (b != 0.0);
  }
}

// operand() and the caller check the final value for infinities, so 4 MOD 0 may occur inside a
// comparison, as in rs274.
bool Expression::apply(Operator op, double& left, double right) {
  switch (op) {
    case Operator::power:
      // std::pow would return NaN.
      // A negative number has real powers only for whole exponents.
      if (left < 0.0 && right != std::floor(right)) {
        return fail("not_finite", "a negative number to a power that is not whole");
      }
      left = std::pow(left, right);
      break;
    case Operator::times:
      left *= right;
      break;
    case Operator::over:
      // rs274 refuses it too: an infinity would end up in a coordinate.
      if (right == 0.0) {
        return fail("division_by_zero", "a division by zero");
      }
      left /= right;
      break;
    case Operator::modulo:
      // rs274's MOD is never negative; std::fmod takes the dividend's sign.
      left = std::fmod(left, right);
      left += left < 0.0 ? std::abs(right) : 0.0;
      break;
    case Operator::plus:
      left += right;
      break;
    case Operator::minus:
      left -= right;
      break;
    default:
      left = holds(op, left, right) ? 1.0 : 0.0;
      break;
  }
  return true;
}

// The number behind # may be an expression itself: ##3, #[1+2].
bool Expression::parameter_number(int& index) {
  double number = 0.0;
  if (++depth_ > kDeepest) {
    return fail("expression_too_deep", "parameters nested more than 64 deep");
  }
  if (!operand(number)) {
    return false;
  }
  --depth_;
  const double whole = std::round(number);
  // 1.00005 counts as 1: a calculated number is rarely whole to the last digit.
  if (!(std::abs(number - whole) <= kEqual)) {
    return fail("not_an_integer", "a parameter number that is not a whole number");
  }
  // Before the cast, which is undefined beyond an int.
  if (!(std::abs(whole) < 1e9)) {
    return fail("no_such_parameter", "a parameter the control does not have");
  }
  index = static_cast<int>(whole);
  return true;
}

// Why a parameter has no value, in LinuxCNC's terms.
bool Expression::looked_up(Lookup lookup) {
  switch (lookup) {
    case Lookup::found:
      return true;
    case Lookup::no_such_number:
      return fail("no_such_parameter", "a parameter the control does not have");
    case Lookup::no_such_name:
      return fail("unset_parameter",
                  "a named parameter that was never set; set it before, or ask EXISTS");
    case Lookup::read_only:
      return fail("read_only_parameter", "a read-only parameter");
    case Lookup::not_while_compensating:
      return fail("position_in_cutter_comp",
                  "the current position while cutter radius compensation is on");
    case Lookup::kept_by_control:
      return fail("parameter_of_the_control",
                  "a parameter that the control may have from before the program");
    case Lookup::assigned_in_block:  // of other dialects
    case Lookup::vacant:
    case Lookup::not_known_here:
      break;
  }
  return fail("parameter_of_the_machine", "a parameter whose value only the running control knows");
}

bool Expression::parameter_name(Name& name) {
  const char* const after = read_name(at_, end_, name);
  if (after == nullptr) {
    return fail("bad_parameter", "a parameter name that is empty, too long or not closed by >");
  }
  at_ = after;
  return true;
}

// #5, #[…], ##5 or #<name>; the value is looked up while the line is read, as on the control.
bool Expression::parameter(double& out) {
  ++at_;
  if (peek() == '<') {
    Name name;
    return parameter_name(name) && looked_up(values_.name(name.view(), out));
  }
  int index = 0;
  return parameter_number(index) && looked_up(values_.number(index, out));
}

}  // namespace steadyrest::nc::read
