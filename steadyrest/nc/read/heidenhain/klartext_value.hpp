// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include <steadyrest/nc/read/text/number.hpp>
#include <steadyrest/nc/read/text/values.hpp>

namespace steadyrest::nc::read {

/// A number with a decimal point or comma; length 0 where there is none.
[[nodiscard]] Number read_klartext_number(std::string_view text) noexcept;

/// Q parameters among the numbers of `Values`: Q as they are, QL and QR above.
inline constexpr int kFirstLocalQ = 10'000;
inline constexpr int kFirstKeptQ = 20'000;

/// The number of `Q5`, `QL5` or `QR5` among `Values`.
struct QName {
  int index = 0;
  std::size_t length = 0;  ///< in characters; 0 = the text does not begin with one
};
[[nodiscard]] QName read_q_name(std::string_view text) noexcept;

/// Why a Q parameter cannot be read or set.
[[nodiscard]] LookupText klartext_lookup_text(Lookup lookup) noexcept;

}  // namespace steadyrest::nc::read
