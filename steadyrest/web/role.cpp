// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>

#include <steadyrest/web/role.hpp>

namespace steadyrest::web {
namespace {

constexpr std::array<std::string_view, 3> kWords = {"viewer", "operator", "engineer"};

}  // namespace

std::string_view word(Role role) noexcept {
  return kWords[static_cast<std::size_t>(role)];
}

std::optional<Role> role_of(std::string_view word) noexcept {
  const auto* const at = std::ranges::find(kWords, word);
  return at == kWords.end() ? std::nullopt : std::optional(static_cast<Role>(at - kWords.begin()));
}

}  // namespace steadyrest::web
