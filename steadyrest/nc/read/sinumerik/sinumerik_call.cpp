// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstddef>

#include <steadyrest/nc/read/sinumerik/sinumerik_expression.hpp>
#include <steadyrest/nc/read/sinumerik/sinumerik_line.hpp>
#include <steadyrest/nc/read/sinumerik/sinumerik_names.hpp>
#include <steadyrest/nc/read/text/character.hpp>
#include <steadyrest/nc/read/text/number.hpp>

// Variables, definitions, calls of subprograms and cycles of the dialect `sinumerik`.
namespace steadyrest::nc::read {
namespace {

constexpr std::string_view kOwnCallBlock = "a call needs a separate block";

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
  calculated_ = true;
  SinumerikExpression expression(line(), offset(), *reading_.values, reading_.typed_values);
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
  struct Statement {
    std::string_view name;
    bool (SinumerikLine::*read)(const char* word_begin);
  };
  static constexpr std::array kStatements = {Statement{"DEF", &SinumerikLine::definition},
                                             Statement{"PROC", &SinumerikLine::head_of_subprogram},
                                             Statement{"EXTERN", &SinumerikLine::declaration},
                                             Statement{"MCALL", &SinumerikLine::modal_call},
                                             Statement{"CALL", &SinumerikLine::indirect_call},
                                             Statement{"PCALL", &SinumerikLine::indirect_call},
                                             Statement{"SETAL", &SinumerikLine::alarm},
                                             Statement{"SETMS", &SinumerikLine::master_spindle}};
  const auto* const known = std::ranges::find_if(
      kStatements, [&](const Statement& one) { return equal(name, one.name); });
  if (known != kStatements.end()) {
    return done = (this->*known->read)(word_begin);
  }
  if (is_flow_word(name)) {
    return done = flow_statement(word_begin, name);
  }
  // A variable hides a subprogram of its name.
  Name variable;
  double ignored = 0.0;
  if (lower_name(name, variable) && reading_.typed_values->text(variable.view()) != nullptr) {
    return done = text_assignment(word_begin, variable.view());
  }
  // With = or [ it would be a variable that does not exist; behind other words it would be a word.
  const char after = next();
  if (after == '[' && lower_name(name, variable)) {
    const char* const bracket = at_;
    if (element_name(word_begin, variable) &&
        reading_.values->name(variable.view(), ignored) != Lookup::no_such_name) {
      return done = variable_assignment(word_begin, variable.view());
    }
    at_ = bracket;
    lower_name(name, variable);
  }
  if (reading_.values->name(variable.view(), ignored) != Lookup::no_such_name) {
    static_cast<void>(reading_.values->take_unknown());  // it is set, not used
    return done = variable_assignment(word_begin, variable.view());
  }
  if (refused_name(name) != nullptr || after == '=' || after == '[' || !block_.words().empty()) {
    done = false;  // refused as a word
    return true;
  }
  // Cycles are executed here; any other name must be a program in the folders.
  const bool cycle = name.size() > 5 && equal(name.substr(0, 5), "CYCLE");
  return done = call(word_begin, name, cycle ? FlowKind::cycle : FlowKind::call);
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

// NAME="text" << R1
bool SinumerikLine::text_assignment(const char* word_begin, std::string_view name) {
  if (next() != '=') {
    return refuse(since(word_begin), "bad_assignment", "a variable without an assignment");
  }
  ++at_;
  std::string value;
  return text_value(word_begin, value) &&
         assign(word_begin, reading_.typed_values->set_text(name, value));
}

// NAME, NAME(1,,R2), L100; the repeats (P) follow as a separate word.
bool SinumerikLine::call(const char* word_begin, std::string_view name, FlowKind kind) {
  Flow& flow = block_.flow();
  if (!block_.words().empty() || assigned_) {
    return refuse(since(word_begin), "subprogram_call", kOwnCallBlock);
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
  flow.unknown = 0;
  flow.repeats = 1.0;
  return next() != '(' || call_values(word_begin);
}

// Values between commas, each an expression; strings occur only in cycles that are not interpreted.
bool SinumerikLine::call_values(const char* word_begin) {
  Flow& flow = block_.flow();
  reading_.typed_values->begin_call();
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
    if (c == '"') {
      at_ = end_;
      return refuse(since(word_begin), "subprogram_call", "a string as a call argument");
    }
    // Nothing between two commas is an omitted value; `given` has a bit for each value present.
    if (c != ',' && c != ')') {
      const char* const from = at_;
      if (!calculated(word_begin, flow.values[flow.count])) {
        return false;
      }
      const std::uint32_t bit = std::uint32_t{1} << flow.count;
      flow.given |= bit;
      // A plain name may be a variable that the subprogram sets (VAR).
      Name name;
      if (const std::string_view text = since(from);
          std::ranges::all_of(text, in_name) && lower_name(text, name)) {
        reading_.typed_values->pass(flow.count, name.view());
      }
      flow.unknown |= reading_.values->take_unknown() ? bit : 0U;
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
    return refuse(since(word_begin), "subprogram_call", kOwnCallBlock);
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
    return refuse(since(word_begin), "modal_call", kOwnCallBlock);
  }
  const std::string_view name = letters();
  const bool cycle = name.empty() || (name.size() > 5 && equal(name.substr(0, 5), "CYCLE"));
  return call(word_begin, name, cycle ? FlowKind::modal_cycle : FlowKind::modal_call);
}

// MSG("text"<<R1) or MSG(): a message for the operator, as harmless as a comment.
bool SinumerikLine::message(const char* word_begin, Word& word) {
  skip_blanks();
  if (at_ != end_ && *at_ == '(') {
    ++at_;
    skip_blanks();
    const char* const text = at_;
    if (at_ != end_ && *at_ == '"' && !quoted(word_begin, word)) {
      return false;
    }
    skip_blanks();
    if (at_ != end_ && *at_ != ')' && reading_.typed_values != nullptr) {
      std::string shown;
      const bool quoted = *text == '"';
      at_ = text;
      if (!text_value(word_begin, shown) || !(quoted || push(word_begin, word))) {
        return false;
      }
      // MSG("text",1) also waits for the moves before it.
      if (next() == ',') {
        double ignored = 0.0;
        ++at_;
        if (!calculated(word_begin, ignored)) {
          return false;
        }
      }
    }
    skip_blanks();
    if (at_ != end_ && *at_ == ')') {
      ++at_;
      return true;
    }
  }
  at_ = end_;
  return refuse(since(word_begin), "expression", "MSG takes a string: MSG(\"text\"<<R1)");
}

// CALL "NAME", CALL variable; PCALL /_N_WKS_DIR/_N_PART_WPD/NAME(1): of a path the name counts,
// since subprograms are looked for in the folders that were given.
bool SinumerikLine::indirect_call(const char* word_begin) {
  const bool by_path = equal({word_begin, 5}, "PCALL");
  std::string name;
  skip_blanks();
  if (by_path) {
    const char* const from = at_;
    while (at_ != end_ && (in_name(*at_) || *at_ == '/')) {
      ++at_;
    }
    name = since(from);
  } else if (!text_value(word_begin, name)) {
    return false;
  }
  const auto slash = name.rfind('/');
  name.erase(0, slash == std::string::npos ? 0 : slash + 1);
  name.erase(0, name.starts_with("_N_") ? 3 : 0);
  if (name.ends_with("_SPF") || name.ends_with("_MPF")) {
    name.resize(name.size() - 4);
  }
  if (name.size() < 2 || !std::ranges::all_of(name, in_name)) {
    return refuse(since(word_begin), "subprogram_call",
                  "CALL or PCALL without the name of a subprogram");
  }
  return call(word_begin, name, FlowKind::call);
}

// SETAL(65000, "text"): an alarm, which stops the program only where its number says so: from 65500
// on the block is waited for, from 66000 on the program ends ("Job planning", SETAL).
bool SinumerikLine::alarm(const char* word_begin) {
  double number = 0.0;
  std::string text;
  if (!block_.words().empty() || assigned_ || next() != '(') {
    return refuse(since(word_begin), "alarm", "write SETAL(65000) in a separate block");
  }
  ++at_;
  if (!calculated(word_begin, number)) {
    return false;
  }
  if (next() == ',') {
    ++at_;
    if (next() != ')' && !text_value(word_begin, text)) {
      return false;
    }
  }
  if (next() != ')') {
    return refuse(since(word_begin), "unclosed_expression", "SETAL( that is not closed by )");
  }
  ++at_;
  return (number >= 65000.0 && number < 65500.0) ||
         refuse(since(word_begin), "alarm",
                "the control raises an alarm here that is not a mere message; those are SETAL "
                "65000 to 65499");
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
