// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>

/// The largest admissible step of a table: looking at every step, or at few.
namespace steadyrest::contour::online {

/// From the highest down: the first admissible one is the largest, whatever the order of their
/// errors. Asks `may_go_on()` before each look but the first; empty if none is found.
template <class Admissible, class MayGoOn>
std::optional<std::size_t> first_admissible_below(std::size_t top, Admissible&& admissible,
                                                  MayGoOn&& may_go_on) {
  for (std::size_t step = top + 1; step-- > 0;) {
    if (admissible(step)) {
      return step;
    }
    if (!may_go_on()) {
      break;
    }
  }
  return std::nullopt;
}

/// From `start` ≤ `top` in strides that double until the answer changes, then by halves: at most
/// 2·log₂(n) + 2 looks, two where nothing changes. The result is the largest where a slower step is
/// admissible whenever a faster one is. Otherwise the step found is still admissible, but a faster
/// one may be missed. When `may_go_on()` says no, the best one known remains.
template <class Admissible, class MayGoOn>
std::optional<std::size_t> largest_admissible_near(std::size_t start, std::size_t top,
                                                   Admissible&& admissible, MayGoOn&& may_go_on) {
  // `good` − 1 is admissible; `bad` is not, or lies above the top.
  std::size_t good = 0;
  std::size_t bad = top + 1;
  const auto look = [&](std::size_t step) {
    const bool is_good = admissible(step);
    (is_good ? good : bad) = is_good ? step + 1 : step;
    return is_good;
  };
  std::size_t at = std::min(start, top);
  const bool upwards = look(at);
  for (std::size_t stride = 1; good < bad && may_go_on(); stride *= 2) {
    at = upwards ? std::min(at + stride, top) : at - std::min(at, stride);
    if (look(at) != upwards) {
      break;
    }
  }
  while (good < bad && may_go_on()) {
    look(good + (bad - good) / 2);
  }
  return good > 0 ? std::optional(good - 1) : std::nullopt;
}

}  // namespace steadyrest::contour::online
