// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <vector>

namespace steadyrest::plc {

/// Runs the body of a function block as its text has it: SCL, as far as the layer's blocks need it
/// (assignments, IF, CASE, RETURN; whole numbers, on which AND, OR and XOR work bit by bit). Any
/// other text is refused by std::runtime_error.
class SclBlock {
 public:
  /// `text`: from FUNCTION_BLOCK to END_FUNCTION_BLOCK; what is around it is not looked at.
  explicit SclBlock(const std::string& text);

  /// One call, when the CPU's clock shows so many ms.
  void call(long now_ms);
  /// A variable, an input or a byte of a data block. Those that were never set are 0.
  long& operator[](const std::string& name) { return variable_[name]; }

 private:
  void declare(std::size_t end);
  [[nodiscard]] const std::string& token() const;
  bool take(const std::string& word);
  void need(const std::string& word);
  /// Statements until one of these words; without `runs` they are only read.
  void statements(const std::vector<std::string>& ends, bool runs);
  void statement(bool runs);
  void branch(bool runs);
  void cases(bool runs);
  [[nodiscard]] bool is_label() const;
  bool labels(long value);
  long expression(int level = 0);
  long unary();
  long operand();
  [[nodiscard]] static bool is_number(const std::string& token);
  [[nodiscard]] static long number(const std::string& token);

  std::vector<std::string> tokens_;
  std::size_t at_ = 0;
  std::size_t body_ = 0;
  bool returned_ = false;
  long now_ms_ = 0;
  std::map<std::string, long> variable_;
};

}  // namespace steadyrest::plc
