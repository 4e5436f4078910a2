// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace steadyrest::nc::read {

/// One word of a program that is not accepted: where, what was seen, why, and what to do.
struct Refused {
  std::uint32_t line = 0;  ///< 1-based; 0 = the file as a whole
  std::string word;        ///< as written in the program; unprintable bytes as \xNN
  std::string reason;      ///< stable identifier: `expression`, `unknown_g_code`, …
  std::string text;        ///< one sentence: what is wrong and what is allowed
  // Lets designated initialisers leave it out.
  // NOLINTNEXTLINE(readability-redundant-member-init)
  std::string file{};  ///< of a subprogram; empty = the program itself
};

/// `text` with bytes other than printable ASCII written as \xNN; at most 60 characters.
[[nodiscard]] std::string printable(std::string_view text);

}  // namespace steadyrest::nc::read
