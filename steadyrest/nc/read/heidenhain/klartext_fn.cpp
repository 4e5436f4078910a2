// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include <steadyrest/nc/read/heidenhain/klartext_expression.hpp>
#include <steadyrest/nc/read/heidenhain/klartext_line.hpp>
#include <steadyrest/nc/read/heidenhain/klartext_value.hpp>
#include <steadyrest/nc/read/text/character.hpp>

// Q parameters: formulas and the functions FN.
namespace steadyrest::nc::read {
namespace {

struct RefusedFn {
  int number;
  std::string_view reason;
  std::string_view text;
};

constexpr std::array kRefusedFn = {
    RefusedFn{14, "abort", "FN 14 ends the program with an error"},
    RefusedFn{18, "system_value", "a value that only the running control knows (FN 18: SYSREAD)"},
    RefusedFn{17, "system_value", "FN 17: SYSWRITE changes data of the control"},
    RefusedFn{19, "machine_value", "FN 19: PLC gives values to the machine's own program"},
    RefusedFn{26, "table", "tables (FN 26 to FN 28) are not interpreted"},
    RefusedFn{27, "table", "tables (FN 26 to FN 28) are not interpreted"},
    RefusedFn{28, "table", "tables (FN 26 to FN 28) are not interpreted"},
    RefusedFn{29, "machine_value", "FN 29: PLC gives values to the machine's own program"},
    RefusedFn{37, "machine_value", "FN 37: EXPORT is not interpreted"},
    RefusedFn{38, "message", "FN 38: SEND is not interpreted"},
};

constexpr double kFnDegree = std::numbers::pi / 180.0;

/// FN 13: the angle of a right triangle's sides, 0 to 360 degrees.
double angle_of_sides(double a, double b) {
  const double found = std::atan2(a, b) / kFnDegree;
  return found < 0.0 ? found + 360.0 : found;
}

/// How FN 0 to FN 8 and FN 13 are written and what they do with their one or two operands.
struct FnForm {
  std::string_view before;
  std::string_view between;
  double (*of)(double a, double b);
};
constexpr FnForm kNoForm = {"", "", [](double a, double) { return a; }};
constexpr std::array<FnForm, 14> kFnForms = {{
    kNoForm,
    {"", "+", [](double a, double b) { return a + b; }},
    {"", "-", [](double a, double b) { return a - b; }},
    {"", "*", [](double a, double b) { return a * b; }},
    {"", "DIV", [](double a, double b) { return a / b; }},
    {"SQRT", "", [](double a, double) { return std::sqrt(a); }},
    {"SIN", "", [](double a, double) { return std::sin(a * kFnDegree); }},
    {"COS", "", [](double a, double) { return std::cos(a * kFnDegree); }},
    {"", "LEN", [](double a, double b) { return std::hypot(a, b); }},
    kNoForm,
    kNoForm,
    kNoForm,
    kNoForm,
    {"", "ANG", angle_of_sides},
}};

/// Two numbers that differ, but by no more than calculating may have added.
bool nearly_equal(double a, double b) noexcept {
  constexpr double kLost = 1e-9;
  return a != b && std::abs(a - b) <= kLost * std::max({1.0, std::abs(a), std::abs(b)});
}

}  // namespace

bool KlartextLine::assign(const char* word_begin, int index, double value) {
  const Lookup lookup = reading_.values->set_number(index, value);
  const LookupText why = klartext_lookup_text(lookup);
  return lookup == Lookup::found || refuse(since(word_begin), why.reason, why.text);
}

// Q5 = SIN 30 * Q2
bool KlartextLine::assignment(const char* word_begin) {
  at_ = word_begin;
  const QName name = read_q_name(rest());
  at_ += name.length;
  if (name.length == 0 || !take("=")) {
    at_ = end_;
    return refuse(since(word_begin), "unknown_word",
                  "a Q parameter begins a block only where a value is assigned to it");
  }
  if (reading_.values == nullptr) {
    return refuse(since(word_begin), "parameter", "a Q parameter; only plain numbers are allowed");
  }
  KlartextExpression expression(line(), offset(), *reading_.values);
  double result = 0.0;
  const bool read = expression.read(result);
  return behind(word_begin, expression, read) && assign(word_begin, name.index, result);
}

bool KlartextLine::fn(const char* word_begin) {
  skip_blanks();
  int number = -1;
  for (; at_ != end_ && is_digit(*at_) && number < 100; ++at_) {
    number = std::max(number, 0) * 10 + (*at_ - '0');
  }
  static_cast<void>(take(":"));
  if (number == 15 || number == 16 ||
      (number == 20 && rest().find("SYNC") != std::string_view::npos)) {
    at_ = end_;  // prints, or waits for the moves before it
    return true;
  }
  const auto* const refused = std::ranges::find(kRefusedFn, number, &RefusedFn::number);
  if (refused != kRefusedFn.end()) {
    at_ = end_;
    return refuse(since(word_begin), refused->reason, refused->text);
  }
  if (reading_.values == nullptr) {
    return refuse(since(word_begin), "parameter", "a Q parameter; only plain numbers are allowed");
  }
  if (number >= 9 && number <= 12) {
    return jump(word_begin, number);
  }
  if (number < 0 || number > 13) {
    return refuse(since(word_begin), "unknown_function", "an FN function that is not known");
  }
  return calculate(word_begin, number);
}

// FN 0 to FN 8 and FN 13: one or two operands, with the operator of the function's number.
bool KlartextLine::calculate(const char* word_begin, int number) {
  skip_blanks();
  const QName name = read_q_name(rest());
  at_ += name.length;
  if (name.length == 0 || !take("=")) {
    at_ = end_;
    return refuse(since(word_begin), "missing_value",
                  "FN without the Q parameter that takes the result");
  }
  const FnForm& form = kFnForms[static_cast<std::size_t>(number)];
  double a = 0.0;
  double b = 0.0;
  if (!form.before.empty() && !take(form.before)) {
    return refuse(since(word_begin), "missing_value", "FN without its operator");
  }
  if (!operand(word_begin, a)) {
    return false;
  }
  if (!form.between.empty()) {
    if (!take(form.between) && !(number == 4 && take("/"))) {
      return refuse(since(word_begin), "missing_value", "FN without its operator");
    }
    if (!operand(word_begin, b)) {
      return false;
    }
  }
  const double result = form.of(a, b);
  return std::isfinite(result)
             ? assign(word_begin, name.index, result)
             : refuse(since(word_begin), "not_finite", "a calculation without a finite result");
}

// FN 9: IF +Q1 EQU +Q2 GOTO LBL 5
bool KlartextLine::jump(const char* word_begin, int number) {
  static constexpr std::array<std::string_view, 4> kNames = {"EQU", "NE", "GT", "LT"};
  double a = 0.0;
  double b = 0.0;
  const auto malformed = [&] {
    return refuse(since(word_begin), "jump",
                  "a jump is written FN 9: IF +Q1 EQU +Q2 GOTO LBL 5 (FN 10 NE, 11 GT, 12 LT)");
  };
  if (!take("IF")) {
    return malformed();
  }
  if (!operand(word_begin, a)) {
    return false;
  }
  if (!take(kNames[static_cast<std::size_t>(number - 9)])) {
    return malformed();
  }
  if (!operand(word_begin, b)) {
    return false;
  }
  if (!take("GOTO") || !take("LBL")) {
    return malformed();
  }
  if (!label_name(word_begin)) {
    return false;
  }
  if (nearly_equal(a, b)) {
    return refuse(
        since(word_begin), "comparison_too_close",
        "the two values differ by less than calculating adds; how the control rounds them "
        "decides this jump");
  }
  Flow& flow = block_.flow();
  flow.kind = FlowKind::jump_mark;
  flow.count = 1;
  flow.unknown = 0;
  const bool goes = number == 9 ? a == b : number == 10 ? a != b : number == 11 ? a > b : a < b;
  flow.values[0] = goes ? 1.0 : 0.0;
  return true;
}

}  // namespace steadyrest::nc::read
