// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>

#include <steadyrest/math/geometry/station_walk.hpp>
#include <steadyrest/math/geometry/vector.hpp>

// Row by row: cell (i, j) holds the least sum of squared distances of a walk from (0, 0). Only the
// last two rows of sums are kept, but for every cell the direction it was reached from, so that the
// walk can be traced back.
namespace steadyrest::math::geometry {

using kernel::signal::Point;

double StationWalk::cost(std::size_t i, std::size_t j) const noexcept {
  const double squared = norm_squared(subtract(changed_[i], original_[j]));
  return squared <= config_.tube_mm * config_.tube_mm ? squared : kFar;
}

/// The first point of the changed row, with as much of the original as is within its tube.
void StationWalk::begin(Row& row, Sums& sums) {
  const std::size_t last = original_.size() - 1;
  row = {0, changed_.size() == 1 ? last : std::min(last, 2 * config_.half_band), 0};
  sums.assign(row.high + 1, kFar);
  from_.assign(row.high + 1, From::nowhere);
  double sum = 0.0;
  for (std::size_t j = 0; j <= row.high; ++j) {
    sum += cost(0, j);
    sums[j] = sum;
    from_[j] = sum < kFar ? From::original : From::nowhere;
  }
  best_ = sums[0] < kFar ? 0 : original_.size();
}

void StationWalk::advance(std::size_t i, const Row& above, const Sums& sums_above, Row& row,
                          Sums& sums) {
  const std::size_t last = original_.size() - 1;
  const std::size_t half = config_.half_band;
  row.low = std::max(above.low, best_ > half ? best_ - half : 0);
  // The last point takes up whatever is left of the original.
  row.high = i + 1 == changed_.size() ? last : std::min(last, best_ + 1 + half);
  row.at = from_.size();
  from_.resize(row.at + row.high - row.low + 1, From::nowhere);
  sums.assign(row.high - row.low + 1, kFar);
  const auto up = [&](std::size_t j) {
    return j >= above.low && j <= above.high ? sums_above[j - above.low] : kFar;
  };
  best_ = original_.size();
  double least = kFar;
  for (std::size_t j = row.low; j <= row.high; ++j) {
    const double here = cost(i, j);
    if (here == kFar) {
      continue;
    }
    const std::size_t k = j - row.low;
    // Both advance unless one of them waiting is better: equal paths pair point by point.
    double before = j > 0 ? up(j - 1) : kFar;
    From from = From::both;
    if (up(j) < before) {
      before = up(j);
      from = From::changed;
    }
    if (k > 0 && sums[k - 1] < before) {
      before = sums[k - 1];
      from = From::original;
    }
    if (before == kFar) {
      continue;
    }
    sums[k] = before + here;
    from_[row.at + k] = from;
    if (sums[k] < least) {
      least = sums[k];
      best_ = j;
    }
  }
}

StationWalk::StationWalk(std::span<const Point> changed, std::span<const Point> original,
                         const Config& config)
    : changed_(changed), original_(original), config_(config) {
  Sums sums;
  Sums above_sums;
  rows_.reserve(changed.size());
  begin(rows_.emplace_back(), sums);
  for (std::size_t i = 1; i < changed.size() && best_ < original.size(); ++i) {
    const std::size_t best_above = best_;
    std::swap(sums, above_sums);
    const Row above = rows_.back();
    advance(i, above, above_sums, rows_.emplace_back(), sums);
    if (best_ == original.size()) {
      stop_ = {i, std::min(best_above + 1, original.size() - 1), false};
      return;
    }
  }
  if (best_ == original.size()) {
    return;  // the first points are too far apart
  }
  const Row& row = rows_.back();
  found_ = row.high + 1 == original.size() && sums.back() < kFar;
  if (!found_) {
    std::size_t reached = row.high;
    while (reached > row.low && sums[reached - row.low] == kFar) {
      --reached;
    }
    stop_ = {changed.size() - 1, std::min(reached + 1, original.size() - 1), true};
  }
}

std::vector<StationWalk::Range> StationWalk::ranges() const {
  std::vector<Range> out(changed_.size());
  std::size_t i = changed_.size() - 1;
  std::size_t j = original_.size() - 1;
  out[i].last = j;
  while (i > 0) {
    const From from = from_[rows_[i].at + j - rows_[i].low];
    if (from == From::original) {
      --j;
      continue;
    }
    out[i].first = j;
    j -= from == From::both ? 1 : 0;
    --i;
    out[i].last = j;
  }
  return out;
}

}  // namespace steadyrest::math::geometry
