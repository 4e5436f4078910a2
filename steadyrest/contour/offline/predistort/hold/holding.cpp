// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include <steadyrest/contour/offline/predistort/polish/polish_rounds.hpp>
#include <steadyrest/contour/offline/predistort/predistortion.hpp>
#include <steadyrest/contour/offline/predistort/shape/expected_speed.hpp>
#include <steadyrest/nc/plan/path/limits.hpp>
#include <steadyrest/nc/rewrite/tube/prove_made.hpp>

namespace steadyrest::contour::offline {
namespace {

using kernel::outcome::Result;

constexpr double kLeastWindowFeed = 0.3;  ///< of the programmed one, under windows
constexpr double kArcSpeed = 0.9;         ///< of what the control permits on a command's arc
constexpr double kHardly = 0.005;         ///< of the cut over the limit …
constexpr double kLittleMore = 1.1;  ///< … in so much of the program's time: windows stop there
constexpr double kNearly = 1.05;     ///< of the program's own time: feeds alone are enough
constexpr double kOverLimit = 30.0;  ///< price of an error over it (ChainPrice)
constexpr int kWindowSteps = 6;
constexpr double kWellShaped = 0.3;     ///< of the limit: a window that leaves less stays
constexpr std::size_t kLongWindow = 5;  ///< pieces
constexpr int kShapingRounds = 3;
constexpr PolishSweeps kToShape{.most = 3, .first_secants = 4, .patient = true};
constexpr int kNudges = 4;
constexpr double kNudge = 0.93;     ///< of the feed
constexpr double kNudged_mm = 1.0;  ///< before the tool
constexpr PolishSweeps kNudged{.most = 2, .first_secants = 0, .patient = true};
constexpr PolishSweeps kToHold{.most = 5, .first_secants = 1, .patient = true};

/// What windows begin with.
enum class From : std::uint8_t {
  expected,  ///< a coarse fit for the speed of a smooth command
  rounds,    ///< one for the speed of a few rounds
  best       ///< the best windows have left
};
struct Pass {
  From from = From::expected;
  bool tightens = false;  ///< feeds fall before it
};
constexpr std::array kPasses = {Pass{From::expected, false}, Pass{From::rounds, false},
                                Pass{From::expected, true}, Pass{From::rounds, false},
                                Pass{From::best, false}};

/// Slower between the tool and its command.
void slow_down(std::vector<Piece>& pieces, const std::vector<ErrorPlace>& places) {
  std::vector<bool> there(pieces.size(), false);
  for (const ErrorPlace& place : places) {
    const auto first =
        std::ranges::upper_bound(pieces, place.foot_mm - kNudged_mm, {}, &Piece::progress_end_mm);
    for (auto i = static_cast<std::size_t>(first - pieces.begin());
         i < pieces.size() && pieces[i].progress_start_mm < place.progress_mm; ++i) {
      there[i] = true;
    }
  }
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    pieces[i].segment.feed_mm_s *= there[i] ? kNudge : 1.0;
  }
}

}  // namespace

Result<void> Predistortion::hold() {
  progress_.phase("holding the limit", kHoldRuns + kMostHolds * kHoldRounds);
  holds_ = true;
  const CommandSpeed speed = best_speed_;
  if (auto done = hold_by_feeds(); !done) {
    return done;
  }
  // Nothing takes less time than the program itself.
  const double before_s = first_->seconds;
  if (held_->cost_s() <= kNearly * before_s && out_.seconds_after <= kNearly * before_s) {
    progress_.phase("polishing the path", kPolishRuns);
    auto done = polish();
    return done ? nudge() : done;
  }
  best_speed_ = speed;
  if (auto done = polish(); !done) {
    return done;
  }
  if (out_.after.share_over() < kHardly && out_.seconds_after <= kLittleMore * before_s) {
    return nudge();
  }
  best_speed_ = speed;
  learnt_.unrefine(0);
  by_ = HeldStretches::By::windows;
  auto done = hold_by_windows();
  by_ = HeldStretches::By::feeds;
  return done ? nudge() : done;
}

Result<void> Predistortion::nudge() {
  const TryPieces attempt = [this](const std::vector<Piece>& made) { return try_pieces(made); };
  PolishTask task = polish_task();
  task.price.time = PolishTask::kTimeToHold;
  task.price.over = kOverHeld;
  task.price.enough_mm = task.price.aim * task.price.limit_mm;
  for (int i = 0; i < kNudges; ++i) {
    std::vector<Piece> pieces = held_->best();
    if (const auto tried = try_pieces(pieces); !tried) {
      return std::unexpected(tried.error());
    }
    std::erase_if(over_, &ErrorPlace::early);
    if (over_.empty() || pieces.size() > kMostPieces) {
      break;
    }
    slow_down(pieces, over_);
    CornerLegs none({.most_mm = 0.0});  // the best have theirs
    if (auto done = polish_sweeps(task, pieces, none, starts_, attempt, kNudged); !done) {
      return done;
    }
  }
  return take_best_stretches();
}

Result<void> Predistortion::take_best_stretches() {
  for (;;) {
    best_cost_s_ = std::numeric_limits<double>::infinity();
    const auto tried = try_pieces(held_->best());
    const auto refusal = [&]() -> std::optional<kernel::outcome::Refusal> {
      if (!tried) {
        return tried.error();
      }
      const auto proof = nc::rewrite::prove_made(file_, best_.replaced, config_, machine_);
      return proof ? std::nullopt : std::optional(proof.error());
    }();
    if (!refusal) {
      return {};
    }
    // A text that the proof refuses costs one stretch.
    const auto at = std::ranges::find(path_.segments, static_cast<std::uint32_t>(refusal->line),
                                      &kernel::signal::PathSegment::line);
    if (at == path_.segments.end() ||
        !held_->give_up_windows(at->position_mm + 0.5 * at->length_mm)) {
      return tried ? Result<void>{} : std::unexpected(tried.error());
    }
  }
}

Result<void> Predistortion::hold_by_windows() {
  const CommandSpeed first = best_speed_;
  caps_.emplace(path_, std::max(kLeastWindowFeed, machine_.contour.min_ratio));
  caps_->lower_arcs(nc::plan::PathLimits(machine_.axes, machine_.control), inverse_.lag_s(),
                    kArcSpeed);
  for (const Pass& pass : kPasses) {
    if (pass.tightens &&
        !caps_->tighten(held_->close_good(), speed_, hold_mm(), FeedCaps::Speed::highest)) {
      return {};
    }
    if (pass.from == From::expected) {
      speed_ = expected_speed(path_, first_->speed, inverse_.lag_s(),
                              [this](double at_mm) { return caps_->most_mm_s(at_mm); });
    } else if (pass.from == From::rounds) {
      speed_ = first;
      // A refused text ends these rounds only: a later pass may do better.
      for (int i = 0; i < kShapingRounds && try_pieces(coarse_pieces()); ++i) {
      }
    }
    const auto done = pass.from == From::best
                          ? hold_window_sweeps(held_->best(), kLongWindow)
                          : hold_window_sweeps(coarse_pieces(), PolishTask::kInner);
    if (!done || held_->close_good().empty()) {
      return done;
    }
  }
  return {};
}

Result<void> Predistortion::hold_window_sweeps(std::vector<Piece> pieces, std::size_t inner) {
  const TryPieces attempt = [this](const std::vector<Piece>& made) {
    return try_pieces(held_->with(made));
  };
  PolishTask task = polish_task();
  task.thorough = true;
  task.inner = inner;
  task.price.steps = kWindowSteps;
  task.price.enough_mm = kWellShaped * task.price.limit_mm;
  pieces = held_->open(std::move(pieces));
  // The best have their legs.
  const bool goes_on = inner > PolishTask::kInner;
  CornerLegs legs = goes_on ? CornerLegs({.most_mm = 0.0}) : corner_legs(task);
  Result<void> done;
  if (!goes_on) {
    done = polish_sweeps(task, pieces, legs, starts_, attempt, kToShape);
  }
  task.price.time = PolishTask::kTimeToHold;
  task.price.over = kOverLimit;
  task.price.enough_mm = task.price.aim * task.price.limit_mm;
  return done ? polish_sweeps(task, pieces, legs, starts_, attempt, kToHold) : done;
}

Result<void> Predistortion::hold_by_feeds() {
  begin_caps();
  over_ = best_over_;
  speed_ = best_speed_;
  for (int i = 0; i < kMostHolds && caps_->tighten(over_, speed_, hold_mm()); ++i) {
    if (auto done = rounds(kHoldRounds); !done) {
      return done;
    }
  }
  return {};
}

}  // namespace steadyrest::contour::offline
