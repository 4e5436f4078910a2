// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstddef>

#include <fmt/core.h>

#include <steadyrest/nc/interpret/flow/test/random_flow.hpp>

// The statements of random programs, each with its instructions.
namespace steadyrest::nc::interpret::test {

void RandomFlow::block(int depth, int most) {
  for (int i = below(most) + 1; i > 0; --i) {
    statement(depth);
  }
}

void RandomFlow::statement(int depth) {
  constexpr int kDeepest = 3;
  const int kind = depth >= kDeepest ? below(6) : below(16);
  switch (kind) {
    case 0:
    case 1:
    case 2:
      return move();
    case 3:
    case 4:
      return assignment();
    case 5:
    case 6:
      return skip_ahead(depth);
    case 7:
      return jump_back(depth);
    case 8:
    case 9:
      return branch(depth);
    case 10:
      return while_loop(depth);
    case 11:
      return endless_loop(depth);
    case 12:
      return count_loop(depth);
    case 13:
      return until_loop(depth);
    case 14:
      return choice(depth);
    default:
      return repeated(depth);
  }
}

void RandomFlow::move() {
  const int n = below(kFlowVariables);
  const int c = below(20);
  if (below(3) == 0) {
    line(fmt::format("G0 X{}", c));
    op({.kind = Op::Kind::move, .a = -1, .c = static_cast<double>(c)});
    return;
  }
  line(fmt::format(fmt::runtime(fanuc() ? "G1 X[{}+{}] F200" : "G1 X={}+{} F200"), variable(n), c));
  op({.kind = Op::Kind::move, .a = n, .c = static_cast<double>(c)});
}

void RandomFlow::assignment() {
  const int n = below(kFlowVariables);
  switch (below(4)) {
    case 0:
      return set(n, below(9));
    case 1: {
      const int from = below(kFlowVariables);
      line(fmt::format("{}={}", variable(n), variable(from)));
      return op({.kind = Op::Kind::copy, .a = n, .b = from});
    }
    case 2: {
      const double by = below(3) - 1.0;
      line(fmt::format("{}={}*{}", variable(n), variable(n), by));
      return op({.kind = Op::Kind::multiply, .a = n, .c = by});
    }
    default:
      return add(n, below(7) - 3.0);
  }
}

// IF … GOTOF LABEL, some lines, LABEL:
void RandomFlow::skip_ahead(int depth) {
  const int to = new_label();
  const Condition c = condition();
  if (fanuc()) {
    line(fmt::format(fmt::runtime(below(2) == 0 ? "IF{}GOTO{}" : "IF {} GOTO {}"), written(c),
                     label(to)));
  } else {
    line(fmt::format("IF {} {} {}", written(c), below(3) == 0 ? "GOTO" : "GOTOF", label(to)));
  }
  jump_if(c, to);
  block(depth + 1, 2);
  if (below(4) == 0) {  // the other branch of an if … else in jumps
    const int end = new_label();
    line(fmt::format(fmt::runtime(fanuc() ? "GOTO {}" : "GOTOF {}"), label(end)));
    op({.kind = Op::Kind::jump, .label = end});
    place(to);
    line(heading(to));
    block(depth + 1, 2);
    place(end);
    line(heading(end));
    return;
  }
  place(to);
  line(heading(to) + (below(2) == 0 ? "" : "G90"));
}

void RandomFlow::jump_back(int depth) {
  const int to = new_label();
  const int counter = 10 + counters_++;
  set(counter, 1 + below(3));
  place(to);
  line(heading(to));
  block(depth + 1, 2);
  add(counter, -1.0);
  const Condition c{.a = counter, .how = 2, .c = 0.0};
  line(fmt::format(fmt::runtime(fanuc() ? "IF{}GOTO{}" : "IF {} GOTOB {}"), written(c), label(to)));
  jump_if(c, to);
}

void RandomFlow::branch(int depth) {
  const Condition c = condition();
  const int otherwise = new_label();
  const int end = new_label();
  if (fanuc()) {  // IF … THEN
    const int n = below(kFlowVariables);
    const int value = below(9);
    line(fmt::format("IF{}THEN {}={}", written(c), variable(n), value));
    jump_unless(c, end);
    op({.kind = Op::Kind::set, .a = n, .c = static_cast<double>(value)});
    place(end);
    return;
  }
  line("IF " + written(c));
  jump_unless(c, otherwise);
  block(depth + 1, 2);
  if (below(2) == 0) {
    op({.kind = Op::Kind::jump, .label = end});
    line("ELSE");
    place(otherwise);
    block(depth + 1, 2);
  } else {
    place(otherwise);
  }
  place(end);
  line("ENDIF");
}

void RandomFlow::while_loop(int depth) {
  if (fanuc() && loops_ == 3) {
    return move();
  }
  const int counter = 10 + counters_++;
  const int head = new_label();
  const int end = new_label();
  set(counter, below(4));
  const Condition c{.a = counter, .how = 2, .c = 0.0};
  const int number = ++loops_;
  place(head);
  line(fanuc() ? fmt::format("WHILE{}DO{}", written(c), number) : "WHILE " + written(c));
  jump_unless(c, end);
  add(counter, -1.0);
  block(depth + 1, 3);
  line(fanuc() ? fmt::format("END{}", number) : "ENDWHILE");
  op({.kind = Op::Kind::jump, .label = head});
  place(end);
  --loops_;
}

// LOOP or DO without WHILE, left by a jump.
void RandomFlow::endless_loop(int depth) {
  if (fanuc() && loops_ == 3) {
    return move();
  }
  const int counter = 10 + counters_++;
  const int head = new_label();
  const int out = new_label();
  set(counter, below(3));
  const int number = ++loops_;
  line(fanuc() ? fmt::format("DO {}", number) : "LOOP");
  place(head);
  const Condition c{.a = counter, .how = 5, .c = 0.0};
  block(depth + 1, 2);
  line(fmt::format(fmt::runtime(fanuc() ? "IF{}GOTO {}" : "IF {} GOTOF {}"), written(c),
                   label(out)));
  jump_if(c, out);
  add(counter, -1.0);
  line(fanuc() ? fmt::format("END {}", number) : "ENDLOOP");
  op({.kind = Op::Kind::jump, .label = head});
  --loops_;
  place(out);
  line(heading(out));
}

void RandomFlow::count_loop(int depth) {
  if (fanuc()) {
    return while_loop(depth);
  }
  const int counter = 10 + counters_++;
  const int head = new_label();
  const int end = new_label();
  const int from = below(4);
  const int to = from + below(4) - 1;
  line(fmt::format("FOR {}={} TO {}", variable(counter), from, to));
  op({.kind = Op::Kind::set, .a = counter, .c = static_cast<double>(from)});
  place(head);
  jump_unless({.a = counter, .how = 5, .c = static_cast<double>(to)}, end);
  block(depth + 1, 3);
  line("ENDFOR");
  op({.kind = Op::Kind::add, .a = counter, .c = 1.0});
  op({.kind = Op::Kind::jump, .label = head});
  place(end);
}

void RandomFlow::until_loop(int depth) {
  if (fanuc()) {
    return jump_back(depth);
  }
  const int counter = 10 + counters_++;
  const int head = new_label();
  set(counter, below(3));
  line("REPEAT");
  place(head);
  block(depth + 1, 2);
  add(counter, -1.0);
  const Condition c{.a = counter, .how = 5, .c = 0.0};
  line("UNTIL " + written(c));
  jump_unless(c, head);
}

// CASE … OF; fanuc: GOTO of a calculated number.
void RandomFlow::choice(int depth) {
  if (fanuc()) {
    const int n = 10 + counters_++;
    const int first = new_label();
    const int second = new_label();
    const int end = new_label();
    const bool one = below(2) == 0;
    set(n, one ? first : second);
    line(fmt::format(fmt::runtime(below(2) == 0 ? "GOTO{}" : "GOTO[{}*1]"), variable(n)));
    op({.kind = Op::Kind::jump, .label = one ? first : second});
    block(depth + 1, 1);
    place(first);
    line(heading(first) + "G90");
    block(depth + 1, 2);
    line(fmt::format("GOTO {}", label(end)));
    op({.kind = Op::Kind::jump, .label = end});
    place(second);
    line(heading(second));
    block(depth + 1, 2);
    place(end);
    line(heading(end));
    return;
  }
  const int n = below(kFlowVariables);
  std::array<int, 4> to{};
  for (std::size_t i = 0; i < 3; ++i) {
    to.at(i) = new_label();
  }
  to[3] = new_label();
  line(fmt::format("CASE {} OF {} GOTOF {} {} GOTOF {} DEFAULT GOTOF {}", variable(n), 1,
                   label(to[0]), 3, label(to[1]), label(to[2])));
  jump_if({.a = n, .how = 0, .c = 1.0}, to[0]);
  jump_if({.a = n, .how = 0, .c = 3.0}, to[1]);
  op({.kind = Op::Kind::jump, .label = to[2]});
  for (std::size_t i = 0; i < 3; ++i) {
    place(to.at(i));
    line(heading(to.at(i)));
    block(depth + 1, 2);
    line(fmt::format("GOTOF {}", label(to[3])));
    op({.kind = Op::Kind::jump, .label = to[3]});
  }
  place(to[3]);
  line(heading(to[3]));
}

// REPEAT LABEL P=n, REPEAT LABEL ENDLABEL P=n, REPEAT A B P=n, REPEATB LABEL P=n
void RandomFlow::repeated(int depth) {
  if (fanuc()) {
    return jump_back(depth);
  }
  const int begin = new_label();
  const int end = new_label();
  const int times = below(3);
  const int form = below(3);
  place(begin);
  line(heading(begin) + (form == 2 ? "G0 X77" : ""));
  if (form == 2) {
    op({.kind = Op::Kind::move, .a = -1, .c = 77.0});
  } else {
    block(depth + 1, 2);
    if (form == 1) {
      line(heading(end) + "G0 X55");
      op({.kind = Op::Kind::move, .a = -1, .c = 55.0});
    }
  }
  place(end);
  if (form != 0) {
    move();
  }
  line(form == 0   ? fmt::format("REPEAT {} P={}", label(begin), times)
       : form == 1 ? fmt::format("REPEAT {} {} P={}", label(begin), label(end), times)
                   : fmt::format("REPEATB {} P={}", label(begin), times));
  if (times > 0) {
    op({.kind = Op::Kind::section, .b = end, .c = static_cast<double>(times), .label = begin});
  }
}

}  // namespace steadyrest::nc::interpret::test
