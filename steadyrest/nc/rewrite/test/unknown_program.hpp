// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <random>
#include <string>
#include <vector>

#include <fmt/core.h>

namespace steadyrest::nc::rewrite::test {

/// A random LinuxCNC program that asks the control: for the task, an input, parameters that it has
/// not set, its offset, tool and modes; in conditions, loops, calls, targets, feeds and messages.
class UnknownProgram {
 public:
  explicit UnknownProgram(std::mt19937& random) : random_(random) {
    for (const char* word : {"G21", "G90", "G17", "G54", "G94"}) {
      if (!chance(12)) {
        put(word);
      }
    }
    put("F600");
    put("G0 X0 Y0 Z0");
    if (chance(3)) {
      put("o900 sub");
      items(2, 1, true);
      put("o900 endsub");
      has_sub_ = true;
    }
    items(4 + static_cast<int>(random_() % 8), 0, false);
    put("G0 Z9");
    put("M2");
  }
  [[nodiscard]] const std::string& text() const noexcept { return text_; }

 private:
  bool chance(unsigned one_in) { return random_() % one_in == 0; }
  template <class List>
  auto one_of(const List& list) {
    return list[random_() % list.size()];
  }
  void put(const std::string& line) { text_ += line + "\n"; }
  std::string number() {
    return fmt::format("{:.3f}", static_cast<double>(random_() % 40000) / 1000.0 - 20.0);
  }

  std::string unknown() {
    static const std::vector<std::string> kValues = {
        "#<_task>",      "#5399",    "#100",         "#101",  "#5220", "#<_current_tool>",
        "EXISTS[#<_q>]", "#5420",    "#<_absolute>", "#5063", "#1",    "#2",
        "#<a>",          "#<_value>"};
    return one_of(kValues);
  }
  std::string condition() {
    static const std::vector<std::string> kSigns = {"EQ", "GT", "NE", "LE"};
    return fmt::format("[{} {} {}]", chance(4) ? "1" : unknown(), one_of(kSigns), random_() % 2);
  }
  std::string cut() {
    std::string line = chance(4) ? "" : "G1 ";
    line += chance(5) ? "" : "X" + number() + " ";
    line += chance(5) ? "Y1" : "Y" + number();
    return line + (chance(6) ? " Z" + number() : "") + (chance(6) ? " F500" : "");
  }
  void loop(int depth, bool in_sub) {
    const int label = ++label_;
    const int counter = 10 + label % 15;
    switch (random_() % 3) {
      case 0:
        put(fmt::format("#{}=0", counter));
        put(fmt::format("o{} while [#{} LT {}]", label, counter,
                        chance(2) ? "2" : "[1+" + unknown() + "*0+#100]"));
        put(fmt::format("#{}=[#{}+1]", counter, counter));
        items(2, depth + 1, in_sub);
        if (chance(3)) {
          put(fmt::format("o{} if {}", ++label_, condition()));
          put(fmt::format("o{} {}", label, chance(2) ? "break" : "continue"));
          put(fmt::format("o{} endif", label_));
        }
        put(fmt::format("o{} endwhile", label));
        break;
      case 1:
        put(fmt::format("#{}=0", counter));
        put(fmt::format("o{} do", label));
        put(fmt::format("#{}=[#{}+1]", counter, counter));
        items(2, depth + 1, in_sub);
        put(fmt::format("o{} while [#{} LT {}]", label, counter,
                        chance(2) ? "2" : "[1+" + unknown() + "*0+#<_task>]"));
        break;
      default:
        put(fmt::format("o{} repeat [{}]", label, chance(2) ? "2" : "1+" + unknown()));
        items(2, depth + 1, in_sub);
        put(fmt::format("o{} endrepeat", label));
        break;
    }
  }
  void branch(int depth, bool in_sub) {
    const int label = ++label_;
    put(fmt::format("o{} if {}", label, condition()));
    items(1 + static_cast<int>(random_() % 2), depth + 1, in_sub);
    if (in_sub && chance(4)) {
      put("o900 return [1]");
    } else if (!in_sub && chance(8)) {
      put("M2");
    }
    if (chance(3)) {
      put(fmt::format("o{} else", label));
      items(1, depth + 1, in_sub);
    }
    put(fmt::format("o{} endif", label));
  }
  void items(int count, int depth, bool in_sub) {
    for (int i = 0; i < count; ++i) {
      item(depth, in_sub);
    }
  }
  void item(int depth, bool in_sub) {
    const auto kind = random_() % 40;
    if (kind < 16) {
      put(cut());
    } else if (kind < 18) {
      put(fmt::format("G{} X{} Y{} R40", 2 + random_() % 2, number(), number()));
    } else if (kind < 20) {
      put(chance(2) ? "M66 P0 L0" : "#<a>=" + unknown());
    } else if (kind < 22) {
      put(fmt::format("#{}={}", 1 + random_() % 2, chance(2) ? unknown() : number()));
    } else if (kind < 23) {
      put(fmt::format("G1 X[{}*3] F600", unknown()));
    } else if (kind < 25) {
      put(chance(2) ? "G91" : "G90");
    } else if (kind < 27) {
      put("G0 G90 X" + number() + " Y" + number());
    } else if (kind < 29) {
      put("G0 G90 G17 X1 Y2 Z3 F600");
    } else if (kind < 30) {
      static const std::vector<std::string> kHarmless = {"S[100+#100] M3",
                                                         "G4 P[#100*0.1]",
                                                         "(MSG, hello)",
                                                         "M8",
                                                         "F500",
                                                         "G92 X1",
                                                         "G54",
                                                         "G55",
                                                         "G18",
                                                         "G17",
                                                         "G43 H0",
                                                         "T3 M6",
                                                         "G28",
                                                         "G53 G0 Z0",
                                                         "M70",
                                                         "M72",
                                                         "G0 Z1",
                                                         "#5221=2",
                                                         "G81 X1 Y1 Z-1 R1",
                                                         "G80"};
      put(one_of(kHarmless));
    } else if (kind < 35 && depth < 3) {
      branch(depth, in_sub);
    } else if (kind < 38 && depth < 2) {
      loop(depth, in_sub);
    } else if (has_sub_ && !in_sub) {
      put(fmt::format("o900 call [{}]", chance(2) ? unknown() : number()));
    } else {
      put(cut());
    }
  }

  std::mt19937& random_;
  std::string text_;
  int label_ = 100;
  bool has_sub_ = false;
};

}  // namespace steadyrest::nc::rewrite::test
