// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <mutex>
#include <ranges>

#include <fmt/core.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <steadyrest/chatter/offline/cycle/reach.hpp>
#include <steadyrest/chatter/offline/depth/border_line.hpp>
#include <steadyrest/chatter/offline/depth/depth_line.hpp>
#include <steadyrest/chatter/offline/depth/limit_depth.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>

// Adaptive bisection in rounds: first_spans() puts six points on each lobe, each round evaluates
// the middles of all open spans in parallel, and halved() keeps those whose middle was off the
// line. spend() bounds the work where points are expensive.
namespace steadyrest::chatter::offline {
namespace {

using kernel::outcome::Refusal;
using kernel::outcome::refuse;
using kernel::outcome::Result;

constexpr double kOfDepth = 1e-2;  ///< tolerance
constexpr double kOfMost = 5e-4;   ///< of the greatest depth, in addition
constexpr double kNarrow = 3e-4;   ///< of a lobe's width: how closely cusps and jumps are located
constexpr double kPerLobe = 6.0;
constexpr double kFrom = 0.5;    ///< of the lowest border of all lobes, where the search begins
constexpr double kMiddle = 0.5;  ///< of the tolerance: a bow is deepest in its middle
constexpr std::size_t kQuickPoints = 20'000;
constexpr std::size_t kSlowPoints = 200;

struct Point {
  double speed_rev_s = 0.0;
  std::optional<double> depth_mm = std::nullopt;
};

/// Between two neighbours of the line.
struct Span {
  Point from;
  Point to;
  double doubt_mm = 0.0;  ///< how far the line was off there when last checked
  bool calm = false;      ///< that was within tolerance
};

class Line {
 public:
  Line(const Process& process, const BorderLineConfig& config)
      : process_(process),
        config_(config),
        arena_(config.threads == 0 ? oneapi::tbb::task_arena::automatic
                                   : static_cast<int>(config.threads)) {}

  Result<BorderLine> run(const std::function<void(double)>& progress) {
    std::vector<Point> points(config_.speed_rev_s.size());
    std::ranges::transform(config_.speed_rev_s, points.begin(),
                           [](double speed) { return Point{.speed_rev_s = speed}; });
    evaluate(points);
    // A slow cut (law, uneven pitch, process damping, helix) rebuilds its map for each depth: there
    // the number of points is the cost.
    left_ = quick_ ? kQuickPoints : std::max(kSlowPoints, points.size());
    for (std::vector<Span> open = refused_ ? std::vector<Span>{} : first_spans(points);
         !open.empty() && !refused_;) {
      spend(open);
      open = halved(open, points);
      if (progress) {
        const auto done = static_cast<double>(points.size());
        progress(done / (done + static_cast<double>(open.size())));
      }
    }
    if (refused_) {
      return std::unexpected(std::move(*refused_));
    }
    std::ranges::sort(points, {}, &Point::speed_rev_s);
    BorderLine out;
    out.settled = settled_;
    for (const Point& point : points) {
      out.speed_rev_s.push_back(point.speed_rev_s);
      out.depth_mm.push_back(point.depth_mm);
    }
    return out;
  }

 private:
  void evaluate(std::vector<Point>& points) {
    const auto one = [&](std::size_t i) {
      auto line = DepthLine::make(process_, points[i].speed_rev_s, config_.modulation,
                                  config_.most_depth_mm);
      if (line) {
        points[i].depth_mm = limit_depth_mm(*line, config_.most_depth_mm, from_mm_);
      }
      const std::scoped_lock lock(mutex_);
      quick_ = line && line->quick();
      if (!line && !refused_) {
        refused_ = line.error();
      }
    };
    arena_.execute([&] { oneapi::tbb::parallel_for(std::size_t{0}, points.size(), one); });
  }

  [[nodiscard]] double depth(const Point& point) const {
    // Stable throughout counts as the greatest depth, so that the edge of an open window is refined
    // too.
    return point.depth_mm.value_or(config_.most_depth_mm);
  }

  /// Divides the gaps between the given speeds so that each lobe gets its points.
  std::vector<Span> first_spans(std::vector<Point>& points) {
    std::vector<double> parts;
    double sum = 0.0;
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
      // One lobe is one wave more or fewer between two teeth.
      parts.push_back(kPerLobe * (free_waves(process_, points[i].speed_rev_s) -
                                  free_waves(process_, points[i + 1].speed_rev_s)));
      sum += parts.back();
    }
    // At most a quarter of the work goes into first points; the rest refines.
    const double share = std::min(1.0, 0.25 * static_cast<double>(left_) / std::max(sum, 1.0));
    std::vector<Point> more;
    for (std::size_t i = 0; i < parts.size(); ++i) {
      // Even in 1/speed: lobes are even in waves between teeth, and those go with 1/n.
      const double from = 1.0 / points[i].speed_rev_s;
      const double to = 1.0 / points[i + 1].speed_rev_s;
      const double count = std::floor(share * parts[i]);
      for (double k = 1.0; k <= count; k += 1.0) {
        more.push_back({.speed_rev_s = 1.0 / (from + (to - from) * k / (count + 1.0))});
      }
    }
    evaluate(more);
    left_ -= std::min(left_, more.size());
    points.insert(points.end(), more.begin(), more.end());
    // Only once every lobe has been seen: otherwise the lowest might be missing and the search
    // would begin above it.
    if (share == 1.0) {
      from_mm_ =
          kFrom * std::ranges::min(points | std::views::transform([this](const Point& point) {
                                     return depth(point);
                                   }));
    }
    std::ranges::sort(points, {}, &Point::speed_rev_s);
    std::vector<Span> out;
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
      out.push_back({.from = points[i],
                     .to = points[i + 1],
                     .doubt_mm = std::abs(depth(points[i]) - depth(points[i + 1]))});
    }
    return out;
  }

  /// Keeps only the worst spans, as many as the remaining work allows.
  void spend(std::vector<Span>& open) {
    if (open.size() > left_) {
      settled_ = false;
      // The worst first, so that the spans left unrefined are the least visible.
      std::ranges::sort(open, std::ranges::greater{}, &Span::doubt_mm);
      open.resize(left_);
    }
    left_ -= open.size();
  }

  /// The spans still open once the middles are known.
  std::vector<Span> halved(const std::vector<Span>& open, std::vector<Point>& points) {
    std::vector<Point> middles;
    middles.reserve(open.size());
    for (const Span& span : open) {
      middles.push_back({.speed_rev_s = 0.5 * (span.from.speed_rev_s + span.to.speed_rev_s)});
    }
    evaluate(middles);
    points.insert(points.end(), middles.begin(), middles.end());
    std::vector<Span> out;
    for (std::size_t i = 0; i < open.size(); ++i) {
      const Span& span = open[i];
      const double there = depth(middles[i]);
      const double off = std::abs(there - 0.5 * (depth(span.from) + depth(span.to)));
      const bool calm = off <= kMiddle * (kOfDepth * there + kOfMost * config_.most_depth_mm);
      const double width = span.to.speed_rev_s - span.from.speed_rev_s;
      // One wave between two teeth spans n/k of the speed at k waves.
      const double lobe =
          span.to.speed_rev_s / std::max(1.0, free_waves(process_, span.to.speed_rev_s));
      // One middle within tolerance may be chance, where the line happens to cross the border; two
      // in a row are not. A jump onto an island never calms down, so it ends by width.
      if ((calm && span.calm) || width <= kNarrow * lobe) {
        continue;
      }
      out.push_back({span.from, middles[i], off, calm});
      out.push_back({middles[i], span.to, off, calm});
    }
    return out;
  }

  const Process& process_;
  const BorderLineConfig& config_;
  oneapi::tbb::task_arena arena_;
  std::mutex mutex_;
  std::optional<Refusal> refused_;
  bool quick_ = true;
  bool settled_ = true;
  double from_mm_ = 0.0;
  std::size_t left_ = 0;  ///< points that may still be computed
};

}  // namespace

Result<BorderLine> border_line(const Process& process, const BorderLineConfig& config,
                               const std::function<void(double)>& progress) {
  const std::vector<double>& speed = config.speed_rev_s;
  const bool rises = std::ranges::adjacent_find(speed, std::ranges::greater_equal{}) == speed.end();
  if (speed.empty() || !rises) {
    return refuse("the border speeds are not in rising order",
                  "give one speed or more, in rising order");
  }
  return Line(process, config).run(progress);
}

}  // namespace steadyrest::chatter::offline
