// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace steadyrest::web {

/// 256 random bits as 43 letters that need no escape in addresses, heads and cookies.
[[nodiscard]] std::string new_secret();
/// SHA-256 in hexadecimal: what is kept of a secret that only has to be recognised.
[[nodiscard]] std::string digest(std::string_view secret);
/// Takes the same time wherever the two differ.
[[nodiscard]] bool same_secret(std::string_view one, std::string_view other) noexcept;

}  // namespace steadyrest::web
