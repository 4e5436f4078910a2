// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <initializer_list>
#include <limits>
#include <ranges>
#include <utility>
#include <vector>

/// How much of a sweep a build runs.
namespace steadyrest::kernel::testing {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kSanitized = true;
#elif defined(__has_feature)
inline constexpr bool kSanitized =
    __has_feature(address_sanitizer) || __has_feature(thread_sanitizer);
#else
inline constexpr bool kSanitized = false;
#endif

/// The first cases of a sweep in a sanitized build, all of them otherwise.
/// A sweep repeats the same code with other numbers: the first cases show the sanitizer all there
/// is to see. The release build judges the figures over all of them.
template <std::ranges::viewable_range Cases>
[[nodiscard]] auto cases(Cases&& all, std::ptrdiff_t most_when_sanitized = 1) {
  return std::views::take(
      std::forward<Cases>(all),
      kSanitized ? most_when_sanitized : std::numeric_limits<std::ptrdiff_t>::max());
}

/// Copied: the braced list's own array ends with the head of the loop.
template <class Case>
[[nodiscard]] std::vector<Case> cases(std::initializer_list<Case> all,
                                      std::size_t most_when_sanitized = 1) {
  std::vector<Case> out(all);
  out.resize(kSanitized ? std::min(out.size(), most_when_sanitized) : out.size());
  return out;
}

}  // namespace steadyrest::kernel::testing
