// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>

#include <steadyrest/contour/offline/predistort/polish/corner_legs.hpp>
#include <steadyrest/contour/offline/predistort/polish/polish_rounds.hpp>

namespace steadyrest::contour::offline {
namespace {

constexpr std::size_t kMostPieces = 5000;  ///< CAM programs of many lines stay
constexpr int kSweeps = 7;
constexpr double kDearer = 4.0;   ///< a second, where the program takes too long
constexpr double kCheaper = 0.5;  ///< … and where it leaves time
constexpr double kSpare = 0.99;   ///< of the time permitted
constexpr int kFirstSecants = 5;  ///< until the legs at corners are right …
constexpr int kSecants = 1;       ///< … and after each further sweep
constexpr double kWorth = 0.99;   ///< of the score: a sweep that wins less is the last
static_assert(1 + kFirstSecants + kSweeps * (2 + kSecants) == kPolishRuns);

}  // namespace

kernel::outcome::Result<void> polish_rounds(PolishTask task, std::vector<Piece> pieces,
                                            const std::vector<BlockStart>& starts,
                                            const TryPieces& attempt) {
  if (pieces.size() > kMostPieces) {
    return {};
  }
  CornerLegs legs({.limit_mm = task.price.limit_mm,
                   .lag_s = std::ranges::max(first_lags_s(task.models)),
                   .most_mm = task.most_shift_mm});
  const auto lead = [&](int secants) -> kernel::outcome::Result<TriedPieces> {
    auto tried = attempt(legs.with_legs(pieces));
    for (int i = 0; tried && i < secants && legs.update(pieces, starts); ++i) {
      tried = attempt(legs.with_legs(pieces));
    }
    return tried;
  };
  // A window behind a stop would spend time on what the stop has left.
  auto tried = lead(kFirstSecants);
  double best_mm = std::numeric_limits<double>::infinity();
  for (int sweep = 0; tried && sweep < kSweeps; ++sweep) {
    task.unites = sweep == 0;
    pieces = polished(task, starts, pieces);
    tried = lead(kSecants);
    if (tried && tried->time > 1.0) {
      task.price.time *= kDearer;
      continue;
    }
    if (tried && tried->time < kSpare) {
      task.price.time *= kCheaper;
    }
    if (tried && tried->score_mm > kWorth * best_mm) {
      break;
    }
    if (tried) {
      best_mm = tried->score_mm;
    }
  }
  return tried ? kernel::outcome::Result<void>{} : std::unexpected(tried.error());
}

}  // namespace steadyrest::contour::offline
