// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>
#include <string>
#include <string_view>

namespace steadyrest::nc::rewrite {

/// The lines that compensate() writes, for every control, method and axis, told from a user's line
/// with the same mark in its comment. Made from the writers themselves (`writing`,
/// `linuxcnc_text`), so a changed text is a changed form.
///
/// A form is the line with each number, its sign included, as one character and the axes named in
/// the head's comments as one. What follows a G, M or L is no number: it says what the line does.
class WrittenLines {
 public:
  WrittenLines();

  /// Character for character a line that compensate() writes, its numbers aside.
  [[nodiscard]] bool has(std::string_view line) const;

 private:
  void add(std::string_view text);

  std::set<std::string> forms_;
};

}  // namespace steadyrest::nc::rewrite
