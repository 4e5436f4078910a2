// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

#include <steadyrest/nc/read/text/block.hpp>
#include <steadyrest/nc/read/text/character.hpp>
#include <steadyrest/nc/read/text/reading.hpp>

namespace steadyrest::nc::read {

/// A place in a line that is being read into a block: what the lines of all dialects share.
class LineCursor {
 public:
  LineCursor(Reading& reading, std::string_view line, std::uint32_t number, Block& block) noexcept
      : reading_(reading),
        begin_(line.data()),
        at_(line.data()),
        end_(line.data() + line.size()),
        number_(number),
        block_(block) {}

 protected:
  void skip_blanks() noexcept {
    while (at_ != end_ && is_blank(*at_)) {
      ++at_;
    }
  }
  [[nodiscard]] std::string_view line() const noexcept {
    return {begin_, static_cast<std::size_t>(end_ - begin_)};
  }
  [[nodiscard]] std::string_view rest() const noexcept {
    return {at_, static_cast<std::size_t>(end_ - at_)};
  }
  [[nodiscard]] std::string_view since(const char* from) const noexcept {
    return {from, static_cast<std::size_t>(at_ - from)};
  }
  [[nodiscard]] std::size_t offset() const noexcept {
    return static_cast<std::size_t>(at_ - begin_);
  }
  /// Skips what an expression has read; passes on its refusal.
  template <class Expression>
  bool behind(const char* word_begin, const Expression& expression, bool read) {
    at_ += expression.length();
    return read || refuse(since(word_begin), expression.reason(), expression.text());
  }
  bool refuse(std::string_view word, std::string_view reason, std::string_view text) {
    return reading_.refuse(number_, word, reason, text);
  }

  Reading& reading_;
  const char* begin_;
  const char* at_;
  const char* end_;
  std::uint32_t number_;
  Block& block_;
};

}  // namespace steadyrest::nc::read
