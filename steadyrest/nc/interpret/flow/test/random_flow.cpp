// SPDX-License-Identifier: Apache-2.0
#include <array>

#include <fmt/core.h>

#include <steadyrest/nc/interpret/flow/test/random_flow.hpp>

namespace steadyrest::nc::interpret::test {
namespace {

constexpr int kQuestions = 3;
constexpr std::array kOfFanuc = {"EQ", "NE", "GT", "GE", "LT", "LE"};
constexpr std::array kOfSinumerik = {"==", "<>", ">", ">=", "<", "<="};

bool compare(int how, double a, double b) {
  switch (how) {
    case 0:
      return a == b;
    case 1:
      return a != b;
    case 2:
      return a > b;
    case 3:
      return a >= b;
    case 4:
      return a < b;
    default:
      return a <= b;
  }
}

}  // namespace

RandomFlow::RandomFlow(read::Dialect dialect, unsigned seed, bool asks)
    : dialect_(dialect), random_(seed), asks_(asks) {
  line(fanuc() ? "G21 G90 G17 G94 G54 G0 X0 Y0 Z0" : "G71 G90 G17 G94 G54 G0 X0 Y0 Z0");
  for (int i = 0; i < kFlowVariables; ++i) {
    set(i, below(5));
  }
  block(0, 7);
  move();
  line("M30");
}

bool RandomFlow::run(unsigned answers, std::vector<Done>& moves, std::size_t most) const {
  std::map<int, double> values;
  struct Repeat {
    std::size_t begin;
    std::size_t end;
    std::size_t back;
    int left;
  };
  std::vector<Repeat> repeats;
  std::size_t steps = 0;
  for (std::size_t at = 0;;) {
    while (!repeats.empty() && at == repeats.back().end) {
      if (repeats.back().left-- > 0) {
        at = repeats.back().begin;
        break;
      }
      at = repeats.back().back;
      repeats.pop_back();
    }
    if (at == ops_.size()) {
      return true;
    }
    if (++steps > most) {
      return false;
    }
    const Op& now = ops_[at++];
    double& a = values[now.a];
    switch (now.kind) {
      case Op::Kind::set:
        a = now.c;
        break;
      case Op::Kind::add:
        a += now.c;
        break;
      case Op::Kind::multiply:
        a *= now.c;
        break;
      case Op::Kind::copy:
        a = values[now.b];
        break;
      case Op::Kind::move:
        moves.push_back({.line = now.line, .x = a + now.c});
        break;
      case Op::Kind::jump_if: {
        const bool holds =
            now.ask >= 0 ? (answers >> now.ask & 1U) == 1U : compare(now.how, a, now.c);
        // b is 1 where the jump is made unless the condition holds.
        at = holds != (now.b == 1) ? places_.at(now.label) : at;
        break;
      }
      case Op::Kind::jump:
        at = places_.at(now.label);
        break;
      case Op::Kind::section:
        repeats.push_back(
            {places_.at(now.label), places_.at(now.b), at, static_cast<int>(now.c) - 1});
        at = places_.at(now.label);
        break;
    }
  }
}

std::string RandomFlow::variable(int n) const {
  return fmt::format("{}{}", fanuc() ? "#" : "R", n + (fanuc() ? 101 : 1));
}
// Every third label of sinumerik is a block number.
std::string RandomFlow::label(int n) const {
  return fanuc()      ? fmt::format("{}", n)
         : n % 3 == 0 ? fmt::format("N{}", n * 10)
                      : fmt::format("LB{}", n);
}
std::string RandomFlow::heading(int n) const {
  return fanuc() ? fmt::format("N{} ", n) : n % 3 == 0 ? label(n) + " " : label(n) + ": ";
}
std::string RandomFlow::written(const Condition& condition) const {
  // fanuc: the machine position, which the control alone knows; taken as 0 here.
  const std::string a = condition.ask < 0 ? variable(condition.a)
                        : fanuc()         ? "#5023"
                                          : fmt::format("$A_IN[{}]", condition.ask + 1);
  const auto how = static_cast<std::size_t>(condition.ask < 0 ? condition.how : 0);
  const double c = condition.ask < 0 ? condition.c : condition.ask + 1.0;
  return fanuc() ? fmt::format("[{} {} {}]", a, kOfFanuc.at(how), c)
                 : fmt::format("{}{}{}", a, kOfSinumerik.at(how), condition.ask < 0 ? c : 1.0);
}

void RandomFlow::line(const std::string& text) {
  text_ += text + "\n";
  ++lines_;
}
void RandomFlow::op(Op what) {
  what.line = lines_;
  ops_.push_back(what);
}
void RandomFlow::set(int n, double value) {
  line(fmt::format("{}={}", variable(n), value));
  op({.kind = Op::Kind::set, .a = n, .c = value});
}
void RandomFlow::add(int n, double value) {
  line(fmt::format("{}={}{:+}", variable(n), variable(n), value));
  op({.kind = Op::Kind::add, .a = n, .c = value});
}
RandomFlow::Condition RandomFlow::condition() {
  Condition out{.a = below(kFlowVariables), .how = below(6), .c = below(9) - 2.0};
  if (asks_ && below(3) == 0) {
    out.ask = below(kQuestions);
  }
  return out;
}
void RandomFlow::jump_unless(const Condition& c, int to) {
  op({.kind = Op::Kind::jump_if,
      .a = c.a,
      .b = 1,
      .c = c.c,
      .how = c.how,
      .label = to,
      .ask = c.ask});
}
void RandomFlow::jump_if(const Condition& c, int to) {
  op({.kind = Op::Kind::jump_if,
      .a = c.a,
      .b = 0,
      .c = c.c,
      .how = c.how,
      .label = to,
      .ask = c.ask});
}

}  // namespace steadyrest::nc::interpret::test
