// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <steadyrest/contour/offline/predistort/hold/held_stretches.hpp>
#include <steadyrest/contour/offline/predistort/polish/chain_window.hpp>
#include <steadyrest/math/geometry/vector.hpp>

namespace steadyrest::contour::offline {
namespace {

constexpr double kOverSecond = 10.0;  ///< price of a second over the limit …
constexpr double kFarSecond = 20.0;   ///< … and of (ε/L)² − 1 for a second
constexpr double kEarlyShare = 2e-3;  ///< share of it for what a rapid has left

constexpr double kHarm_s = 1e4;
constexpr double kSameEnd_mm = 1e-3;  ///< beyond it the proof refuses the text
constexpr double kBrought_mm = 5.0;   ///< behind a stop

double middle_mm(const Piece& piece) noexcept {
  return 0.5 * (piece.progress_start_mm + piece.progress_end_mm);
}

}  // namespace

HeldStretches::HeldStretches(const nc::plan::PlannedPath& path, const std::vector<SegmentUse>& use,
                             double limit_mm, Price price)
    : limit_mm_(limit_mm), price_(price) {
  for (std::size_t i = 0; i < use.size(); ++i) {
    if (!use[i].free) {
      continue;
    }
    const auto& segment = path.segments[i];
    if (i == 0 || !use[i - 1].free || use[i - 1].stops) {
      stretches_.emplace_back().from_mm = segment.position_mm;
      stretches_.back().joined = i > 0 && use[i - 1].free;
    }
    stretches_.back().to_mm = segment.position_mm + segment.length_mm;
    stretches_.back().end_mm = segment.end_mm;
  }
}

std::size_t HeldStretches::of(double at_mm) const noexcept {
  const auto found = std::ranges::lower_bound(stretches_, at_mm, {}, &Stretch::to_mm);
  return found != stretches_.end() && found->from_mm <= at_mm
             ? static_cast<std::size_t>(found - stretches_.begin())
             : stretches_.size();
}

void HeldStretches::charge(std::vector<double>& costs, double foot_mm, double cost_s) const {
  const std::size_t at = of(foot_mm);
  costs[at] += cost_s;
  if (at > 0 && at < stretches_.size() && stretches_[at].joined &&
      foot_mm < stretches_[at].from_mm + kBrought_mm) {
    costs[at - 1] += cost_s;
  }
}

std::vector<double> HeldStretches::costs_s(const FollowedRun& run) const {
  std::vector<double> out(stretches_.size() + 1, 0.0);
  const double period_s =
      run.seconds / static_cast<double>(std::max<std::size_t>(1, run.errors.size()));
  const bool all = price_ == Price::all_errors;
  for (const ErrorSample& sample : run.errors) {
    out[of(sample.foot_mm)] += (all ? ChainPrice{}.time : 1.0) * period_s;
    if (all && sample.valid) {
      const double ratio = math::geometry::norm(sample.off_mm) / limit_mm_;
      charge(out, sample.foot_mm, period_s * ratio * ratio);
    }
  }
  for (const ErrorPlace& place : run.over) {
    const double ratio = place.error_mm / limit_mm_;
    charge(out, place.foot_mm,
           (place.early ? kEarlyShare : 1.0) * period_s *
               (kOverSecond + kFarSecond * std::max(0.0, ratio * ratio - 1.0)));
  }
  return out;
}

double HeldStretches::cost_s(const FollowedRun& run) const {
  const auto all = costs_s(run);
  double out = 0.0;
  for (std::size_t i = 0; i < stretches_.size(); ++i) {
    out += all[i];
  }
  return out;
}

void HeldStretches::note(const std::vector<Piece>& pieces, const FollowedRun& run,
                         const std::vector<double>& harmed_mm, By by) {
  auto costs = costs_s(run);
  std::vector<std::vector<Piece>> parts(stretches_.size() + 1);
  for (const Piece& piece : pieces) {
    parts[of(middle_mm(piece))].push_back(piece);
  }
  std::vector<std::vector<ErrorPlace>> left(stretches_.size() + 1);
  for (const ErrorPlace& place : run.over) {
    left[of(place.foot_mm)].push_back(place);
  }
  std::vector<bool> harmed(stretches_.size() + 1, false);
  for (const double at_mm : harmed_mm) {
    harmed[of(at_mm)] = true;
  }
  open_cost_s_ = 0.0;
  for (std::size_t i = 0; i < stretches_.size(); ++i) {
    Stretch& stretch = stretches_[i];
    open_cost_s_ += stretch.open ? costs[i] : 0.0;
    const bool arrives =
        parts[i].empty() ||
        math::geometry::distance(parts[i].back().segment.end_mm, stretch.end_mm) < kSameEnd_mm;
    costs[i] += harmed[i] || !arrives ? kHarm_s : 0.0;
    if (by == By::windows && stretch.open && costs[i] < stretch.windows_s) {
      stretch.windows_s = costs[i];
      stretch.left = std::move(left[i]);
    }
    if (by == By::feeds && costs[i] < stretch.feeds_s) {
      stretch.feeds_s = costs[i];
      stretch.by_feeds = parts[i];
    }
    if (costs[i] < stretch.cost_s && !stretch.given_up) {
      stretch.cost_s = costs[i];
      stretch.pieces = std::move(parts[i]);
    }
  }
}

bool HeldStretches::give_up_windows(double at_mm) {
  // Where a block that stays is refused, what is before it does not end there.
  const auto behind = std::ranges::upper_bound(stretches_, at_mm, {}, &Stretch::from_mm);
  const std::size_t i = behind == stretches_.begin()
                            ? stretches_.size()
                            : static_cast<std::size_t>(behind - stretches_.begin()) - 1;
  if (i == stretches_.size() || stretches_[i].given_up) {
    return false;
  }
  stretches_[i].given_up = true;
  stretches_[i].cost_s = stretches_[i].feeds_s;
  stretches_[i].pieces = stretches_[i].by_feeds;
  return true;
}

std::vector<Piece> HeldStretches::best() const {
  std::vector<Piece> out;
  for (const Stretch& stretch : stretches_) {
    out.insert(out.end(), stretch.pieces.begin(), stretch.pieces.end());
  }
  return out;
}

std::vector<Piece> HeldStretches::with(const std::vector<Piece>& made) const {
  std::vector<Piece> out;
  auto next = made.begin();
  for (std::size_t i = 0; i < stretches_.size(); ++i) {
    const Stretch& stretch = stretches_[i];
    const auto first = next;
    while (next != made.end() && of(middle_mm(*next)) <= i) {
      ++next;
    }
    if (stretch.open) {
      out.insert(out.end(), first, next);
    } else {
      out.insert(out.end(), stretch.pieces.begin(), stretch.pieces.end());
    }
  }
  return out;
}

std::vector<Piece> HeldStretches::open(std::vector<Piece> pieces) const {
  std::erase_if(pieces, [&](const Piece& piece) {
    const std::size_t i = of(middle_mm(piece));
    return i == stretches_.size() || !stretches_[i].open;
  });
  return pieces;
}

std::vector<ErrorPlace> HeldStretches::close_good() {
  std::vector<ErrorPlace> out;
  for (Stretch& stretch : stretches_) {
    stretch.open = stretch.open && std::ranges::any_of(stretch.left, [](const ErrorPlace& place) {
                     return !place.early;
                   });
    if (stretch.open) {
      out.insert(out.end(), stretch.left.begin(), stretch.left.end());
    }
  }
  return out;
}

double HeldStretches::cost_s() const {
  double out = 0.0;
  for (const Stretch& stretch : stretches_) {
    out += stretch.cost_s;
  }
  return out;
}

}  // namespace steadyrest::contour::offline
