// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <numeric>
#include <utility>

#include <steadyrest/nc/follow/route.hpp>

namespace steadyrest::nc::follow {

Route::Route(std::vector<kernel::signal::PathSegment> path, std::vector<bool> from_start,
             std::vector<kernel::signal::PathSegment> original)
    : path_(std::move(path)),
      original_(std::move(original)),
      from_start_(std::move(from_start)),
      by_line_(path_.size()) {
  std::iota(by_line_.begin(), by_line_.end(), 0U);
  std::ranges::stable_sort(by_line_, {}, [this](std::uint32_t i) { return path_[i].line; });
}

std::span<const std::uint32_t> Route::of_line(std::uint32_t line) const noexcept {
  const auto line_of = [this](std::uint32_t i) { return path_[i].line; };
  const auto end = std::ranges::upper_bound(by_line_, line, {}, line_of);
  if (end == by_line_.begin()) {
    return {};
  }
  const auto begin =
      std::ranges::lower_bound(by_line_.begin(), end, line_of(*(end - 1)), {}, line_of);
  return {begin, end};
}

std::span<const std::uint32_t> Route::after_line(std::uint32_t line) const noexcept {
  const auto line_of = [this](std::uint32_t i) { return path_[i].line; };
  const auto begin = std::ranges::upper_bound(by_line_, line, {}, line_of);
  if (begin == by_line_.end()) {
    return {};
  }
  return {begin, std::ranges::upper_bound(by_line_, line_of(*begin), {}, line_of)};
}

std::uint32_t Route::line_before(std::uint32_t line) const noexcept {
  const auto line_of = [this](std::uint32_t i) { return path_[i].line; };
  const auto at = std::ranges::lower_bound(by_line_, line, {}, line_of);
  return at == by_line_.begin() ? line : line_of(*(at - 1));
}

}  // namespace steadyrest::nc::follow
