// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace steadyrest::web {

/// What a person or a script may do; each role may do what those before it may.
enum class Role : std::uint8_t {
  viewer,  ///< sees everything, and may hand back to the operator's panel
  operating,
  engineer
};

/// `viewer`, `operator`, `engineer`.
[[nodiscard]] std::string_view word(Role role) noexcept;
[[nodiscard]] std::optional<Role> role_of(std::string_view word) noexcept;

/// Who asks.
struct Caller {
  std::string name;
  Role role = Role::viewer;

  friend bool operator==(const Caller&, const Caller&) = default;
};

}  // namespace steadyrest::web
