// SPDX-License-Identifier: Apache-2.0
#include <cstddef>

#include <steadyrest/nc/read/text/refused.hpp>

namespace steadyrest::nc::read {

std::string printable(std::string_view text) {
  // Refusals are shown on a terminal and in JSON: printable ASCII only, and at most a line's width.
  constexpr std::size_t kLongest = 60;
  constexpr std::string_view kHex = "0123456789abcdef";
  std::string out;
  for (const char c : text) {
    if (out.size() >= kLongest) {
      out += "...";
      break;
    }
    const auto byte = static_cast<unsigned char>(c);
    if (byte >= 0x20 && byte < 0x7f) {
      out += c;
    } else {
      out += "\\x";
      out += kHex[byte >> 4U];
      out += kHex[byte & 15U];
    }
  }
  return out;
}

}  // namespace steadyrest::nc::read
