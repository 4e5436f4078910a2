// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace steadyrest::nc::read {

/// A name of a parameter or an O-word, in lower case without blanks. No allocation.
// NOLINTNEXTLINE(cppcoreguidelines-pro-type-member-init): not zeroed for each line
class Name {
 public:
  static constexpr std::size_t kLongest = 64;

  /// False when it is full.
  bool push(char c) noexcept {
    if (length_ == kLongest) {
      return false;
    }
    text_[length_++] = c;
    return true;
  }
  void clear() noexcept { length_ = 0; }
  [[nodiscard]] std::string_view view() const noexcept { return {text_.data(), length_}; }

 private:
  std::array<char, kLongest> text_;
  std::size_t length_ = 0;
};

/// Reads the name between < and >; `at` points to <. Returns what follows, or nullptr when the name
/// is empty, too long or not closed.
const char* read_name(const char* at, const char* end, Name& name) noexcept;

}  // namespace steadyrest::nc::read
