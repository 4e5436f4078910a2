// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include <steadyrest/nc/read/sinumerik/sinumerik_expression.hpp>
#include <steadyrest/nc/read/sinumerik/sinumerik_line.hpp>
#include <steadyrest/nc/read/sinumerik/sinumerik_names.hpp>
#include <steadyrest/nc/read/text/character.hpp>
#include <steadyrest/nc/read/text/number.hpp>

// Jumps, conditions and loops of the dialect `sinumerik` ("Job planning", "Program jumps and
// branches", "Repeating program sections", "Check structures").
namespace steadyrest::nc::read {
namespace {

struct Simple {
  std::string_view name;
  FlowKind kind;
};
constexpr std::array kSimple = {
    Simple{"ELSE", FlowKind::otherwise},    Simple{"ENDIF", FlowKind::endif},
    Simple{"ENDWHILE", FlowKind::end_loop}, Simple{"ENDFOR", FlowKind::end_loop},
    Simple{"ENDLOOP", FlowKind::end_loop},  Simple{"LOOP", FlowKind::loop}};

struct Jump {
  std::string_view name;
  Towards towards;
};
constexpr std::array kJumps = {Jump{"GOTOF", Towards::end}, Jump{"GOTOB", Towards::beginning},
                               Jump{"GOTO", Towards::either}, Jump{"GOTOC", Towards::if_there},
                               Jump{"GOTOS", Towards::start}};

constexpr std::string_view kOwnFlowBlock =
    "a jump, condition or loop needs a separate block, and its parts in their order: IF R1>5 GOTOF "
    "LABEL; FOR R1=1 TO 5; CASE R1 OF 1 GOTOF A DEFAULT GOTOF B; REPEAT LABEL P=3";

bool nearly_equal(double a, double b) noexcept {
  constexpr double kRelative = 1e-12;  // as in comparisons: SinumerikExpression
  return std::abs(a - b) <= kRelative * std::max(std::abs(a), std::abs(b));
}

}  // namespace

bool SinumerikLine::end_of_statement(const char* word_begin) {
  if (next() == '\0') {
    return true;
  }
  at_ = end_;
  return refuse(since(word_begin), "flow_control", kOwnFlowBlock);
}

bool SinumerikLine::flow_statement(const char* word_begin, std::string_view name) {
  Flow& flow = block_.flow();
  if (!block_.words().empty() || assigned_ || flow.kind != FlowKind::none) {
    at_ = end_;
    return refuse(since(word_begin), "flow_control", kOwnFlowBlock);
  }
  flow.label.clear();
  flow.second.clear();
  flow.count = 0;
  flow.unknown = 0;
  flow.repeats = 1.0;
  flow.holds = true;
  flow.towards = Towards::either;
  const auto* const simple =
      std::ranges::find_if(kSimple, [&](const Simple& one) { return equal(name, one.name); });
  if (simple != kSimple.end()) {
    flow.kind = simple->kind;
    return end_of_statement(word_begin);
  }
  if (equal(name, "IF")) {
    return jumps_if(word_begin);
  }
  if (equal(name, "CASE")) {
    return branch(word_begin);
  }
  if (equal(name, "FOR")) {
    return count_loop(word_begin);
  }
  if (equal(name, "WHILE") || equal(name, "UNTIL")) {
    flow.kind = equal(name, "WHILE") ? FlowKind::loop_while : FlowKind::until;
    return condition(word_begin) && end_of_statement(word_begin);
  }
  if (equal(name, "REPEAT") && next() == '\0') {
    flow.kind = FlowKind::loop_until;
    return true;
  }
  if (equal(name, "REPEAT") || equal(name, "REPEATB")) {
    return section(word_begin, equal(name, "REPEATB"));
  }
  return jump(word_begin, name) && end_of_statement(word_begin);
}

// True is anything but 0.
bool SinumerikLine::condition(const char* word_begin) {
  double value = 0.0;
  if (!calculated(word_begin, value)) {
    return false;
  }
  block_.flow().holds = value != 0.0;
  block_.flow().unknown |= reading_.values->take_unknown() ? 1U : 0U;
  return true;
}

// IF …, or IF … GOTOF A, perhaps followed by further ones: the first that holds is taken.
bool SinumerikLine::jumps_if(const char* word_begin) {
  Flow& flow = block_.flow();
  for (int count = 0;; ++count) {
    // Which of several jumps is taken depends on the conditions before it, too.
    flow.unknown |= count > 0 && flow.unknown != 0 ? Flow::kUnknownLabel : 0U;
    if (!condition(word_begin)) {
      return false;
    }
    if (next() == '\0' && count == 0) {
      flow.kind = FlowKind::when;
      return true;
    }
    if (!jump(word_begin, letters())) {
      return false;
    }
    if (flow.holds && next() != '\0') {
      flow.unknown |= flow.unknown != 0 ? Flow::kUnknownLabel : 0U;
      at_ = end_;  // the control does not look at the rest either
    }
    if (next() == '\0') {
      return true;
    }
    if (!equal(letters(), "IF")) {
      at_ = end_;
      return refuse(since(word_begin), "flow_control", kOwnFlowBlock);
    }
  }
}

// GOTOF and the like, whose name has been read, with its target.
bool SinumerikLine::jump(const char* word_begin, std::string_view word) {
  const auto* const found =
      std::ranges::find_if(kJumps, [&](const Jump& one) { return equal(word, one.name); });
  if (found == kJumps.end()) {
    at_ = end_;
    return refuse(since(word_begin), "flow_control", kOwnFlowBlock);
  }
  Flow& flow = block_.flow();
  flow.kind = FlowKind::jump;
  flow.towards = found->towards;
  return flow.towards == Towards::start || label_of(word_begin, flow.label);
}

// A label, N100, :100, "LABEL", a STRING variable, or "L"<<R1.
bool SinumerikLine::label_of(const char* word_begin, Name& label) {
  std::string target;
  const char first = next();
  const char* const from = at_;
  if (first == '"' || first == '<') {
    if (!text_value(word_begin, target)) {
      return false;
    }
  } else {
    at_ += first == ':' ? 1 : 0;
    const std::string_view digits = letters();
    target = since(from);
    Name name;
    const std::string* const text =
        lower_name(digits, name) ? reading_.typed_values->text(name.view()) : nullptr;
    target = text != nullptr ? *text : target;
  }
  label.clear();
  const bool fits = std::ranges::all_of(target, [&](char c) { return label.push(c); });
  const bool plain = !target.empty() && (target.front() == ':' || in_name(target.front())) &&
                     std::all_of(target.begin() + 1, target.end(), in_name);
  return (fits && plain) || refuse(since(word_begin), "no_jump_target",
                                   "a jump without a label, or a block number such as N100");
}

// CASE R1 OF 1 GOTOF A 2 GOTOF B DEFAULT GOTOF C
bool SinumerikLine::branch(const char* word_begin) {
  Flow& flow = block_.flow();
  double value = 0.0;
  if (!calculated(word_begin, value)) {
    return false;
  }
  flow.unknown = reading_.values->take_unknown() ? Flow::kUnknownLabel | 1U : 0U;
  if (!equal(letters(), "OF")) {
    at_ = end_;
    return refuse(since(word_begin), "flow_control", kOwnFlowBlock);
  }
  if (value != std::round(value)) {
    return refuse(since(word_begin), "not_an_integer", "CASE of a number that is not whole");
  }
  flow.kind = FlowKind::jump;
  bool decided = false;
  Flow chosen = flow;
  chosen.holds = false;
  while (next() != '\0') {
    const char* const from = at_;
    bool matches = equal(letters(), "DEFAULT");
    if (!matches) {
      at_ = from;
      double constant = 0.0;
      if (!calculated(word_begin, constant)) {
        return false;
      }
      matches = constant == value;
    }
    if (!jump(word_begin, letters())) {
      return false;
    }
    if (matches && !decided) {
      chosen = flow;
      decided = true;
    }
  }
  flow = chosen;
  return true;
}

// FOR R1=1 TO 5, FOR NAME=… TO …: adds 1 with each turn. The variable is set here, so that the
// condition and what the loop reads cannot differ.
bool SinumerikLine::count_loop(const char* word_begin) {
  Flow& flow = block_.flow();
  flow.kind = FlowKind::loop_count;
  const std::string_view written = letters();
  const bool numbered = written.size() > 1 && upper(written[0]) == 'R' &&
                        std::all_of(written.begin() + 1, written.end(), is_digit);
  const int number = numbered ? static_cast<int>(read_number(written.substr(1)).value) : 0;
  double begin = 0.0;
  double end = 0.0;
  if (!lower_name(written, flow.label) || next() != '=') {
    at_ = end_;
    return refuse(since(word_begin), "flow_control", kOwnFlowBlock);
  }
  ++at_;
  if (!calculated(word_begin, begin)) {
    return false;
  }
  if (!equal(letters(), "TO")) {
    at_ = end_;
    return refuse(since(word_begin), "flow_control", kOwnFlowBlock);
  }
  if (!calculated(word_begin, end) || !end_of_statement(word_begin)) {
    return false;
  }
  const auto refuse_lookup = [&](Lookup lookup) {
    const LookupText why = sinumerik_lookup_text(lookup);
    return lookup == Lookup::found || refuse(since(word_begin), why.reason, why.text);
  };
  if (std::exchange(reading_.counts_on, false)) {
    if (!refuse_lookup(numbered ? reading_.values->number(number, begin)
                                : reading_.values->name(flow.label.view(), begin))) {
      return false;
    }
    begin += 1.0;
  }
  if (begin != std::round(begin)) {
    return refuse(since(word_begin), "not_an_integer", "FOR counts in whole numbers");
  }
  flow.values[0] = begin;
  flow.values[1] = end;
  flow.count = 2;
  flow.holds = begin < end || nearly_equal(begin, end);
  const bool unknown = reading_.values->take_unknown();
  flow.unknown = unknown ? 1U : 0U;
  const Lookup set = numbered ? reading_.values->set_number(number, begin)
                              : reading_.values->set_name(flow.label.view(), begin);
  return refuse_lookup(set);
}

// REPEATB LABEL P=n, REPEAT LABEL P=n, REPEAT A B P=n, REPEAT A ENDLABEL P=n
bool SinumerikLine::section(const char* word_begin, bool one_block) {
  Flow& flow = block_.flow();
  flow.kind = FlowKind::section;
  flow.towards = one_block ? Towards::anywhere : Towards::either;
  if (!label_of(word_begin, flow.label)) {
    return false;
  }
  for (int part = one_block ? 1 : 0; part < 2 && next() != '\0'; ++part) {
    const char* const from = at_;
    const std::string_view word = letters();
    if (upper(word.empty() ? ' ' : word[0]) == 'P' &&
        (word.size() == 1 ? next() == '=' : std::all_of(word.begin() + 1, word.end(), is_digit))) {
      at_ = from + 1;
      at_ += next() == '=' ? 1 : 0;
      if (!calculated(word_begin, flow.repeats)) {
        return false;
      }
      flow.unknown |= reading_.values->take_unknown() ? 1U : 0U;
      break;
    }
    at_ = from;
    if (part == 1 || !label_of(word_begin, flow.second)) {
      at_ = end_;
      return refuse(since(word_begin), "flow_control", kOwnFlowBlock);
    }
  }
  if (!(flow.repeats >= 0.0 && flow.repeats <= 9999.0) ||
      flow.repeats != std::floor(flow.repeats)) {
    return refuse(since(word_begin), "out_of_range",
                  "repeats (P) are a whole number from 0 to 9999");
  }
  return end_of_statement(word_begin);
}

}  // namespace steadyrest::nc::read
