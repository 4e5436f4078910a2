// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string_view>
#include <type_traits>
#include <utility>

#include <steadyrest/passport/keys/schema.hpp>

/// Keys whose value is one of several words, in the order of the enumeration.
namespace steadyrest::passport {

template <class S, auto Member>
[[nodiscard]] Choice<S> choice(std::span<const std::string_view> words) {
  using Enum = std::remove_cvref_t<decltype(std::declval<S&>().*Member)>;
  return {words, [](S& section, std::size_t i) { section.*Member = static_cast<Enum>(i); },
          [](const S& section) { return static_cast<std::size_t>(section.*Member); }};
}

template <class Enum, std::size_t N>
[[nodiscard]] std::string_view pick(const std::array<std::string_view, N>& words,
                                    Enum value) noexcept {
  const auto i = static_cast<std::size_t>(value);
  return i < N ? words[i] : "?";
}

}  // namespace steadyrest::passport
