// SPDX-License-Identifier: Apache-2.0
#include <charconv>
#include <system_error>

#include <steadyrest/nc/read/text/number.hpp>

namespace steadyrest::nc::read {

// The library rounds correctly for any number of digits, but slowly; few numbers need it.
bool read_long_number(const char* begin, const char* end, double& value) noexcept {
  return std::from_chars(begin, end, value, std::chars_format::fixed).ec == std::errc{};
}

}  // namespace steadyrest::nc::read
