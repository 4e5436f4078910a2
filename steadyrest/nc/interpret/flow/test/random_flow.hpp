// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <steadyrest/nc/read/text/dialect.hpp>

/// Random programs of jumps, conditions and loops with what they do, by an evaluation of its own:
/// while a program is written, each of its lines is also translated into instructions of a small
/// machine. Shares no code with the interpreter.
namespace steadyrest::nc::interpret::test {

inline constexpr int kFlowVariables = 4;

class RandomFlow {
 public:
  /// What one line did when it was executed.
  struct Done {
    int line = 0;
    double x = 0.0;  ///< of a move
    friend bool operator==(const Done&, const Done&) = default;
  };

  /// `asks`: some conditions ask the control.
  RandomFlow(read::Dialect dialect, unsigned seed, bool asks);

  [[nodiscard]] const std::string& text() const noexcept { return text_; }
  /// The moves in order, where the control answers so (bit n: question n); false when there are
  /// more than `most` instructions.
  [[nodiscard]] bool run(unsigned answers, std::vector<Done>& moves, std::size_t most = 3000) const;

 private:
  struct Op {
    enum class Kind { set, add, multiply, copy, move, jump_if, jump, section } kind = Kind::jump;
    int line = 0;
    int a = 0;       ///< variable
    int b = 0;       ///< another one
    double c = 0.0;  ///< a constant
    int how = 0;     ///< comparison
    int label = -1;  ///< jump target
    int ask = -1;    ///< the question that decides
  };
  struct Condition {
    int a = 0;
    int how = 0;
    double c = 0.0;
    int ask = -1;
  };

  [[nodiscard]] bool fanuc() const noexcept { return dialect_ == read::Dialect::fanuc; }
  int below(int n) { return static_cast<int>(random_() % static_cast<unsigned>(n)); }
  [[nodiscard]] std::string variable(int n) const;
  [[nodiscard]] std::string label(int n) const;
  [[nodiscard]] std::string heading(int n) const;
  [[nodiscard]] std::string written(const Condition& condition) const;
  void line(const std::string& text);
  void op(Op what);
  void set(int variable, double value);
  void add(int variable, double value);
  Condition condition();
  void jump_unless(const Condition& condition, int label);
  void jump_if(const Condition& condition, int label);
  int new_label() { return labels_++; }
  void place(int label) { places_[label] = ops_.size(); }

  void block(int depth, int most);
  void statement(int depth);
  void move();
  void assignment();
  void skip_ahead(int depth);
  void jump_back(int depth);
  void branch(int depth);
  void while_loop(int depth);
  void endless_loop(int depth);
  void count_loop(int depth);
  void until_loop(int depth);
  void choice(int depth);
  void repeated(int depth);

  read::Dialect dialect_;
  std::mt19937 random_;
  bool asks_;
  std::string text_;
  int lines_ = 0;
  int labels_ = 1;
  int counters_ = 0;
  int loops_ = 0;  ///< that are open: DO1 to DO3
  std::vector<Op> ops_;
  std::map<int, std::size_t> places_;
};

}  // namespace steadyrest::nc::interpret::test
