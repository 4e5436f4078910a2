// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <cstddef>

#include <steadyrest/kernel/units/constants.hpp>
#include <steadyrest/nc/read/letter/expression.hpp>
#include <steadyrest/nc/read/text/character.hpp>
#include <steadyrest/nc/read/text/name.hpp>

// The functions of expressions: SIN[…], ATAN[y]/[x], EXISTS[#<name>] …
namespace steadyrest::nc::read {
namespace {

using kernel::units::kDegree;

}  // namespace

// The name up to its bracket. EXISTS and ATAN have special forms; all others take one value.
bool Expression::function(double& out) {
  std::array<char, 8> name{};
  std::size_t length = 0;
  const char* const first = at_;
  // No function's name is longer: more letters are an unknown one.
  for (char c = peek(); is_letter(c) && length < name.size(); c = peek()) {
    name[length++] = c;
    ++at_;
  }
  const std::string_view text{name.data(), length};
  // Letters without a bracket are not a function: report a missing value.
  if (peek() != '[') {
    at_ = first;
    return fail("missing_value", "a value is missing: a number, a parameter or [ ] belongs here");
  }
  return text == "EXISTS" ? exists(out)
         : text == "ATAN" ? arc_tangent(out)
                          : named_function(text, out);
}

// Functions of one value; angles in degrees, as everywhere in NC programs.
bool Expression::named_function(std::string_view name, double& out) {
  double x = 0.0;
  if (!bracket(x)) {
    return false;
  }
  // Outside these domains C++ returns NaN; the refusal names the function instead.
  const auto domain = [&](bool inside, std::string_view text) {
    return inside || fail("out_of_domain", text);
  };
  if (name == "ABS") {
    out = std::abs(x);
  } else if (name == "ACOS" || name == "ASIN") {
    if (!domain(x >= -1.0 && x <= 1.0, "ASIN or ACOS of a number outside -1 to 1")) {
      return false;
    }
    out = (name == "ACOS" ? std::acos(x) : std::asin(x)) / kDegree;
  } else if (name == "COS") {
    out = std::cos(x * kDegree);
  } else if (name == "EXP") {
    out = std::exp(x);
  } else if (name == "FIX") {
    // LinuxCNC's FIX and FUP round down and up, also below zero; FANUC's work on the magnitude
    // (macro_expression.cpp).
    out = std::floor(x);
  } else if (name == "FUP") {
    out = std::ceil(x);
  } else if (name == "LN") {
    if (!domain(x > 0.0, "LN of a number that is not above zero")) {
      return false;
    }
    out = std::log(x);
  } else if (name == "ROUND") {
    // Halves away from zero, as in LinuxCNC.
    out = std::round(x);
  } else if (name == "SIN") {
    out = std::sin(x * kDegree);
  } else if (name == "SQRT") {
    if (!domain(x >= 0.0, "SQRT of a negative number")) {
      return false;
    }
    out = std::sqrt(x);
  } else if (name == "TAN") {
    out = std::tan(x * kDegree);
  } else {
    return fail("unknown_function",
                "an unknown function; the known ones are ABS ACOS ASIN ATAN COS EXISTS EXP FIX FUP "
                "LN ROUND SIN SQRT TAN");
  }
  return finite(out);
}

bool Expression::arc_tangent(double& out) {
  double y = 0.0;
  double x = 0.0;
  if (!bracket(y)) {
    return false;
  }
  // ATAN needs both values to tell the quadrants apart; there is no form with one.
  if (peek() != '/') {
    return fail("bad_function", "ATAN takes two values: ATAN[y]/[x]");
  }
  ++at_;
  if (peek() != '[') {
    return fail("bad_function", "ATAN takes two values: ATAN[y]/[x]");
  }
  if (!bracket(x)) {
    return false;
  }
  // −180° to 180°.
  out = std::atan2(y, x) / kDegree;
  return finite(out);
}

bool Expression::exists(double& out) {
  constexpr std::string_view kText = "EXISTS takes a parameter: EXISTS[#<name>]";
  ++at_;
  // EXISTS asks without using the value, so an unset parameter is no fault here.
  if (peek() != '#') {
    return fail("bad_function", kText);
  }
  ++at_;
  double ignored = 0.0;
  Lookup lookup = Lookup::found;
  if (peek() == '<') {
    Name name;
    if (!parameter_name(name)) {
      return false;
    }
    // values_ notes the lookup all the same: the answer depends on what the control holds.
    lookup = values_.name(name.view(), ignored);
  } else {
    int index = 0;
    if (!parameter_number(index)) {
      return false;
    }
    lookup = values_.number(index, ignored);
  }
  if (lookup == Lookup::kept_by_control) {
    return looked_up(lookup);
  }
  // A position exists while cutter radius compensation is on, but cannot be read.
  out = lookup == Lookup::found || lookup == Lookup::not_while_compensating ? 1.0 : 0.0;
  if (peek() != ']') {
    return fail("bad_function", kText);
  }
  ++at_;
  return true;
}

}  // namespace steadyrest::nc::read
