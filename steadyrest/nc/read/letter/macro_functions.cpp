// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

#include <steadyrest/kernel/units/constants.hpp>
#include <steadyrest/nc/read/letter/macro_expression.hpp>
#include <steadyrest/nc/read/text/character.hpp>

// The functions in expressions of custom macros.
namespace steadyrest::nc::read {
namespace {

using kernel::units::kDegree;

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

// A name and its bracket. ADP and POW are known but refused rather than guessed.
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
  if (name == "ADP" || name == "POW") {
    return fail("function_not_interpreted", "ADP and POW are not interpreted");
  }
  // Only ATAN takes one value or two, in two spellings, so its bracket is not closed here.
  double x = 0.0;
  if (name == "ATAN") {
    ++at_;
    if (++depth_ > kDeepest) {
      return fail("expression_too_deep", "brackets nested more than five deep");
    }
    return read_sum(x) && arc_tangent(std::isnan(x) ? 0.0 : x, out);
  }
  // A function's own bracket does not compare, and takes a vacant variable for 0.
  const bool conditional = std::exchange(conditional_, false);
  ++at_;
  if (++depth_ > kDeepest) {
    return fail("expression_too_deep", "brackets nested more than five deep");
  }
  if (!read_sum(x)) {
    return false;
  }
  if (peek() != ']') {
    return fail("unclosed_expression", "an operator or ] belongs here");
  }
  ++at_;
  --depth_;
  conditional_ = conditional;
  return evaluate(name, std::isnan(x) ? 0.0 : x, out);
}

// Packed decimals: BCD[29] is 16#29 = 41, BIN[41] is 29.
bool MacroExpression::decimal_digits(bool write, double x, double& out) {
  constexpr double kMostDecimal = 99'999'999.0;
  constexpr double kMostPacked = 2'576'980'377.0;  // 16#99999999
  if (!(x >= 0.0 && x <= (write ? kMostDecimal : kMostPacked)) || x != std::round(x)) {
    return fail("out_of_domain", "BIN or BCD of a number that is not eight decimal digits");
  }
  const std::uint32_t from = write ? 10 : 16;
  const std::uint32_t to = write ? 16 : 10;
  double place = 1.0;
  out = 0.0;
  for (auto rest = static_cast<std::uint32_t>(x); rest != 0; rest /= from, place *= to) {
    if (rest % from > 9) {
      return fail("out_of_domain", "BIN of a number with a digit above 9");
    }
    out += place * (rest % from);
  }
  return true;
}

// Angles in degrees. The arc functions have FANUC's ranges, not those of C++.
bool MacroExpression::evaluate(std::string_view name, double x, double& out) {
  const auto domain = [&](bool inside, std::string_view text) {
    return inside || fail("out_of_domain", text);
  };
  if (name == "BIN" || name == "BCD") {
    return decimal_digits(name == "BCD", x, out);
  }
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

}  // namespace steadyrest::nc::read
