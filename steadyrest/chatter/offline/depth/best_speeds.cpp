// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <iterator>

#include <steadyrest/chatter/offline/cycle/reach.hpp>
#include <steadyrest/chatter/offline/depth/best_speeds.hpp>
#include <steadyrest/chatter/offline/depth/border_line.hpp>
#include <steadyrest/chatter/offline/depth/limit_depth.hpp>

// border_line() gives the border as a curve; a speed's worth is the curve's minimum within the
// tolerance about it; take_peak() then removes maxima from that second curve, the highest first,
// each with its slopes, so that the next one comes from another lobe.
namespace steadyrest::chatter::offline {
namespace {

using kernel::outcome::Result;

// At 25 waves a lobe is 4 % of the speed wide; with frequencies known to 1 % nobody can aim at it.
constexpr double kMostUsefulWaves = 25.0;
constexpr double kLeastRange = 0.8;  ///< of the greatest speed, where all lobes are narrow
constexpr double kNextSpeed = 1.2;
constexpr double kFall = 0.98;  ///< between two maxima
constexpr double kSameDepth = 1e-6;

/// Border over speed; the greatest depth where there is none.
class Curve {
 public:
  Curve(const BorderLine& line, double most_mm) : speed_rev_s_(line.speed_rev_s) {
    for (const auto& depth : line.depth_mm) {
      depth_mm_.push_back(depth.value_or(most_mm));
    }
  }

  [[nodiscard]] double at(double speed_rev_s) const {
    const std::size_t i = std::clamp<std::size_t>(after(speed_rev_s), 1, speed_rev_s_.size() - 1);
    const double share =
        (speed_rev_s - speed_rev_s_[i - 1]) / (speed_rev_s_[i] - speed_rev_s_[i - 1]);
    return std::lerp(depth_mm_[i - 1], depth_mm_[i], std::clamp(share, 0.0, 1.0));
  }

  [[nodiscard]] double lowest(double from_rev_s, double to_rev_s) const {
    double out = std::min(at(from_rev_s), at(to_rev_s));
    for (std::size_t i = after(from_rev_s); i < speed_rev_s_.size() && speed_rev_s_[i] <= to_rev_s;
         ++i) {
      out = std::min(out, depth_mm_[i]);
    }
    return out;
  }

 private:
  [[nodiscard]] std::size_t after(double speed_rev_s) const {
    return static_cast<std::size_t>(std::ranges::lower_bound(speed_rev_s_, speed_rev_s) -
                                    speed_rev_s_.begin());
  }

  std::vector<double> speed_rev_s_;
  std::vector<double> depth_mm_;
};

/// The slowest speed worth considering; empty: the solver reaches none.
std::optional<double> slowest(const Process& process, const BestSpeedsConfig& config) {
  // Waves go with 1/n: at this speed there are kMostUsefulWaves between two teeth.
  const double lobes = free_waves(process, config.max_rev_s) / kMostUsefulWaves * config.max_rev_s;
  double out = std::max(config.min_rev_s, std::min(lobes, kLeastRange * config.max_rev_s));
  while (out < config.max_rev_s &&
         beyond_reach(process, (1.0 - config.tolerance_ratio) * out, config.most_depth_mm)) {
    out *= kNextSpeed;
  }
  return out < config.max_rev_s ? std::optional(out) : std::nullopt;
}

/// A maximum from its first to its last index, with its slopes.
struct Peak {
  std::size_t first = 0;
  std::size_t last = 0;
};

/// The highest one left; of equals the last. Removes it and its slopes from `left`.
std::optional<Peak> take_peak(const std::vector<double>& worth, std::vector<bool>& left) {
  std::optional<std::size_t> top;
  for (std::size_t i = 0; i < worth.size(); ++i) {
    if (left[i] && (!top || worth[i] >= worth[*top])) {
      top = i;
    }
  }
  if (!top) {
    return std::nullopt;
  }
  Peak out{*top, *top};
  const auto slope = [&](auto next, std::size_t& flat_end) {
    double lowest = worth[*top];
    bool flat = true;
    for (std::size_t i = next(*top); i < worth.size() && left[i] && worth[i] * kFall <= lowest;
         i = next(i)) {
      flat = flat && worth[i] >= worth[*top] * (1.0 - kSameDepth);
      flat_end = flat ? i : flat_end;
      lowest = std::min(lowest, worth[i]);
      left[i] = false;
    }
  };
  slope([](std::size_t i) { return i - 1; }, out.first);  // below 0 it wraps to beyond the end
  slope([](std::size_t i) { return i + 1; }, out.last);
  left[*top] = false;
  return out;
}

}  // namespace

Result<std::vector<BestSpeed>> best_speeds(const Process& process, const BestSpeedsConfig& config) {
  const auto from = slowest(process, config);
  if (!from) {
    return std::vector<BestSpeed>{};
  }
  const double low = 1.0 - config.tolerance_ratio;
  const double high = 1.0 + config.tolerance_ratio;
  // Beyond both ends by the tolerance, since the minimum about the last speed reaches that far.
  const auto line = border_line(process, {.speed_rev_s = {*from * low, config.max_rev_s * high},
                                          .most_depth_mm = config.most_depth_mm,
                                          .modulation = {}});
  if (!line) {
    return std::unexpected(line.error());
  }
  const Curve curve(*line, config.most_depth_mm);
  std::vector<double> speed{*from};
  // The points of the border are dense where it bends, and maxima lie at such points.
  std::ranges::copy_if(line->speed_rev_s, std::back_inserter(speed),
                       [&](double n) { return n > *from && n < config.max_rev_s; });
  speed.push_back(config.max_rev_s);
  std::vector<double> worth;
  worth.reserve(speed.size());
  for (const double n : speed) {
    // Changing all natural frequencies by a factor amounts to changing the speed by it.
    worth.push_back(curve.lowest(n * low, n * high));
  }
  // The curve shows "no border" as the greatest depth; the caller must not mistake that for a
  // border.
  const auto below_most = [&](double depth_mm) {
    return depth_mm < config.most_depth_mm * (1.0 - kSameDepth) ? std::optional(depth_mm)
                                                                : std::nullopt;
  };
  std::vector<BestSpeed> out;
  std::vector<bool> left(speed.size(), true);
  while (out.size() < config.most) {
    const auto peak = take_peak(worth, left);
    if (!peak) {
      break;
    }
    // The middle of a flat top, farthest from both flanks.
    const double n = 0.5 * (speed[peak->first] + speed[peak->last]);
    const auto limit = limit_depth_mm(process, n, {}, config.most_depth_mm);
    if (!limit) {
      return std::unexpected(limit.error());
    }
    out.push_back({n, *limit, below_most(curve.lowest(n * low, n * high))});
  }
  return out;
}

}  // namespace steadyrest::chatter::offline
