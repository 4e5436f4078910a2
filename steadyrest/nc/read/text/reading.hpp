// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

#include <steadyrest/nc/read/text/dialect.hpp>
#include <steadyrest/nc/read/text/refused.hpp>
#include <steadyrest/nc/read/text/typed_values.hpp>
#include <steadyrest/nc/read/text/values.hpp>

namespace steadyrest::nc::read {

/// What the `~` at the end of a line has left open (heidenhain).
enum class Continued : std::uint8_t {
  no,
  values,   ///< of a cycle's definition
  comment,  ///< a comment that goes on in the next line
  refused   ///< of a block that was refused
};

/// What reading a line needs from the program, and what it reports about the line.
struct Reading {
  Dialect dialect = Dialect::linuxcnc;
  Values* values = nullptr;             ///< nullptr: expressions are refused
  TypedValues* typed_values = nullptr;  ///< of sinumerik
  bool numbers_alone = false;           ///< no value was asked for or set
  Continued continued = Continued::no;  ///< by the line before
  bool begun = false;                   ///< heidenhain: BEGIN PGM has been read
  Refused refused = {};

  /// Stores why a line is refused; returns false.
  bool refuse(std::uint32_t line, std::string_view word, std::string_view reason,
              std::string_view text);
};

}  // namespace steadyrest::nc::read
