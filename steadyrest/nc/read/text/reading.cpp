// SPDX-License-Identifier: Apache-2.0
#include <string>

#include <steadyrest/nc/read/text/character.hpp>
#include <steadyrest/nc/read/text/reading.hpp>

namespace steadyrest::nc::read {

// The only place where reading allocates: a refusal ends it.
bool Reading::refuse(std::uint32_t line, std::string_view word, std::string_view reason,
                     std::string_view text) {
  refused = {.line = line,
             .word = printable(word),
             .reason = std::string{reason},
             .text = std::string{text}};
  return false;
}

}  // namespace steadyrest::nc::read
