// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>

#include <steadyrest/nc/read/letter/macro_landmark.hpp>
#include <steadyrest/nc/read/text/character.hpp>

namespace steadyrest::nc::read {
namespace {

/// The characters of a line that count: without comments, up to the end of the block.
class MacroScan {
 public:
  explicit MacroScan(std::string_view line) noexcept
      : at_(line.data()), end_(line.data() + line.size()) {}

  /// The next character that counts, as a capital; NUL at the end.
  char peek() noexcept {
    while (at_ != end_) {
      if (*at_ == '(') {
        while (at_ != end_ && *at_ != ')') {
          ++at_;
        }
        at_ += at_ == end_ ? 0 : 1;
      } else if (*at_ == ';') {
        at_ = end_;
      } else if (is_blank(*at_)) {
        ++at_;
      } else {
        return upper(*at_);
      }
    }
    return '\0';
  }
  void skip() noexcept { ++at_; }

  /// Takes the word if it is next; blanks may be anywhere in it.
  bool take(std::string_view word) noexcept {
    const char* const from = at_;
    const bool taken = std::ranges::all_of(word, [this](char wanted) {
      const bool same = peek() == wanted;
      at_ += same ? 1 : 0;
      return same;
    });
    at_ = taken ? at_ : from;
    return taken;
  }

  std::string_view digits() noexcept {
    peek();
    const char* const from = at_;
    while (at_ != end_ && is_digit(*at_)) {
      ++at_;
    }
    return {from, static_cast<std::size_t>(at_ - from)};
  }

  /// Behind the bracket that is next, and those in it.
  void pass_brackets() noexcept {
    int depth = 0;
    for (char c = peek(); c != '\0'; c = peek()) {
      depth += c == '[' ? 1 : c == ']' ? -1 : 0;
      if (depth <= 0 && c != ']') {
        return;
      }
      skip();
      if (depth == 0) {
        return;
      }
    }
  }

 private:
  const char* at_;
  const char* end_;
};

std::uint32_t number_of(std::string_view digits) noexcept {
  std::uint32_t number = 0;
  for (std::size_t i = 0; i < digits.size() && number < 400'000'000; ++i) {
    number = number * 10 + static_cast<std::uint32_t>(digits[i] - '0');
  }
  return number;
}

void read_goto(MacroScan& scan, Landmark& out) noexcept {
  out.kind = FlowKind::jump;
  out.towards = Towards::anywhere;
  const std::string_view digits = scan.digits();
  // Behind digits only the end of the block is a plain target.
  out.target = scan.peek() == '\0' ? digits : std::string_view{};
}

// M99, G66 and G67 anywhere in the rest of the block. M99 with P is a return all the same.
void read_codes(MacroScan& scan, Landmark& out) noexcept {
  constexpr std::uint32_t kReturn = 99;
  constexpr std::uint32_t kModal = 66;
  constexpr std::uint32_t kModalEnd = 67;
  for (char c = scan.peek(); c != '\0'; c = scan.peek()) {
    scan.skip();
    if (c != 'M' && c != 'G') {
      continue;
    }
    const std::uint32_t code = number_of(scan.digits());
    if (c == 'M' && code == kReturn) {
      out.kind = FlowKind::back;
    } else if (c == 'G' && (code == kModal || code == kModalEnd)) {
      out.kind = FlowKind::modal_call;
    }
  }
}

}  // namespace

Landmark macro_landmark(std::string_view line) noexcept {
  Landmark out;
  MacroScan scan(line);
  if (scan.take("/")) {
    out.deleted = true;
  }
  if (scan.peek() == 'N') {
    scan.skip();
    const std::string_view digits = scan.digits();
    out.numbered = !digits.empty();
    out.number = number_of(digits);
  }
  const char first = scan.peek();
  if (first == 'O' || first == ':') {
    scan.skip();
    out.name = scan.digits();
    out.kind = out.name.empty() ? FlowKind::none : FlowKind::label;
  } else if (scan.take("GOTO")) {
    read_goto(scan, out);
  } else if (scan.take("IF")) {
    scan.pass_brackets();
    if (scan.take("GOTO")) {
      read_goto(scan, out);
    }
  } else if (scan.take("WHILE")) {
    scan.pass_brackets();
    out.kind = scan.take("DO") ? FlowKind::loop_while : FlowKind::none;
    out.name = scan.digits();
  } else if (scan.take("DO")) {
    out.kind = FlowKind::loop;
    out.name = scan.digits();
  } else if (scan.take("END")) {
    out.kind = FlowKind::end_loop;
    out.name = scan.digits();
  } else if (first != '#' && first != '\0') {
    read_codes(scan, out);
  }
  return out;
}

}  // namespace steadyrest::nc::read
