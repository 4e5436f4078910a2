// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstddef>

#include <steadyrest/nc/read/sinumerik/sinumerik_landmark.hpp>
#include <steadyrest/nc/read/sinumerik/sinumerik_names.hpp>
#include <steadyrest/nc/read/text/character.hpp>

namespace steadyrest::nc::read {
namespace {

/// The words of a line, up to its comment; a string is one of them.
class WordScan {
 public:
  explicit WordScan(std::string_view line) noexcept
      : at_(line.data()), end_(line.data() + line.size()) {}

  char peek() noexcept {
    while (at_ != end_ && is_blank(*at_)) {
      ++at_;
    }
    return at_ == end_ || *at_ == ';' ? '\0' : *at_;
  }
  void skip() noexcept { ++at_; }
  /// A name, a number, a string with its quotes, or one other character.
  std::string_view next() noexcept {
    const char c = peek();
    const char* const from = at_;
    if (c == '\0') {
      return {};
    }
    ++at_;
    if (c == '"') {
      while (at_ != end_ && *at_ != '"') {
        ++at_;
      }
      at_ += at_ == end_ ? 0 : 1;
    } else if (in_name(c)) {
      while (at_ != end_ && in_name(*at_)) {
        ++at_;
      }
    }
    return {from, static_cast<std::size_t>(at_ - from)};
  }
  [[nodiscard]] const char* place() const noexcept { return at_; }
  void back_to(const char* place) noexcept { at_ = place; }

 private:
  const char* at_;
  const char* end_;
};

struct KeyWord {
  std::string_view name;
  FlowKind kind;
  // Most have none.
  // NOLINTNEXTLINE(readability-redundant-member-init)
  std::string_view loop = {};  ///< what it begins or ends
};
constexpr std::array kKeyWords = {KeyWord{"IF", FlowKind::when},
                                  KeyWord{"ELSE", FlowKind::otherwise},
                                  KeyWord{"ENDIF", FlowKind::endif},
                                  KeyWord{"WHILE", FlowKind::loop_while, "WHILE"},
                                  KeyWord{"ENDWHILE", FlowKind::end_loop, "WHILE"},
                                  KeyWord{"FOR", FlowKind::loop_count, "FOR"},
                                  KeyWord{"ENDFOR", FlowKind::end_loop, "FOR"},
                                  KeyWord{"LOOP", FlowKind::loop, "LOOP"},
                                  KeyWord{"ENDLOOP", FlowKind::end_loop, "LOOP"},
                                  KeyWord{"REPEAT", FlowKind::loop_until},
                                  KeyWord{"UNTIL", FlowKind::until},
                                  KeyWord{"CASE", FlowKind::jump},
                                  KeyWord{"REPEATB", FlowKind::section},
                                  KeyWord{"MCALL", FlowKind::modal_call}};

struct JumpWord {
  std::string_view name;
  Towards towards;
};
constexpr std::array kJumpWords = {
    JumpWord{"GOTOF", Towards::end}, JumpWord{"GOTOB", Towards::beginning},
    JumpWord{"GOTO", Towards::either}, JumpWord{"GOTOC", Towards::if_there},
    JumpWord{"GOTOS", Towards::start}};

bool read_jump(std::string_view word, WordScan& scan, Landmark& out) noexcept {
  const auto* const found =
      std::ranges::find_if(kJumpWords, [&](const JumpWord& one) { return equal(word, one.name); });
  if (found == kJumpWords.end()) {
    return false;
  }
  out.kind = FlowKind::jump;
  out.towards = found->towards;
  // A variable may have the name of a label, so this is the target only where no other jump and no
  // string follows; the map takes a name that is no label for a calculated one.
  out.target = scan.next();
  if (out.target.starts_with('"') || scan.peek() != '\0') {
    out.target = {};
  }
  return true;
}

// Jumps may be anywhere behind IF; without one it is the head of a structure.
void read_condition(WordScan& scan, Landmark& out) noexcept {
  out.kind = FlowKind::when;
  for (std::string_view word = scan.next(); !word.empty(); word = scan.next()) {
    if (read_jump(word, scan, out)) {
      return;
    }
  }
}

// M17 may follow other words.
void read_return(std::string_view word, WordScan& scan, Landmark& out) noexcept {
  for (; !word.empty(); word = scan.next()) {
    if (equal(word, "M17") || equal(word, "RET")) {
      out.kind = FlowKind::back;
    }
  }
}

// `%_N_NAME_SPF`, `%_N_NAME_MPF`
void read_program(std::string_view head, Landmark& out) noexcept {
  constexpr std::string_view kBegin = "%_N_";
  head.remove_prefix(kBegin.size());
  std::size_t length = 0;
  while (length < head.size() && in_name(head[length])) {
    ++length;
  }
  head = head.substr(0, length);
  const auto tail = head.size() > 4 ? head.substr(head.size() - 4) : std::string_view{};
  out.kind = FlowKind::label;
  out.name = equal(tail, "_SPF") || equal(tail, "_MPF") ? head.substr(0, head.size() - 4) : head;
}

// N100 or :100
void read_number(WordScan& scan, Landmark& out) noexcept {
  const char c = upper(scan.peek());
  const char* const begin = scan.place();
  if (c != 'N' && c != ':') {
    return;
  }
  scan.skip();
  const char* const digits = scan.place();
  std::uint32_t number = 0;
  for (char d = scan.peek(); is_digit(d) && number < 400'000'000; d = scan.peek()) {
    number = number * 10 + static_cast<std::uint32_t>(d - '0');
    scan.skip();
  }
  out.numbered = scan.place() != digits;
  out.number = number;
  if (!out.numbered) {
    scan.back_to(begin);
  }
}

}  // namespace

Landmark sinumerik_landmark(std::string_view line) noexcept {
  Landmark out;
  WordScan scan(line);
  if (scan.peek() == '%') {
    if (line.substr(line.find('%')).starts_with("%_N_")) {
      read_program(line.substr(line.find('%')), out);
    }
    return out;
  }
  if (scan.peek() == '/') {
    out.deleted = true;
    scan.skip();
  }
  read_number(scan, out);
  const char* const begin = scan.place();
  std::string_view word = scan.next();
  if (word.size() >= 2 && !is_digit(word.front()) && scan.peek() == ':') {
    scan.skip();
    if (scan.peek() == '=') {
      scan.back_to(begin);
    } else {
      out.label = word;
    }
    word = out.label.empty() ? word : scan.next();
  }
  if (word.empty() || read_jump(word, scan, out)) {
    return out;
  }
  const auto* const found =
      std::ranges::find_if(kKeyWords, [&](const KeyWord& one) { return equal(word, one.name); });
  if (found == kKeyWords.end()) {
    read_return(word, scan, out);
    return out;
  }
  out.kind = found->kind;
  out.name = found->loop;
  if (found->kind == FlowKind::when) {
    read_condition(scan, out);
  } else if (found->kind == FlowKind::loop_until && scan.peek() != '\0') {
    out.kind = FlowKind::section;
  }
  if (out.kind == FlowKind::section) {
    out.target = scan.next();
  }
  return out;
}

}  // namespace steadyrest::nc::read
