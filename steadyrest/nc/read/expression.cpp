// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <cstddef>

#include <steadyrest/nc/read/character.hpp>
#include <steadyrest/nc/read/expression.hpp>
#include <steadyrest/nc/read/name.hpp>
#include <steadyrest/nc/read/number.hpp>

namespace steadyrest::nc::read {
namespace {

constexpr double kEqual =
    1e-4;  // LinuxCNC: EQ, NE, and how far an index may be from a whole number

constexpr char lower(char c) noexcept {
  return is_letter(c) ? static_cast<char>(static_cast<unsigned char>(c) | 0x20U) : c;
}

constexpr int kWeakest = 1;  // AND OR XOR

}  // namespace

enum class Expression::Operator : unsigned char {
  power,
  times,
  over,
  modulo,
  plus,
  minus,
  eq,
  ne,
  gt,
  ge,
  lt,
  le,
  both,
  either,
  one
};

const char* read_name(const char* at, const char* end, Name& name) noexcept {
  name.clear();
  for (++at; at != end && *at != '>'; ++at) {
    if (!is_blank(*at) && (is_control(*at) || !name.push(lower(*at)))) {
      return nullptr;
    }
  }
  return at == end || name.view().empty() ? nullptr : at + 1;
}

bool Expression::fail(std::string_view reason, std::string_view text) noexcept {
  reason_ = reason;
  text_ = text;
  return false;
}

void Expression::skip_blanks() noexcept {
  while (at_ != end_ && is_blank(*at_)) {
    ++at_;
  }
}

char Expression::peek() noexcept {
  skip_blanks();
  return at_ == end_ ? '\0' : lower(*at_);
}

bool Expression::finite(double value) {
  return std::isfinite(value) || fail("not_finite", "a calculation without a finite result");
}

bool Expression::read(double& out) {
  return value(out);
}

bool Expression::value(double& out) {
  bool negative = false;
  for (char c = peek(); c == '+' || c == '-'; c = peek()) {
    negative ^= c == '-';
    ++at_;
  }
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
  // The control looks at whole values only: 4 MOD 0 inside of a comparison is let through.
  return read && finite(out);
}

bool Expression::spaced_number(double& out) {
  const Number number = read_number({at_, static_cast<std::size_t>(end_ - at_)});
  const char* const after = at_ + number.length;
  const char* look = after;
  while (look != end_ && is_blank(*look)) {
    ++look;
  }
  if (number.length != 0 && (look == after || look == end_ || !(is_digit(*look) || *look == '.'))) {
    at_ = after;
    out = number.value;
    return true;
  }
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
  return (whole.length != 0 && whole.length == length) ||
         fail("bad_number", "not a number; write digits and one point");
}

bool Expression::bracket(double& out) {
  if (++depth_ > kDeepest) {
    return fail("expression_too_deep", "brackets nested more than 64 deep");
  }
  ++at_;
  if (!sum_of(out, kWeakest)) {
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

// Precedence climbing: operands of operators at least as strong as `weakest`.
bool Expression::sum_of(double& out, int weakest) {
  if (!value(out)) {
    return false;
  }
  for (;;) {
    const char* const before = at_;
    Operator op{};
    int rank = 0;
    if (!operator_at(op, rank)) {
      return reason_.empty();
    }
    if (rank < weakest) {
      at_ = before;
      return true;
    }
    double right = 0.0;
    if (!sum_of(right, rank + 1) || !apply(op, out, right)) {
      return false;
    }
  }
}

// False without a reason: none stands here.
bool Expression::operator_at(Operator& found, int& rank) {
  struct Sign {
    std::string_view name;
    Operator op;
    int rank;
  };
  static constexpr std::array kSigns = {
      Sign{"**", Operator::power, 5}, Sign{"*", Operator::times, 4},
      Sign{"/", Operator::over, 4},   Sign{"mod", Operator::modulo, 4},
      Sign{"+", Operator::plus, 3},   Sign{"-", Operator::minus, 3},
      Sign{"eq", Operator::eq, 2},    Sign{"ne", Operator::ne, 2},
      Sign{"gt", Operator::gt, 2},    Sign{"ge", Operator::ge, 2},
      Sign{"lt", Operator::lt, 2},    Sign{"le", Operator::le, 2},
      Sign{"and", Operator::both, 1}, Sign{"or", Operator::either, 1},
      Sign{"xor", Operator::one, 1},
  };
  for (const Sign& sign : kSigns) {
    const char* at = at_;
    std::size_t matched = 0;
    for (; matched < sign.name.size(); ++matched) {
      while (at != end_ && is_blank(*at)) {
        ++at;
      }
      if (at == end_ || lower(*at) != sign.name[matched]) {
        break;
      }
      ++at;
    }
    if (matched == sign.name.size()) {
      at_ = at;
      found = sign.op;
      rank = sign.rank;
      return true;
    }
  }
  return false;
}

bool Expression::apply(Operator op, double& left, double right) {
  const double a = left;
  const auto truth = [](bool yes) { return yes ? 1.0 : 0.0; };
  const bool equal = std::abs(a - right) < kEqual;
  switch (op) {
    case Operator::power:
      if (a < 0.0 && right != std::floor(right)) {
        return fail("not_finite", "a negative number to a power that is not whole");
      }
      left = std::pow(a, right);
      break;
    case Operator::times:
      left = a * right;
      break;
    case Operator::over:
      if (right == 0.0) {
        return fail("division_by_zero", "a division by zero");
      }
      left = a / right;
      break;
    case Operator::modulo:
      left = std::fmod(a, right);
      left += left < 0.0 ? std::abs(right) : 0.0;
      break;
    case Operator::plus:
      left = a + right;
      break;
    case Operator::minus:
      left = a - right;
      break;
    case Operator::eq:
      left = truth(equal);
      break;
    case Operator::ne:
      left = truth(!equal);
      break;
    case Operator::gt:
      left = truth(a > right);
      break;
    case Operator::ge:
      left = truth(a >= right);
      break;
    case Operator::lt:
      left = truth(a < right);
      break;
    case Operator::le:
      left = truth(a <= right);
      break;
    case Operator::both:
      left = truth(a != 0.0 && right != 0.0);
      break;
    case Operator::either:
      left = truth(a != 0.0 || right != 0.0);
      break;
    case Operator::one:
      left = truth((a != 0.0) != (right != 0.0));
      break;
  }
  return true;
}

bool Expression::parameter_number(int& index) {
  double number = 0.0;
  if (++depth_ > kDeepest) {
    return fail("expression_too_deep", "parameters nested more than 64 deep");
  }
  if (!value(number)) {
    return false;
  }
  --depth_;
  const double whole = std::round(number);
  if (!(std::abs(number - whole) <= kEqual)) {
    return fail("not_an_integer", "a parameter's number that is not a whole number");
  }
  if (!(std::abs(whole) < 1e9)) {
    return fail("no_such_parameter", "a parameter that the control has not");
  }
  index = static_cast<int>(whole);
  return true;
}

bool Expression::looked_up(Lookup lookup) {
  switch (lookup) {
    case Lookup::found:
      return true;
    case Lookup::no_such_number:
      return fail("no_such_parameter", "a parameter that the control has not");
    case Lookup::no_such_name:
      return fail("unset_parameter",
                  "a named parameter that was never set; set it before, or ask EXISTS");
    case Lookup::read_only:
      return fail("read_only_parameter", "a parameter that cannot be set");
    case Lookup::not_while_compensating:
      return fail("position_in_cutter_comp",
                  "the present position while cutter radius compensation is on");
    case Lookup::assigned_in_block:
    case Lookup::not_known_here:
      break;
  }
  return fail("parameter_of_the_machine", "a parameter whose value only the running control knows");
}

bool Expression::parameter(double& out) {
  ++at_;
  if (peek() == '<') {
    Name name;
    const char* const after = read_name(at_, end_, name);
    if (after == nullptr) {
      return fail("bad_parameter", "a parameter's name that is empty, too long or not closed by >");
    }
    at_ = after;
    return looked_up(values_.name(name.view(), out));
  }
  int index = 0;
  return parameter_number(index) && looked_up(values_.number(index, out));
}

}  // namespace steadyrest::nc::read
