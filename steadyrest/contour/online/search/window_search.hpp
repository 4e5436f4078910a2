// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>

#include <steadyrest/math/geometry/vector.hpp>

namespace steadyrest::contour::online {

/// The nearest point found on a window of a path.
struct Nearest {
  std::size_t index = 0;     ///< piece
  double position_mm = 0.0;  ///< path length
  double distance_mm = 0.0;
  double u = 0.0;  ///< parameter on the piece
  kernel::signal::Point point_mm{};
  bool complete = true;  ///< every piece of the window was evaluated or excluded
};

/// The piece that contains `position`, searched from `hint` in steps that double, then by halves.
template <class Pieces>
[[nodiscard]] std::size_t find_piece(const Pieces& pieces, std::size_t hint,
                                     double position_mm) noexcept {
  const std::size_t last = pieces.size() - 1;
  std::size_t low = std::min(hint, last);
  std::size_t high = low;
  for (std::size_t step = 1; low > 0 && pieces.begin_mm(low) > position_mm; step *= 2) {
    high = low;
    low = low > step ? low - step : 0;
  }
  for (std::size_t step = 1; high < last && pieces.end_mm(high) < position_mm; step *= 2) {
    low = high;
    high = std::min(last, high + step);
  }
  while (low < high) {
    const std::size_t middle = low + (high - low) / 2;
    if (pieces.end_mm(middle) < position_mm) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  return low;
}

/// The global minimum of the distance to `query` on the path lengths low…high.
///
/// The distance changes at most as fast as the path length. When a piece begins at distance d and
/// the best so far is b, no point within the next d − b can be nearer: the search leaps over it. It
/// begins at `guess_mm`, goes forward, then backward, and evaluates at most `max_feet` pieces.
///
/// `Pieces` has size(), begin_mm(i), end_mm(i), start(i), end(i) and
/// foot(i, query, low, high, guess) → Nearest on that piece clipped to the window.
template <class Pieces>
[[nodiscard]] Nearest nearest_in_window(const Pieces& pieces, const kernel::signal::Point& query,
                                        double low_mm, double high_mm, std::size_t hint,
                                        double guess_mm, int max_feet) noexcept {
  using math::geometry::distance;
  const std::size_t first = find_piece(pieces, hint, std::clamp(guess_mm, low_mm, high_mm));
  Nearest best = pieces.foot(first, query, low_mm, high_mm, guess_mm);
  int left = max_feet - 1;
  const auto look = [&](std::size_t i) {
    const Nearest found = pieces.foot(i, query, low_mm, high_mm, guess_mm);
    if (found.distance_mm < best.distance_mm) {
      best = found;
    }
    --left;
  };

  std::size_t i = first;
  while (i + 1 < pieces.size() && pieces.end_mm(i) < high_mm && left > 0) {
    ++i;
    const double reach = distance(pieces.start(i), query) - best.distance_mm;
    const double free_to = pieces.begin_mm(i) + reach;
    if (free_to < pieces.end_mm(i)) {
      look(i);
      continue;
    }
    --left;
    if (free_to >= high_mm) {
      i = pieces.size();
      break;
    }
    // The landing piece has not been seen from its start: evaluate all of it.
    i = find_piece(pieces, i, free_to);
    look(i);
  }
  bool complete = left > 0;
  i = first;
  while (i > 0 && pieces.begin_mm(i) > low_mm && left > 0) {
    --i;
    const double reach = distance(pieces.end(i), query) - best.distance_mm;
    const double free_to = pieces.end_mm(i) - reach;
    if (free_to > pieces.begin_mm(i)) {
      look(i);
      continue;
    }
    --left;
    if (free_to <= low_mm) {
      break;
    }
    i = find_piece(pieces, i, free_to);
    look(i);
  }
  complete = complete && left > 0;
  best.complete = complete;
  return best;
}

}  // namespace steadyrest::contour::online
