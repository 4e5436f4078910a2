// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include <steadyrest/nc/rewrite/text/writing.hpp>

namespace steadyrest::nc::rewrite {

/// Scans a program's text before any of it is interpreted: where the head may go, and whether the
/// program itself uses what the corrections are written to.
class PlaceOfHead {
 public:
  explicit PlaceOfHead(const Way& way) : way_(way) {}

  /// The next line of the program.
  void look(std::string_view line, std::uint32_t number) noexcept;
  /// The line after the head: the first that does something. 0 in an empty program.
  [[nodiscard]] std::uint32_t line() const noexcept { return line_; }

 private:
  [[nodiscard]] bool opens(std::string_view line) const noexcept;

  const Way& way_;
  std::uint32_t line_ = 0;
};

/// Whatever the line itself may use of what corrections are written to; empty when nothing.
[[nodiscard]] std::string own_use(const Way& way, std::string_view line);
/// What to do about it.
[[nodiscard]] std::string_view against_own_use(const Way& way) noexcept;

}  // namespace steadyrest::nc::rewrite
