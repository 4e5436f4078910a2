// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include <steadyrest/contour/offline/predistort/polish/chain_bounds.hpp>
#include <steadyrest/contour/offline/predistort/polish/chain_link.hpp>
#include <steadyrest/contour/offline/predistort/polish/polish.hpp>
#include <steadyrest/kernel/units/constants.hpp>
#include <steadyrest/math/geometry/path_pairing.hpp>
#include <steadyrest/math/geometry/segment.hpp>
#include <steadyrest/math/geometry/vector.hpp>
#include <steadyrest/nc/plan/path/limits.hpp>

namespace steadyrest::contour::offline {
namespace {

namespace geometry = math::geometry;
using kernel::signal::Point;

constexpr double kSmoothBend_rad = 2e-3;
constexpr double kTakenBend_rad = 0.15;  ///< that a window takes away
constexpr double kSameStart_mm = 1e-3;
constexpr double kSamePoint_mm = 1e-6;
constexpr double kNearBlock_mm = 5.0;  ///< the last sample before a block is nearer
constexpr double kSlow = 0.3;          ///< of the feed, at most, before a stop
constexpr double kForget = 5.0;        ///< in time constants of the softest axis
constexpr double kSampleOfLag = 0.1;   ///< between two samples, in 1/k
constexpr double kRamp_s = 0.05;       ///< of the speed
constexpr std::size_t kBetweenProgress = 64;
constexpr double kNotAll = 0.99;
constexpr double kMostSamples = 2e7;     ///< of a sweep …
constexpr double kSamplesEach = 1000.0;  ///< … and for each that the program itself has
constexpr double kTimeAtCorners = 3.0;   ///< times its price: a slow corner is always better
constexpr double kLevel = 0.2;           ///< of the limit: the height of a joint

double slope_of(const kernel::signal::PathSegment& segment, nc::interpret::Plane plane) {
  const Point tangent = geometry::station_at(segment, 0.5).tangent;
  const auto axes = nc::interpret::axes_of(plane);
  const double flat = std::hypot(tangent[axes.first], tangent[axes.second]);
  return flat > 0.0 ? tangent[axes.normal] / flat : 0.0;
}

class Sweep {
 public:
  Sweep(const PolishTask& task, const std::vector<BlockStart>& starts)
      : task_(task),
        block_starts_(starts),
        bounds_({.path = task.path,
                 .most_shift_mm = task.most_shift_mm,
                 .gain_1_s = softest_gain_1_s(task.models)}),
        gain_1_s_(softest_gain_1_s(task.models)),
        forget_s_(kForget / gain_1_s_),
        every_(static_cast<std::size_t>(
            std::max(1.0, kSampleOfLag / gain_1_s_ / task.machine.control.interpolator_period_s))),
        period_s_(task.machine.control.interpolator_period_s * static_cast<double>(every_)) {
    const nc::plan::PathLimits limits(task.machine.axes, task.machine.control);
    lead_s_ = forget_s_ + 2.0 * limits.jerk_time_s() + 2.0 * kRamp_s;
    back_s_ = kRamp_s + limits.jerk_time_s();
    double program_s = 0.0;
    for (const auto& segment : task.path.segments) {
      program_s += segment.feed_mm_s > 0.0 ? segment.length_mm / segment.feed_mm_s : 0.0;
    }
    most_samples_ = static_cast<std::size_t>(
        std::min(kMostSamples, kSamplesEach * (1.0 + program_s / period_s_)));
  }

  std::vector<Piece> run(const std::vector<Piece>& pieces) {
    for (const Piece& piece : pieces) {
      if (done_++ % kBetweenProgress == 0) {
        task_.progress(kNotAll * static_cast<double>(done_) / static_cast<double>(pieces.size()));
      }
      auto made = flat(piece);
      if (made) {
        const kernel::signal::PathSegment& original = original_of(piece);
        made->programmed_mm_s = original.feed_mm_s;
        made->original_slope = slope_of(original, piece.plane);
      }
      const bool goes_on = made && !chain_.empty() && follows(piece);
      if (!goes_on) {
        finish();
      }
      if (!made) {
        out_.push_back(piece);
        continue;
      }
      if (goes_on) {
        const PlanarArc& before = chain_.back().piece.arc;
        const double bend =
            std::remainder(along(before, before.length_mm).angle_rad - made->arc.start.angle_rad,
                           kernel::units::kTurn);
        made->smooth = std::abs(bend) < (task_.thorough ? kTakenBend_rad : kSmoothBend_rad);
      }
      chain_.push_back({*made, piece});
    }
    finish();
    task_.progress(1.0);
    return std::move(out_);
  }

 private:
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

  [[nodiscard]] bool follows(const Piece& piece) const {
    const Piece& before = chain_.back().of;
    return !piece.begins_run && (piece.joined || piece.passes) && piece.plane == before.plane &&
           geometry::distance(before.segment.end_mm, piece.segment.start_mm) < kSamePoint_mm;
  }

  [[nodiscard]] const kernel::signal::PathSegment& original_of(const Piece& piece) const {
    const auto& segments = task_.path.segments;
    const double middle_mm = 0.5 * (piece.progress_start_mm + piece.progress_end_mm);
    return segments[geometry::segment_at(segments, middle_mm)];
  }

  void level_chain() {
    std::vector<ChainPiece> all;
    all.reserve(chain_.size());
    for (const Link& link : chain_) {
      all.push_back(link.piece);
    }
    level(all, kLevel * task_.price.limit_mm, task_.thorough);
    for (std::size_t i = 0; i < all.size(); ++i) {
      chain_[i].piece = all[i];
    }
  }

  void finish() {
    if (!chain_.empty()) {
      level_chain();
      ChainMotion motion(task_.machine, chain_.front().of.plane, every_);
      Point normal{};
      normal[nc::interpret::axes_of(chain_.front().of.plane).normal] = 1.0;
      ChainError error({.models = task_.models,
                        .backlash_mm = backlash_mm(task_.machine.axes),
                        .period_s = period_s_,
                        .normal = normal,
                        .unknown = task_.unknown},
                       task_.path.segments);
      ChainWindow window(motion, error, task_.price, period_s_, forget_s_);
      ChainPrice at_corners = task_.price;
      at_corners.time *= kTimeAtCorners;
      ChainWindow corner(motion, error, at_corners, period_s_, forget_s_);
      starts_.assign(1, start());
      stands_ = starts_[0].speed_mm_s <= standstill_mm_s(chain_.front());
      stops_ = ends_at_stop();
      if (task_.thorough) {
        divide(chain_);
      }
      while (chain_.size() < task_.inner && chain_.front().piece.arc.curvature_1_mm != 0.0) {
        chain_.push_back(chain_.back());
        halve(*std::prev(chain_.end(), 2), chain_.back());
      }
      for (std::size_t first = stands_ ? 0 : 1; first + 1 < chain_.size(); ++first) {
        if (is_corner(first)) {
          turn_corner(corner, first);
        }
        auto now = improve(window, first);
        while (now && task_.unites) {
          now = unite(window, first, *now);
        }
        if (samples_ + window.samples() + corner.samples() > most_samples_) {
          break;
        }
      }
      samples_ += window.samples() + corner.samples();
      level_chain();
    }
    for (const Link& link : chain_) {
      out_.push_back(in_space(link));
    }
    chain_.clear();
  }

  /// Behind the last piece that a window from `first` on may change.
  [[nodiscard]] std::size_t window_end(std::size_t first) const {
    const std::size_t most = std::min(first + task_.inner, chain_.size() - (stops_ ? 0 : 1));
    if (first > 0 && !chain_[first].piece.smooth) {
      return first;
    }
    std::size_t last = first + 1;
    while (last < most && chain_[last].piece.smooth) {
      ++last;
    }
    return last < chain_.size() && !chain_[last].piece.smooth ? last - 1 : last;
  }

  /// A speed that the last sample before a stop may have.
  [[nodiscard]] double standstill_mm_s(const Link& link) const {
    return std::min(period_s_ * task_.machine.control.max_path_acceleration_mm_s2,
                    kSlow * link.piece.feed_mm_s);
  }

  /// The control stops at the chain's end.
  [[nodiscard]] bool ends_at_stop() const {
    const double end_mm = chain_.back().of.progress_end_mm;
    const auto after = std::ranges::upper_bound(block_starts_, end_mm + kSameStart_mm, {},
                                                &BlockStart::progress_mm);
    return after == block_starts_.end() || after == block_starts_.begin() ||
           std::prev(after)->progress_mm < end_mm - kNearBlock_mm ||
           std::prev(after)->speed_mm_s <= standstill_mm_s(chain_.back());
  }

  [[nodiscard]] ChainWindow::Task task_of(std::size_t first, std::size_t last,
                                          std::pair<std::size_t, std::size_t> around) const {
    ChainWindow::Task task;
    for (std::size_t i = around.first; i < around.second; ++i) {
      task.chain.push_back(chain_[i].piece);
    }
    task.first = first - around.first;
    task.last = last - around.first;
    task.leaves_free = first == 0;
    task.arrives_free = last == chain_.size();
    task.start = starts_[around.first];
    task.rest_s = around.second == chain_.size() ? forget_s_ : 0.0;
    return task;
  }

  void put(const ChainWindow::Result& result, std::size_t from) {
    starts_.resize(std::max(starts_.size(), from + result.starts.size()));
    std::ranges::copy(result.starts, starts_.begin() + static_cast<std::ptrdiff_t>(from));
    for (std::size_t i = 0; i < result.chain.size(); ++i) {
      chain_[from + i].piece = result.chain[i];
    }
  }

  /// Improves the window that begins at `first` and returns its J; nullopt if there is none.
  std::optional<double> improve(ChainWindow& window, std::size_t first) {
    const std::size_t last = window_end(first);
    if (last < first + 2) {
      return std::nullopt;
    }
    const auto around = surroundings(first, last);
    const ChainWindow::Task task = task_of(first, last, around);
    const auto result = window.improve(task);
    if (!result) {
      return std::nullopt;
    }
    if (too_far(*result, around.first, first, last)) {
      return std::nullopt;
    }
    put(*result, around.first);
    put_progress(first, last, task);
    return result->after;
  }

  /// A straight piece between two bends begins here: the way back from beyond a corner, or a side
  /// of a polygon, whose ends may move as well.
  [[nodiscard]] bool is_corner(std::size_t first) const {
    return first + 2 < chain_.size() && !chain_[first + 1].piece.smooth &&
           !chain_[first + 2].piece.smooth && chain_[first + 1].piece.arc.curvature_1_mm == 0.0;
  }

  void turn_corner(ChainWindow& window, std::size_t first) {
    const std::size_t last = first + 3;
    const auto around = surroundings(first, last);
    ChainWindow::Task task = task_of(first, last, around);
    task.corner = true;
    const auto result = window.improve(task);
    if (!result || too_far(*result, around.first, first, last)) {
      return;
    }
    put(*result, around.first);
    share_progress(chain_, {first + 1, first + 2}, 0.0, task.chain[task.last - 1].arc.length_mm);
  }

  /// The window and its neighbours, in a result whose chain begins with the piece `from`. There one
  /// piece is in the place of two, `united` and the next; kNone: nowhere.
  [[nodiscard]] bool too_far(const ChainWindow::Result& result, std::size_t from, std::size_t first,
                             std::size_t last, std::size_t united = kNone) const {
    std::vector<Piece> pieces;
    for (std::size_t i = std::max<std::size_t>(1, first) - 1;
         i < std::min(last + 1, from + result.chain.size()); ++i) {
      Link link{.piece = result.chain[i - from], .of = chain_[i > united ? i + 1 : i].of};
      if (i == united) {
        link.of.progress_end_mm = chain_[i + 1].of.progress_end_mm;
      }
      pieces.push_back(in_space(link));
    }
    return bounds_.left_by(pieces);
  }

  /// Makes one piece of two that follow one another in a block, where that costs less than it is
  /// worth. Both are in the window from `first` on, whose J is `now`.
  std::optional<double> unite(ChainWindow& window, std::size_t first, double now) {
    const std::size_t last = window_end(first);
    // One arc in the place of two ends elsewhere. Within the window the arcs behind it make up for
    // that; behind the chain nothing does.
    const std::size_t most = last == chain_.size() ? last - 1 : last;
    for (std::size_t at = first; at + 1 < most && last > first + 2; ++at) {
      if (chain_[at].of.segment.line != chain_[at + 1].of.segment.line) {
        continue;
      }
      const auto around = surroundings(first, last);
      ChainWindow::Task task = task_of(first, last, around);
      ChainPiece& one = task.chain[at - around.first];
      const ChainPiece& two = task.chain[at + 1 - around.first];
      const double length = one.arc.length_mm + two.arc.length_mm;
      one.arc.curvature_1_mm = (one.arc.curvature_1_mm * one.arc.length_mm +
                                two.arc.curvature_1_mm * two.arc.length_mm) /
                               length;
      one.feed_mm_s =
          (one.feed_mm_s * one.arc.length_mm + two.feed_mm_s * two.arc.length_mm) / length;
      one.arc.length_mm = length;
      task.chain.erase(task.chain.begin() + static_cast<std::ptrdiff_t>(at + 1 - around.first));
      --task.last;
      const auto result = window.improve(task);
      if (!result || !(result->after < now + task_.price.block) ||
          too_far(*result, around.first, first, last - 1, at)) {
        continue;
      }
      chain_[at].of.progress_end_mm = chain_[at + 1].of.progress_end_mm;
      chain_.erase(chain_.begin() + static_cast<std::ptrdiff_t>(at + 1));
      starts_.resize(around.first + 1);
      put(*result, around.first);
      put_progress(first, last - 1, task);
      return result->after;
    }
    return std::nullopt;
  }

  /// How the axes are where the command comes to the chain.
  [[nodiscard]] ChainWindow::Start start() const {
    const double progress_mm = chain_.front().of.progress_start_mm;
    ChainWindow::Start out;
    out.at.axes.tool_mm = in_space(chain_.front()).segment.start_mm;
    out.at.foot_mm = progress_mm;
    const auto after = std::ranges::upper_bound(block_starts_, progress_mm + kSameStart_mm, {},
                                                &BlockStart::progress_mm);
    if (after == block_starts_.begin()) {
      return out;
    }
    const BlockStart& last = *std::prev(after);
    out.at = {.axes = last.axes, .foot_mm = last.foot_mm};
    out.speed_mm_s = last.speed_mm_s;
    out.until_s = last.speed_mm_s > 0.0
                      ? std::max(0.0, progress_mm - last.progress_mm) / last.speed_mm_s
                      : 0.0;
    return out;
  }

  /// Pieces long enough before the window for the servos to have settled, and long enough behind it
  /// for them to forget it.
  [[nodiscard]] std::pair<std::size_t, std::size_t> surroundings(std::size_t first,
                                                                 std::size_t last) const {
    const auto seconds = [&](std::size_t i) {
      const double v = chain_[i].piece.feed_mm_s;
      return v > 0.0 ? chain_[i].piece.arc.length_mm / v : forget_s_;
    };
    std::size_t from = first > 0 ? first - 1 : 0;
    for (double s = 0.5 * seconds(from); from > 0 && (s < back_s_ || from >= starts_.size());
         s += seconds(from)) {
      --from;
    }
    std::size_t to = std::min(last + 1, chain_.size());
    for (double s = 0.0; to < chain_.size() && s < lead_s_; ++to) {
      s += seconds(to);
    }
    return {from, to};
  }

  /// `before`: the task of the window, whose neighbours have changed their length.
  void put_progress(std::size_t first, std::size_t last, const ChainWindow::Task& before) {
    share_progress(chain_, {first, last},
                   before.leaves_free ? 0.0 : before.chain[before.first - 1].arc.length_mm,
                   before.arrives_free ? 0.0 : before.chain[before.last].arc.length_mm);
  }

  const PolishTask& task_;
  const std::vector<BlockStart>& block_starts_;
  ChainBounds bounds_;
  double gain_1_s_;
  double forget_s_;
  std::size_t every_;  ///< interpolator periods between two samples
  double period_s_;
  std::size_t most_samples_ = 0;
  double back_s_ = 0.0;                     ///< that a window may slow the control down before it
  double lead_s_ = 0.0;                     ///< until the servos have forgotten a window
  std::vector<ChainWindow::Start> starts_;  ///< of the chain's pieces, as far as they are known
  std::size_t done_ = 0;                    ///< pieces
  std::size_t samples_ = 0;                 ///< that windows have run through
  bool stands_ = false;                     ///< before the chain …
  bool stops_ = false;                      ///< … and at its end
  std::vector<Link> chain_;
  std::vector<Piece> out_;
};

}  // namespace

std::vector<Piece> polished(const PolishTask& task, const std::vector<BlockStart>& starts,
                            const std::vector<Piece>& pieces) {
  return Sweep(task, starts).run(pieces);
}

}  // namespace steadyrest::contour::offline
