// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstddef>
#include <cstdint>

#include <steadyrest/nc/read/sinumerik/sinumerik_expression.hpp>
#include <steadyrest/nc/read/sinumerik/sinumerik_line.hpp>
#include <steadyrest/nc/read/sinumerik/sinumerik_names.hpp>
#include <steadyrest/nc/read/sinumerik/sinumerik_words.hpp>
#include <steadyrest/nc/read/text/character.hpp>
#include <steadyrest/nc/read/text/number.hpp>

// Variables, definitions, calls of subprograms and cycles of the dialect `sinumerik`.
namespace steadyrest::nc::read {
namespace {

constexpr std::string_view kOwnBlock = "a call or definition needs a separate block";

}  // namespace

// Only a comment follows `;`, so for statements the line ends there.
char SinumerikLine::next() noexcept {
  skip_blanks();
  return at_ == end_ || *at_ == ';' ? '\0' : upper(*at_);
}

std::string_view SinumerikLine::letters() noexcept {
  skip_blanks();
  const char* const first = at_;
  while (at_ != end_ && in_name(*at_)) {
    ++at_;
  }
  return since(first);
}

// Values behind = may be any expression; plain numbers are read without one (assigned).
bool SinumerikLine::calculated(const char* word_begin, double& out) {
  if (reading_.values == nullptr) {
    return refuse_value(word_begin);
  }
  if (next() == '\0') {
    return refuse(since(word_begin), "missing_value", "an address without its value");
  }
  SinumerikExpression expression(line(), offset(), *reading_.values);
  return behind(word_begin, expression, expression.read(out));
}

/// Reads the statement that begins with this name and sets `done`, unless the name is a word. A
/// name outside the language is a definition, a variable or a call; as on the control, the
/// definitions so far decide which.
bool SinumerikLine::statement(const char* word_begin, std::string_view name, bool& done) {
  if (reading_.typed_values == nullptr || known_name(name)) {
    return true;
  }
  done = true;
  if (equal(name, "DEF")) {
    return done = definition(word_begin);
  }
  if (equal(name, "PROC")) {
    return done = head_of_subprogram(word_begin);
  }
  if (equal(name, "EXTERN")) {
    return done = declaration(word_begin);
  }
  if (equal(name, "MCALL")) {
    return done = modal_call(word_begin);
  }
  if (equal(name, "SETMS")) {
    return done = master_spindle(word_begin);
  }
  // A variable hides a subprogram of its name.
  Name variable;
  double ignored = 0.0;
  if (lower_name(name, variable) &&
      reading_.values->name(variable.view(), ignored) != Lookup::no_such_name) {
    return done = variable_assignment(word_begin, variable.view());
  }
  // With = or [ it would be a variable that does not exist; behind other words it would be a word.
  const char after = next();
  if (refused_name(name) != nullptr || after == '=' || after == '[' || !block_.words().empty()) {
    done = false;  // refused as a word
    return true;
  }
  // Cycles are executed here; any other name must be a program in the folders.
  return done = call(word_begin, name, names_cycle(name) ? FlowKind::cycle : FlowKind::call);
}

// The types whose value is a number.
bool SinumerikLine::value_type(const char* word_begin, ValueType& type) {
  const std::string_view name = letters();
  if (equal(name, "REAL") || equal(name, "INT") || equal(name, "BOOL")) {
    type = equal(name, "REAL")  ? ValueType::real
           : equal(name, "INT") ? ValueType::integer
                                : ValueType::boolean;
    return true;
  }
  // VAR parameters would write back into the caller; strings and frames are not numbers.
  return refuse(since(word_begin), "definition",
                "a variable or parameter of an unsupported type; REAL, INT and BOOL are supported "
                "(not VAR, CHAR, STRING, AXIS, FRAME, SYN…)");
}

bool SinumerikLine::variable_name(const char* word_begin, Name& name) {
  const std::string_view written = letters();
  // The manual's rule: two leading letters or underscores tell variables from addresses such as X1.
  const bool starts = written.size() >= 2 && !is_digit(written[0]) && !is_digit(written[1]);
  if (!starts || written.size() > 31 || known_name(written) || refused_name(written) != nullptr ||
      !lower_name(written, name)) {
    return refuse(since(word_begin), "bad_name",
                  "a variable name: begin with two letters or underscores, at most 31 characters, "
                  "no word of the language");
  }
  if (next() == '[') {
    return refuse(since(word_begin), "array", "an array of variables is not interpreted");
  }
  return true;
}

// DEF REAL A, B=2.5
bool SinumerikLine::definition(const char* word_begin) {
  ValueType type{};
  if (!block_.words().empty() || assigned_) {
    return refuse(since(word_begin), "definition", kOwnBlock);
  }
  if (!value_type(word_begin, type)) {
    return false;
  }
  // Definitions act at once, one after the other: `DEF REAL A=2, B=A*2` is allowed.
  for (;;) {
    Name name;
    double value = 0.0;
    if (!variable_name(word_begin, name)) {
      return false;
    }
    if (next() == '=') {
      ++at_;
      if (!calculated(word_begin, value)) {
        return false;
      }
    }
    if (!reading_.typed_values->define(name.view(), type, value)) {
      return refuse(since(word_begin), "definition", "a variable that is already defined");
    }
    if (next() != ',') {
      return next() == '\0' || refuse(since(word_begin), "definition", kOwnBlock);
    }
    ++at_;
  }
}

bool SinumerikLine::parameter_of_subprogram(const char* word_begin, std::size_t place) {
  ValueType type{};
  Name name;
  double otherwise = 0.0;
  if (!value_type(word_begin, type)) {
    return false;
  }
  skip_blanks();
  const std::string_view written = letters();  // one letter is allowed here
  if (written.empty() || is_digit(written[0]) || !lower_name(written, name) || next() == '[') {
    return refuse(since(word_begin), "bad_name", "a parameter without a name, or an array");
  }
  if (next() == '=') {
    ++at_;
    if (!calculated(word_begin, otherwise)) {
      return false;
    }
  }
  return reading_.typed_values->define_argument(name.view(), type, place, otherwise) ||
         refuse(since(word_begin), "definition", "a parameter that is already defined");
}

// PROC NAME(REAL A, INT B=3)
// A value that the caller leaves out takes the default in PROC, or 0.
bool SinumerikLine::head_of_subprogram(const char* word_begin) {
  if (letters().empty()) {
    return refuse(since(word_begin), "definition", "PROC without the subprogram's name");
  }
  if (next() == '(') {
    ++at_;
    // Values are matched by place, not by name.
    for (std::size_t place = 0; next() != ')'; ++place) {
      if (place > 0) {
        if (next() != ',') {
          return refuse(since(word_begin), "definition", "a , or ) is missing");
        }
        ++at_;
      }
      if (!parameter_of_subprogram(word_begin, place)) {
        return false;
      }
    }
    ++at_;
  }
  while (next() != '\0') {
    const std::string_view attribute = letters();
    // Attributes affect how the control shows or protects the subprogram; these two do nothing
    // else.
    if (!equal(attribute, "DISPLOF") && !equal(attribute, "DISPLON")) {
      at_ += attribute.empty() ? 1 : 0;
      return refuse(since(word_begin), "definition",
                    "a subprogram attribute that is not interpreted (SAVE, SBLOF …)");
    }
  }
  return true;
}

// EXTERN only declares a subprogram's parameters; PROC repeats them.
bool SinumerikLine::declaration(const char* word_begin) {
  at_ = end_;
  return block_.words().empty() || refuse(since(word_begin), "definition", kOwnBlock);
}

bool SinumerikLine::assign(const char* word_begin, Lookup lookup) {
  // Whether words act before or after an assignment in the same block is not certain.
  if (!block_.words().empty()) {
    return refuse(since(word_begin), "assignment_and_words",
                  "a variable assignment next to other words; write two blocks");
  }
  assigned_ = true;
  const LookupText why = sinumerik_lookup_text(lookup);
  return lookup == Lookup::found || refuse(since(word_begin), why.reason, why.text);
}

// R1=…, R[…]=…; at_ is just behind the R.
bool SinumerikLine::parameter_assignment(const char* word_begin) {
  double index = 0.0;
  // R[R1+2]=…: the index may be calculated.
  if (next() == '[') {
    ++at_;
    if (!calculated(word_begin, index)) {
      return false;
    }
    if (next() != ']') {
      return refuse(since(word_begin), "unclosed_expression", "R[ that is not closed by ]");
    }
    ++at_;
  } else {
    const Number number = read_number(rest());
    // A parameter's number has no sign and no point.
    if (number.length == 0 || number.decimal_point || !is_digit(*at_)) {
      return refuse(since(word_begin), "missing_value", "an R-parameter without its number");
    }
    index = number.value;
    at_ += number.length;
  }
  if (next() != '=') {
    return refuse(since(word_begin), "bad_assignment",
                  "an R-parameter without an assignment; write R1=5 or X=R1");
  }
  ++at_;
  double value = 0.0;
  if (!calculated(word_begin, value)) {
    return false;
  }
  // An index that is not whole is refused, not rounded.
  const bool whole =
      index >= 0.0 && index < 1e6 && index == static_cast<double>(static_cast<int>(index));
  return assign(word_begin, whole ? reading_.values->set_number(static_cast<int>(index), value)
                                  : Lookup::no_such_number);
}

bool SinumerikLine::variable_assignment(const char* word_begin, std::string_view name) {
  if (next() != '=') {
    return refuse(since(word_begin), "bad_assignment", "a variable without an assignment");
  }
  ++at_;
  double value = 0.0;
  return calculated(word_begin, value) &&
         assign(word_begin, reading_.values->set_name(name, value));
}

// NAME, NAME(1,,R2), L100; the repeats (P) follow as a separate word.
bool SinumerikLine::call(const char* word_begin, std::string_view name, FlowKind kind) {
  Flow& flow = block_.flow();
  if (!block_.words().empty() || assigned_) {
    return refuse(since(word_begin), "subprogram_call", kOwnBlock);
  }
  // The label keeps the case, as file systems need it.
  flow.label.clear();
  for (const char c : name) {
    if (!flow.label.push(c)) {
      return refuse(since(word_begin), "bad_name", "a name that is too long");
    }
  }
  flow.kind = kind;
  flow.count = 0;
  flow.given = 0;
  flow.repeats = 1.0;
  return next() != '(' || call_values(word_begin);
}

// Values between commas, each an expression; strings occur only in cycles that are not interpreted.
bool SinumerikLine::call_values(const char* word_begin) {
  Flow& flow = block_.flow();
  ++at_;
  if (next() == ')') {
    ++at_;
    return true;
  }
  for (;;) {
    // Flow has room for as many values as LinuxCNC's O-words.
    if (flow.count == Flow::kMostArguments) {
      return refuse(since(word_begin), "subprogram_call", "more than 30 values");
    }
    const char c = next();
    // Nothing between two commas is an omitted value; `given` has a bit for each value present.
    if (c == '"') {
      if (!string_argument(word_begin)) {
        return false;
      }
    } else if (c != ',' && c != ')') {
      if (!calculated(word_begin, flow.values[flow.count])) {
        return false;
      }
      flow.given |= std::uint32_t{1} << flow.count;
    }
    ++flow.count;
    const char after = next();
    if (after != ',' && after != ')') {
      return refuse(since(word_begin), "unclosed_expression", "a call that is not closed by )");
    }
    ++at_;
    if (after == ')') {
      return true;
    }
  }
}

// After a call: P3.
bool SinumerikLine::repeats(const char* word_begin) {
  Flow& flow = block_.flow();
  // P once, after a call: anything else on the line would act in an uncertain order.
  const bool p = flow.kind == FlowKind::call && upper(*at_) == 'P' && !repeats_given_;
  ++at_;
  double value = 0.0;
  if (p) {
    at_ += next() == '=' ? 1 : 0;
    if (!calculated(word_begin, value)) {
      return false;
    }
  }
  if (!p && flow.kind == FlowKind::call && flow.count == 0 && !is_digit(flow.label.view()[1])) {
    // More likely a word that is not known than a call, so it is the one to look at.
    return refuse(flow.label.view(), "unknown_word",
                  "a word that is not known; a call of a subprogram needs a separate block");
  }
  if (!p) {
    while (at_ != end_ && !is_blank(*at_)) {
      ++at_;
    }
    return refuse(since(word_begin), "subprogram_call", kOwnBlock);
  }
  // The control's own bounds.
  if (!(value >= 1.0 && value <= 9999.0) || value != static_cast<double>(static_cast<int>(value))) {
    return refuse(since(word_begin), "out_of_range",
                  "repeats (P) are a whole number from 1 to 9999");
  }
  flow.repeats = value;
  repeats_given_ = true;
  return true;
}

// MCALL CYCLE81(…), MCALL.
bool SinumerikLine::modal_call(const char* word_begin) {
  if (!block_.words().empty() || assigned_) {
    return refuse(since(word_begin), "modal_call", kOwnBlock);
  }
  const std::string_view name = letters();
  // A modal subprogram would run after every move; only drilling cycles are supported.
  if (!name.empty() && !names_cycle(name)) {
    return refuse(since(word_begin), "modal_call",
                  "a modal call (MCALL) of a subprogram; only cycles are interpreted");
  }
  return call(word_begin, name, FlowKind::modal_cycle);
}

// SETMS, SETMS(1): one spindle is known, and it is the master.
bool SinumerikLine::master_spindle(const char* word_begin) {
  double number = 1.0;
  if (next() == '(') {
    ++at_;
    if (next() != ')' && !calculated(word_begin, number)) {
      return false;
    }
    if (next() != ')') {
      return refuse(since(word_begin), "unclosed_expression", "SETMS( that is not closed by )");
    }
    ++at_;
  }
  return number == 1.0 || refuse(since(word_begin), "spindle_selection",
                                 "a master spindle (SETMS) other than the first");
}

}  // namespace steadyrest::nc::read
