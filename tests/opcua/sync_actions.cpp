// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cctype>
#include <cmath>
#include <set>
#include <sstream>
#include <stdexcept>
#include <utility>

#include <tests/opcua/sync_actions.hpp>

namespace steadyrest::opcua {

/// Recursive descent over one line.
class Parser {
 public:
  using Value = SyncActions::Value;
  using Act = SyncActions::Act;

  explicit Parser(std::string line) : line_(std::move(line)) {}

  /// R1=5 R2=$R… of the program itself, where R parameters have no $.
  std::vector<Act> assignments(bool in_action) {
    std::vector<Act> out;
    for (skip(); at_ < line_.size(); skip()) {
      out.push_back(assignment(in_action));
    }
    return out;
  }

  SyncActions::Action action() {
    SyncActions::Action out;
    need("IDS=");
    out.number = static_cast<int>(number());
    if (out.number < 1 || out.number > 255) {
      fail("IDS is 1 to 255");
    }
    if (take("WHENEVER")) {
      out.condition = any_of();
    }
    need("DO");
    out.acts = assignments(true);
    if (out.acts.empty() || out.acts.size() > 16) {
      fail("1 to 16 actions after DO");
    }
    return out;
  }

 private:
  [[noreturn]] void fail(const std::string& why) const {
    throw std::runtime_error(why + " at " + std::to_string(at_) + " of: " + line_);
  }
  void skip() {
    while (at_ < line_.size() && line_[at_] == ' ') {
      ++at_;
    }
  }
  bool take(const std::string& word) {
    skip();
    if (line_.compare(at_, word.size(), word) != 0) {
      return false;
    }
    at_ += word.size();
    return true;
  }
  void need(const std::string& word) {
    if (!take(word)) {
      fail("needs " + word);
    }
  }
  double number() {
    skip();
    std::size_t used = 0;
    try {
      const double value = std::stod(line_.substr(at_), &used);
      at_ += used;
      return value;
    } catch (const std::exception&) {
      fail("needs a number");
    }
  }
  std::string name() {
    const std::size_t from = at_;
    while (at_ < line_.size() && (std::isalnum(static_cast<unsigned char>(line_[at_])) != 0 ||
                                  line_[at_] == '_' || line_[at_] == '$')) {
      ++at_;
    }
    std::string out = line_.substr(from, at_ - from);
    if (take("[")) {
      const std::size_t close = line_.find(']', at_);
      if (close == std::string::npos) {
        fail("needs ]");
      }
      out += "[" + line_.substr(at_, close - at_) + "]";
      at_ = close + 1;
    }
    return out;
  }
  /// The number of an R parameter, or −1.
  static int r_of(const std::string& name) {
    return name.starts_with("$R[") ? std::stoi(name.substr(3)) : -1;
  }

  Act assignment(bool in_action) {
    skip();
    if (!in_action) {
      need("R");
      const int target = static_cast<int>(number());
      need("=");
      if (take("R")) {
        const int source = static_cast<int>(number());
        return [=](Variables& of) { of.r(target) = of.r(source); };
      }
      const double value = number();
      return [=](Variables& of) { of.r(target) = value; };
    }
    if (line_[at_] != '$') {
      fail("needs a variable");
    }
    const std::string target = name();
    need("=");
    const Value value = sum();
    if (const int r = r_of(target); r >= 0) {
      return [=](Variables& of) { of.r(r) = value(of); };
    }
    return [=](Variables& of) { of.write(target, value(of)); };
  }

  Value any_of() {
    Value left = all_of();
    while (take("OR")) {
      left = joined(left, all_of(), [](bool a, bool b) { return a || b; });
    }
    return left;
  }

  Value all_of() {
    Value left = comparison();
    while (take("AND")) {
      left = joined(left, comparison(), [](bool a, bool b) { return a && b; });
    }
    return left;
  }

  /// Both sides are looked at, as a control does.
  static Value joined(const Value& left, const Value& right, bool (*by)(bool, bool)) {
    return [=](Variables& of) {
      const double a = left(of);
      const double b = right(of);
      return by(a != 0.0, b != 0.0) ? 1.0 : 0.0;
    };
  }

  Value comparison() {
    const Value left = sum();
    for (const char* const sign : {"<>", "<=", ">=", "==", "<", ">"}) {
      if (take(sign)) {
        const Value right = sum();
        const std::string which = sign;
        return [=](Variables& of) {
          const double a = left(of);
          const double b = right(of);
          const bool is = which == "<>"   ? a != b
                          : which == "<=" ? a <= b
                          : which == ">=" ? a >= b
                          : which == "==" ? a == b
                          : which == "<"  ? a < b
                                          : a > b;
          return is ? 1.0 : 0.0;
        };
      }
    }
    return left;
  }

  Value sum() {
    Value left = product();
    for (;;) {
      const bool plus = take("+");
      if (!plus && !take("-")) {
        return left;
      }
      const Value right = product();
      left = [=](Variables& of) { return left(of) + (plus ? right(of) : -right(of)); };
    }
  }

  Value product() {
    Value left = single();
    for (;;) {
      const bool times = take("*");
      if (!times && !take("/")) {
        return left;
      }
      const Value right = single();
      left = [=](Variables& of) {
        const double by = right(of);
        if (!times && by == 0.0) {
          throw std::runtime_error("division by zero");
        }
        return times ? left(of) * by : left(of) / by;
      };
    }
  }

  Value single() {
    if (take("(")) {
      const Value inside = any_of();
      need(")");
      return inside;
    }
    skip();
    if (at_ < line_.size() && line_[at_] == '$') {
      const std::string variable = name();
      if (const int r = r_of(variable); r >= 0) {
        return [=](Variables& of) { return of.r(r); };
      }
      return [=](Variables& of) { return of.read(variable); };
    }
    const double value = number();
    return [=](Variables& /*of*/) { return value; };
  }

  std::string line_;
  std::size_t at_ = 0;
};

SyncActions::SyncActions(const std::string& text) {
  std::istringstream lines(text);
  std::set<int> numbers;
  for (std::string line; std::getline(lines, line);) {
    // A control reads 512 characters of a block.
    if (line.size() > 500) {
      throw std::runtime_error("a block is too long: " + line);
    }
    line = line.substr(0, line.find(';'));
    while (!line.empty() && line.back() == ' ') {
      line.pop_back();
    }
    if (line.empty() || line == "STOPRE" || line == "RET" || line.starts_with("PROC ")) {
      continue;
    }
    Parser parser(line);
    if (line.starts_with("IDS=")) {
      actions_.push_back(parser.action());
      if (!numbers.insert(actions_.back().number).second) {
        throw std::runtime_error("a number is used twice: " + line);
      }
    } else {
      for (Act& act : parser.assignments(false)) {
        start_.push_back(std::move(act));
      }
    }
  }
  std::ranges::stable_sort(actions_, {}, &Action::number);
}

void SyncActions::start(Variables& of) const {
  for (const Act& act : start_) {
    act(of);
  }
}

void SyncActions::cycle(Variables& of) const {
  for (const Action& action : actions_) {
    if (!action.condition || action.condition(of) != 0.0) {
      for (const Act& act : action.acts) {
        act(of);
      }
    }
  }
}

}  // namespace steadyrest::opcua
