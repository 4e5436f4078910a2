// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include <steadyrest/nc/read/heidenhain/klartext_expression.hpp>
#include <steadyrest/nc/read/heidenhain/klartext_value.hpp>

namespace steadyrest::nc::read {
namespace {

constexpr double kKlartextDegree = std::numbers::pi / 180.0;

}  // namespace

constexpr std::array<Sign, 6> KlartextExpression::kSigns = {{
    {"^", Operator::power, 3},
    {"*", Operator::times, 2},
    {"/", Operator::over, 2},
    {"%", Operator::modulo, 2},
    {"+", Operator::plus, 1},
    {"-", Operator::minus, 1},
}};

bool KlartextExpression::read(double& out) {
  return climb(out, 1);
}

bool KlartextExpression::read_operand(double& out) {
  const bool negative = turned();
  const char c = peek();
  if (c != 'Q' && c != '.' && c != ',' && !is_digit(c)) {
    return fail("missing_value", "a number or a Q parameter belongs here");
  }
  if (!unsigned_operand(out)) {
    return false;
  }
  out = negative ? -out : out;
  return true;
}

// Signs belong to their operand: 5 * -3.
bool KlartextExpression::operand(double& out) {
  const bool negative = turned();
  if (!unsigned_operand(out)) {
    return false;
  }
  if (negative && peek() == '^') {
    return fail("sign_before_power",
                "a signed operand before ^; write brackets, as -(3 ^ 2) or (-3) ^ 2");
  }
  out = negative ? -out : out;
  return true;
}

bool KlartextExpression::unsigned_operand(double& out) {
  const char c = peek();
  if (c == '(') {
    if (++depth_ > kDeepest) {
      return fail("nested_too_deep", "an expression nested too deep");
    }
    ++at_;
    if (!climb(out, 1)) {
      return false;
    }
    if (peek() != ')') {
      return fail("unclosed_expression", at_ == end_
                                             ? "an expression that is not closed"
                                             : "an operator or a closing bracket belongs here");
    }
    ++at_;
    --depth_;
    return true;
  }
  const std::string_view rest{at_, static_cast<std::size_t>(end_ - at_)};
  if (const QName name = read_q_name(rest); name.length != 0) {
    at_ += name.length;
    const LookupText why = klartext_lookup_text(Lookup::no_such_number);
    if (name.index < 0) {
      return fail(why.reason, why.text);
    }
    const Lookup lookup = values_.number(name.index, out);
    const LookupText other = klartext_lookup_text(lookup);
    return lookup == Lookup::found || fail(other.reason, other.text);
  }
  if (const Number number = read_klartext_number(rest); number.length != 0) {
    at_ += number.length;
    out = number.value;
    return true;
  }
  return is_letter(c) ? function(out)
                      : fail("missing_value", "a number, a Q parameter or a function belongs here");
}

bool KlartextExpression::function(double& out) {
  std::array<char, 5> name{};
  std::size_t length = 0;
  while (at_ != end_ && is_letter(*at_)) {
    if (length == name.size()) {
      return fail("unknown_function", "a function that is not known");
    }
    name[length++] = upper(*at_++);
    // SIN Q5 is also written without a blank.
    const std::string_view known{name.data(), length};
    if (at_ != end_ && upper(*at_) == 'Q' && known != "S") {
      break;
    }
  }
  const std::string_view text{name.data(), length};
  if (text == "PI") {
    out = std::numbers::pi;
    return true;
  }
  if (++depth_ > kDeepest) {
    return fail("nested_too_deep", "an expression nested too deep");
  }
  double x = 0.0;
  const bool negative = turned();
  if (!unsigned_operand(x)) {
    return false;
  }
  --depth_;
  return call(text, negative ? -x : x, out);
}

bool KlartextExpression::call(std::string_view name, double x, double& out) {
  struct Function {
    std::string_view name;
    double (*of)(double);
  };
  static constexpr std::array kFunctions = {
      Function{"SIN", [](double v) { return std::sin(v * kKlartextDegree); }},
      Function{"COS", [](double v) { return std::cos(v * kKlartextDegree); }},
      Function{"TAN", [](double v) { return std::tan(v * kKlartextDegree); }},
      Function{"ASIN", [](double v) { return std::asin(v) / kKlartextDegree; }},
      Function{"ACOS", [](double v) { return std::acos(v) / kKlartextDegree; }},
      Function{"ATAN", [](double v) { return std::atan(v) / kKlartextDegree; }},
      Function{"SQ", [](double v) { return v * v; }},
      Function{"SQRT", [](double v) { return std::sqrt(v); }},
      Function{"LN", [](double v) { return std::log(v); }},
      Function{"LOG", [](double v) { return std::log10(v); }},
      Function{"EXP", [](double v) { return std::exp(v); }},
      Function{"NEG", [](double v) { return -v; }},
      Function{"INT", [](double v) { return std::trunc(v); }},
      Function{"ABS", [](double v) { return std::abs(v); }},
      Function{"FRAC", [](double v) { return v - std::trunc(v); }},
      Function{"SGN", [](double v) { return v > 0.0   ? 1.0
                                            : v < 0.0 ? -1.0
                                                      : 0.0; }},
  };
  const auto* const found = std::ranges::find(kFunctions, name, &Function::name);
  if (found == kFunctions.end()) {
    return fail("unknown_function", "a function that is not known");
  }
  out = found->of(x);
  return finite(out);
}

bool KlartextExpression::apply(Operator op, double& left, double right) {
  switch (op) {
    case Operator::power:
      left = std::pow(left, right);
      break;
    case Operator::times:
      left *= right;
      break;
    case Operator::over:
      left /= right;
      break;
    case Operator::modulo:
      left = std::fmod(left, right);
      break;
    case Operator::plus:
      left += right;
      break;
    default:
      left -= right;
      break;
  }
  return finite(left);
}

}  // namespace steadyrest::nc::read
