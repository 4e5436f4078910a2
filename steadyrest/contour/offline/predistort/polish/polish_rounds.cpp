// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>

#include <steadyrest/contour/offline/predistort/polish/polish_rounds.hpp>

namespace steadyrest::contour::offline {
namespace {

constexpr double kDearer = 4.0;   ///< a second, where the program takes too long
constexpr double kCheaper = 0.7;  ///< … and where it leaves time
constexpr double kSpare = 0.99;   ///< of the time permitted
constexpr int kSecants = 1;       ///< after each further sweep, until the legs are right
constexpr double kWorth = 0.99;   ///< of the score: a sweep that wins less is the last
static_assert(1 + PolishSweeps{}.first_secants + PolishSweeps{}.most * (2 + kSecants) ==
              kPolishRuns);

}  // namespace

CornerLegs corner_legs(const PolishTask& task) {
  return CornerLegs({.limit_mm = task.price.limit_mm,
                     .lag_s = std::ranges::max(first_lags_s(task.models)),
                     .most_mm = task.most_shift_mm});
}

kernel::outcome::Result<void> polish_rounds(PolishTask task, std::vector<Piece> pieces,
                                            const std::vector<BlockStart>& starts,
                                            const TryPieces& attempt, const PolishSweeps& how) {
  CornerLegs legs = corner_legs(task);
  return polish_sweeps(task, pieces, legs, starts, attempt, how);
}

kernel::outcome::Result<void> polish_sweeps(PolishTask& task, std::vector<Piece>& pieces,
                                            CornerLegs& legs, const std::vector<BlockStart>& starts,
                                            const TryPieces& attempt, const PolishSweeps& how) {
  if (pieces.size() > kMostPieces) {
    return {};
  }
  const auto lead = [&](int secants) -> kernel::outcome::Result<TriedPieces> {
    auto tried = attempt(legs.with_legs(pieces));
    for (int i = 0; tried && i < secants && legs.update(pieces, starts); ++i) {
      tried = attempt(legs.with_legs(pieces));
    }
    return tried;
  };
  // A window behind a stop would spend time on what the stop has left.
  auto tried = lead(how.first_secants);
  double best_mm = std::numeric_limits<double>::infinity();
  for (int sweep = 0; tried && sweep < how.most; ++sweep) {
    task.unites = sweep == how.unites_in;
    pieces = polished(task, starts, pieces);
    tried = lead(kSecants);
    if (tried && tried->time > 1.0) {
      task.price.time *= kDearer;
      continue;
    }
    if (tried && tried->time < kSpare) {
      task.price.time *= kCheaper;
    }
    if (tried && tried->score_mm > kWorth * best_mm &&
        !(how.patient && tried->score_mm > best_mm / kWorth)) {
      break;
    }
    if (tried) {
      best_mm = std::min(best_mm, tried->score_mm);
    }
  }
  return tried ? kernel::outcome::Result<void>{} : std::unexpected(tried.error());
}

}  // namespace steadyrest::contour::offline
