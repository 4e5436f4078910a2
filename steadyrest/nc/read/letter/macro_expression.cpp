// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include <steadyrest/kernel/units/constants.hpp>
#include <steadyrest/nc/read/letter/macro_expression.hpp>
#include <steadyrest/nc/read/text/character.hpp>
#include <steadyrest/nc/read/text/number.hpp>

namespace steadyrest::nc::read {
namespace {

using kernel::units::kDegree;

// FANUC stores decimal numbers; 1e-9 takes up what a double leaves of 0.1·10.
constexpr double kWhole = 1e-9;  // how far a number may be from the whole one that is meant

// Two letters are enough (manual, "Custom macro"): no two functions share them.
constexpr std::array<std::string_view, 17> kFunctions = {
    "SIN", "COS", "TAN", "ASIN", "ACOS", "ATAN", "SQRT", "ABS", "ROUND",
    "FIX", "FUP", "LN",  "EXP",  "POW",  "BIN",  "BCD",  "ADP"};

// The whole name, or its first two letters.
std::string_view function_named(std::string_view name) noexcept {
  for (const std::string_view one : kFunctions) {
    if (name == one || (name.size() == 2 && one.substr(0, 2) == name)) {
      return one;
    }
  }
  return {};
}

}  // namespace

// Why a variable cannot be read or set, in FANUC's terms.
LookupText macro_lookup_text(Lookup lookup) noexcept {
  switch (lookup) {
    // Vacant is not 0: G0 X#1 with a vacant #1 does not move X at all. So reading a vacant variable
    // is always refused.
    case Lookup::no_such_name:
      return {.reason = "vacant_variable",
              .text =
                  "a variable that was never set in this program: it is vacant, and its effect "
                  "depends on the word; set it first"};
    case Lookup::read_only:
      return {.reason = "read_only_parameter", .text = "a read-only variable"};
    case Lookup::not_known_here:
    case Lookup::kept_by_control:
      return {.reason = "system_variable",
              .text = "a system variable whose value only the running control knows"};
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
  if (!read_sum(out)) {
    return false;
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

// Logical operators work on bits here, where LinuxCNC's work on truth values.
bool MacroExpression::apply(Operator op, double& left, double right) {
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

// A name and its bracket. BIN, BCD, ADP and POW are known but refused rather than guessed.
bool MacroExpression::function(double& out) {
  std::array<char, 8> letters{};
  std::size_t length = 0;
  const char* const first = at_;
  for (char c = peek(); is_letter(c) && length < letters.size(); c = peek()) {
    letters[length++] = c;
    ++at_;
  }
  const std::string_view name = function_named({letters.data(), length});
  if (peek() != '[') {
    at_ = first;
    return fail("missing_value", "a value is missing: a number, a variable or [ ] belongs here");
  }
  if (name.empty()) {
    return fail("unknown_function",
                "an unknown function; the known ones are ABS ACOS ASIN ATAN COS EXP FIX FUP LN "
                "ROUND SIN SQRT TAN");
  }
  if (name == "BIN" || name == "BCD" || name == "ADP" || name == "POW") {
    return fail("function_not_interpreted", "BIN, BCD, ADP and POW are not interpreted");
  }
  // Only ATAN takes one value or two, in two spellings, so its bracket is not closed here.
  double x = 0.0;
  if (name == "ATAN") {
    ++at_;
    if (++depth_ > kDeepest) {
      return fail("expression_too_deep", "brackets nested more than five deep");
    }
    return read_sum(x) && arc_tangent(x, out);
  }
  return bracket(x) && evaluate(name, x, out);
}

// Angles in degrees. The arc functions have FANUC's ranges, not those of C++.
bool MacroExpression::evaluate(std::string_view name, double x, double& out) {
  const auto domain = [&](bool inside, std::string_view text) {
    return inside || fail("out_of_domain", text);
  };
  if (name == "SIN") {
    out = std::sin(x * kDegree);
  } else if (name == "COS") {
    out = std::cos(x * kDegree);
  } else if (name == "TAN") {
    out = std::tan(x * kDegree);
  } else if (name == "ASIN" || name == "ACOS") {
    if (!domain(x >= -1.0 && x <= 1.0, "ASIN or ACOS of a number outside -1 to 1")) {
      return false;
    }
    out = (name == "ACOS" ? std::acos(x) : std::asin(x)) / kDegree;
    // FANUC, parameter 6004#0 = 0: ASIN gives 270° to 90°. ACOS is never negative.
    out += out < 0.0 ? 360.0 : 0.0;
  } else if (name == "SQRT") {
    if (!domain(x >= 0.0, "SQRT of a negative number")) {
      return false;
    }
    out = std::sqrt(x);
  } else if (name == "ABS") {
    out = std::abs(x);
  } else if (name == "ROUND") {
    // In F, S, P and the like the least increment depends on the control's setting.
    if (!(increment_ > 0.0)) {
      return fail("function_not_interpreted",
                  "ROUND in this word: its rounding increment is unknown");
    }
    // Within a word ROUND rounds to the least increment of its address, not to a whole number.
    out = std::round(x / increment_) * increment_;
  } else if (name == "FIX") {
    // By magnitude, unlike LinuxCNC's: FIX[-1.2] is −1, FUP[-1.2] is −2.
    out = std::trunc(x);
  } else if (name == "FUP") {
    out = x < 0.0 ? std::floor(x) : std::ceil(x);
  } else if (name == "LN") {
    if (!domain(x > 0.0, "LN of a number that is not above zero")) {
      return false;
    }
    out = std::log(x);
  } else {
    out = std::exp(x);
  }
  return finite(out);
}

// ATAN[y]/[x], ATAN[y,x] or ATAN[a]; the first value has been read.
bool MacroExpression::arc_tangent(double y, double& out) {
  double x = 0.0;
  bool pair = peek() == ',';
  if (pair) {
    ++at_;
    if (!read_sum(x)) {
      return false;
    }
  }
  if (peek() != ']') {
    return fail("unclosed_expression", "an operator or ] belongs here");
  }
  ++at_;
  --depth_;
  // After the bracket a / may be a division: `ATAN[1]/5`. Only `/[` makes a pair.
  const char* const behind = at_;
  if (!pair && peek() == '/') {
    ++at_;
    pair = peek() == '[';
    if (!pair) {  // a division: not read here
      at_ = behind;
    } else if (!bracket(x)) {
      return false;
    }
  }
  // Two zeros have no direction.
  if (pair && x == 0.0 && y == 0.0) {
    return fail("out_of_domain", "ATAN of two zeros");
  }
  out = (pair ? std::atan2(y, x) : std::atan(y)) / kDegree;
  // Again 0° to 360°; ATAN of one value keeps −90° to 90°.
  out += pair && out < 0.0 ? 360.0 : 0.0;
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
  const Lookup lookup = values_.number(index, out);
  const LookupText why = macro_lookup_text(lookup);
  return lookup == Lookup::found || fail(why.reason, why.text);
}

}  // namespace steadyrest::nc::read
