// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cctype>
#include <sstream>
#include <stdexcept>

#include <tests/plc/scl_block.hpp>

namespace steadyrest::plc {
namespace {

bool is_word(char letter) {
  return std::isalnum(static_cast<unsigned char>(letter)) != 0 || letter == '_' || letter == '#' ||
         letter == '.';
}

/// Of a line; `10..12` are three tokens, `DB21.DB4` is one.
void split(const std::string& line, std::vector<std::string>& out) {
  for (std::size_t i = 0; i < line.size();) {
    if (std::isspace(static_cast<unsigned char>(line[i])) != 0) {
      ++i;
      continue;
    }
    std::size_t end = i + 1;
    if (line.compare(i, 2, "..") == 0 || line.compare(i, 2, ":=") == 0 ||
        line.compare(i, 2, "<>") == 0 || line.compare(i, 2, "<=") == 0 ||
        line.compare(i, 2, ">=") == 0) {
      end = i + 2;
    } else if (is_word(line[i])) {
      while (end < line.size() && is_word(line[end]) && line.compare(end, 2, "..") != 0) {
        ++end;
      }
    }
    out.push_back(line.substr(i, end - i));
    i = end;
  }
}

}  // namespace

SclBlock::SclBlock(const std::string& text) {
  std::istringstream lines(text);
  bool inside = false;
  for (std::string line; std::getline(lines, line);) {
    inside = inside || line.starts_with("FUNCTION_BLOCK");
    if (inside) {
      split(line.substr(0, line.find("//")), tokens_);
    }
    inside = inside && !line.starts_with("END_FUNCTION_BLOCK");
  }
  const auto begin = std::ranges::find(tokens_, "BEGIN");
  if (begin == tokens_.end() || tokens_.back() != "END_FUNCTION_BLOCK") {
    throw std::runtime_error("no function block");
  }
  body_ = static_cast<std::size_t>(begin - tokens_.begin()) + 1;
  declare(body_);
}

/// NAME := VALUE; and NAME : TYPE := VALUE; the rest are 0.
void SclBlock::declare(std::size_t end) {
  for (std::size_t i = 0; i + 1 < end; ++i) {
    if (tokens_[i] == ":=") {
      const std::size_t name = i >= 2 && tokens_[i - 2] == ":" ? i - 3 : i - 1;
      variable_[tokens_[name]] = number(tokens_[i + 1]);
    }
  }
}

void SclBlock::call(long now_ms) {
  now_ms_ = now_ms;
  at_ = body_;
  returned_ = false;
  statements({"END_FUNCTION_BLOCK"}, true);
}

const std::string& SclBlock::token() const {
  if (at_ >= tokens_.size()) {
    throw std::runtime_error("the text ends too soon");
  }
  return tokens_[at_];
}

bool SclBlock::take(const std::string& word) {
  const bool is = token() == word;
  at_ += is ? 1 : 0;
  return is;
}

void SclBlock::need(const std::string& word) {
  if (!take(word)) {
    throw std::runtime_error(word + " expected, not " + token());
  }
}

void SclBlock::statements(const std::vector<std::string>& ends, bool runs) {
  while (std::ranges::find(ends, token()) == ends.end() &&
         !(ends.front() == "END_CASE" && is_label())) {
    statement(runs && !returned_);
  }
}

void SclBlock::statement(bool runs) {
  if (take("IF")) {
    branch(runs);
  } else if (take("CASE")) {
    cases(runs);
  } else if (take("RETURN")) {
    returned_ = returned_ || runs;
    need(";");
  } else {
    const std::string name = token();
    ++at_;
    need(":=");
    const long value = expression();
    need(";");
    if (runs) {
      variable_[name] = value;
    }
  }
}

void SclBlock::branch(bool runs) {
  bool done = false;
  do {
    const bool here = expression() != 0 && !done;
    need("THEN");
    statements({"ELSIF", "ELSE", "END_IF"}, runs && here);
    done = done || here;
  } while (take("ELSIF"));
  if (take("ELSE")) {
    statements({"END_IF"}, runs && !done);
  }
  need("END_IF");
  need(";");
}

void SclBlock::cases(bool runs) {
  const long value = expression();
  need("OF");
  bool done = false;
  while (is_label()) {
    const bool here = labels(value) && !done;
    statements({"END_CASE", "ELSE"}, runs && here);
    done = done || here;
  }
  if (take("ELSE")) {
    statements({"END_CASE"}, runs && !done);
  }
  need("END_CASE");
  need(";");
}

bool SclBlock::is_label() const {
  return is_number(token());
}

bool SclBlock::labels(long value) {
  bool found = false;
  do {
    const long first = number(token());
    ++at_;
    long last = first;
    if (take("..")) {
      last = number(token());
      ++at_;
    }
    found = found || (value >= first && value <= last);
  } while (take(","));
  need(":");
  return found;
}

/// By precedence, the weakest first. Both sides are worked out, as a PLC does.
long SclBlock::expression(int level) {
  static const std::array<std::vector<std::string>, 6> kOperators = {
      {{"OR"}, {"XOR"}, {"AND"}, {"=", "<>", "<", "<=", ">", ">="}, {"+", "-"}, {"MOD"}}};
  if (level == static_cast<int>(kOperators.size())) {
    return unary();
  }
  long left = expression(level + 1);
  const auto& own = kOperators.at(static_cast<std::size_t>(level));
  while (std::ranges::find(own, token()) != own.end()) {
    const std::string by = token();
    ++at_;
    const long right = expression(level + 1);
    left = by == "OR"    ? left | right
           : by == "XOR" ? left ^ right
           : by == "AND" ? left & right
           : by == "="   ? static_cast<long>(left == right)
           : by == "<>"  ? static_cast<long>(left != right)
           : by == "<"   ? static_cast<long>(left < right)
           : by == "<="  ? static_cast<long>(left <= right)
           : by == ">"   ? static_cast<long>(left > right)
           : by == ">="  ? static_cast<long>(left >= right)
           : by == "+"   ? left + right
           : by == "-"   ? left - right
                         : left % right;
  }
  return left;
}

long SclBlock::unary() {
  return take("NOT") ? static_cast<long>(unary() == 0) : operand();
}

long SclBlock::operand() {
  if (take("(")) {
    const long value = expression();
    need(")");
    return value;
  }
  const std::string name = token();
  ++at_;
  if (is_number(name)) {
    return number(name);
  }
  if (name == "SHR") {
    for (const char* const word : {"(", "IN", ":="}) {
      need(word);
    }
    const long value = expression();
    for (const char* const word : {",", "N", ":="}) {
      need(word);
    }
    const long by = expression();
    need(")");
    return value >> by;
  }
  if (name == "TIME_TCK") {
    need("(");
    need(")");
    return now_ms_;
  }
  if (take("(")) {  // WORD_TO_INT and its like
    if (name.find("_TO_") == std::string::npos) {
      throw std::runtime_error("not known: " + name);
    }
    const long value = expression();
    need(")");
    return value;
  }
  return variable_[name];
}

bool SclBlock::is_number(const std::string& token) {
  return std::isdigit(static_cast<unsigned char>(token.front())) != 0 ||
         token.find('#') != std::string::npos || token == "TRUE" || token == "FALSE";
}

/// 12, L#12, B#16#1A, W#16#1F, TRUE.
long SclBlock::number(const std::string& token) {
  if (token == "TRUE" || token == "FALSE") {
    return token == "TRUE" ? 1 : 0;
  }
  const std::size_t mark = token.rfind('#');
  if (mark == std::string::npos) {
    return std::stol(token);
  }
  return std::stol(token.substr(mark + 1), nullptr,
                   token.find("16#") != std::string::npos ? 16 : 10);
}

}  // namespace steadyrest::plc
