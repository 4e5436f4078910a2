// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace steadyrest::live {

/// A wish of a record (supervisor/wish_text.hpp) in plain words, with who made it: `page: otto
/// (operator) set the modulation: …`. A line that is no wish comes back as it is.
[[nodiscard]] std::string wish_words(std::string_view text);

}  // namespace steadyrest::live
