// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/core.h>

#include <steadyrest/math/geometry/vector.hpp>
#include <steadyrest/nc/plan/path/piece.hpp>
#include <steadyrest/nc/rewrite/prove/compare.hpp>
#include <steadyrest/nc/rewrite/tube/stretch.hpp>

namespace steadyrest::nc::rewrite {
namespace {

namespace geometry = math::geometry;
using geometry::ChordRange;
using interpret::Move;
using interpret::MoveKind;
using kernel::signal::PathSegment;
using kernel::signal::Point;

constexpr double kReachTubes = 4.0;
constexpr double kLongestLag_s = 0.1;  ///< of a servo whose gain is 10 1/s
constexpr double kFirstSlack_ratio = 1.0 / 64.0;
constexpr double kFirstSlack_mm = 1e-3;
constexpr double kFiner = 1.0 / 16.0;
constexpr std::uint8_t kRefinements = 2;
/// Pieces about a place that count as near it; each time more are refined at once, so that a path
/// that is near the tube's edge everywhere needs few rounds.
constexpr std::size_t kNearPieces = 256;

double distance_to_chord(const Point& point, const Point& a, const Point& b) noexcept {
  const Point way = geometry::subtract(b, a);
  const double way2 = geometry::norm_squared(way);
  const double t = way2 > 0.0 ? geometry::dot(geometry::subtract(point, a), way) / way2 : 0.0;
  return geometry::distance(point, geometry::add_scaled(a, way, std::clamp(t, 0.0, 1.0)));
}

/// The nearest of the chords first … last.
double distance_to(const geometry::ChordPath& path, const Point& point, std::size_t first,
                   std::size_t last) noexcept {
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = first; i <= std::min(last, path.size() - 1); ++i) {
    nearest = std::min(nearest, distance_to_chord(point, path.points[i], path.points[i + 1]));
  }
  return nearest;
}

}  // namespace

Point machine_point(const Move& move, const interpret::Axes& work) noexcept {
  const interpret::Axes machine = interpret::machine_of(move, work);
  return {machine[0], machine[1], machine[2]};
}

void Stretch::Path::clear(const Point& start) {
  start_mm = start;
  pieces.clear();
  arcs.clear();
}

void Stretch::Path::add_line(const Point& end, std::uint32_t line, std::uint32_t block) {
  pieces.push_back({.end_mm = end, .line = line, .block = block, .arc = 0, .finer = 0});
}

void Stretch::Path::add(const Move& move, std::uint32_t block) {
  const Point from = machine_point(move, move.start);
  // Where an offset changed in between, the control may start elsewhere than it ended.
  if (geometry::distance(from, end()) > kSame_mm) {
    add_line(from, move.line, block);
  }
  add_line(machine_point(move, move.end), move.line, block);
  if (move.kind == MoveKind::arc) {
    PathSegment segment;
    segment.start_mm = from;
    segment.end_mm = pieces.back().end_mm;
    plan::set_arc(segment, move);
    arcs.push_back(segment);
    pieces.back().arc = static_cast<std::uint32_t>(arcs.size());
  }
}

bool Stretch::Path::refine(std::size_t piece, std::size_t around) {
  const auto span_of = [&](std::size_t width) {
    const std::size_t first = piece > width ? piece - width : 0;
    return std::pair(first, std::min(pieces.size(), piece + width + 1));
  };
  std::uint8_t least = kRefinements;
  const auto [near_first, near_end] = span_of(kNearPieces);
  for (std::size_t i = near_first; i < near_end; ++i) {
    least = pieces[i].arc == 0 ? least : std::min(least, pieces[i].finer);
  }
  const auto [first, end] = span_of(around);
  for (std::size_t i = first; i < end && least < kRefinements; ++i) {
    pieces[i].finer = std::max<std::uint8_t>(pieces[i].finer, least + 1);
  }
  return least < kRefinements;
}

void Stretch::begin(const Point& original_mm, const Point& changed_mm) {
  open_ = true;
  original_.clear(original_mm);
  changed_.clear(changed_mm);
  feed_mm_s_.clear();
}

void Stretch::block(const Move& move) {
  feed_mm_s_.push_back(move.feed_mode == interpret::FeedMode::per_revolution
                           ? move.feed_mm_s * std::abs(move.spindle_rev_s)
                           : move.feed_mm_s);
  original_.add(move, static_cast<std::uint32_t>(feed_mm_s_.size() - 1));
}

void Stretch::fresh(const Move& move) {
  changed_.add(move, static_cast<std::uint32_t>(feed_mm_s_.size() - 1));
}

Stretch::Chords Stretch::chords_of(const Path& path, double slack_mm) {
  Chords out;
  out.path.points.push_back(path.start_mm);
  for (std::size_t i = 0; i < path.pieces.size(); ++i) {
    const Piece& piece = path.pieces[i];
    PathSegment line;
    line.end_mm = piece.end_mm;
    out.path.add(piece.arc == 0 ? line : path.arcs[piece.arc - 1],
                 slack_mm * std::pow(kFiner, piece.finer));
    out.piece.resize(out.path.size(), static_cast<std::uint32_t>(i));
  }
  if (out.path.size() == 0) {  // nothing moves: the point itself
    out.path.points.push_back(path.start_mm);
    out.path.slack_mm.push_back(0.0);
    out.piece.push_back(0);
  }
  return out;
}

std::vector<ChordRange> Stretch::permitted(const Chords& original, const Chords& changed) const {
  // Where each chord of the original begins, and each block; path length.
  std::vector<double> at(original.path.size() + 1, 0.0);
  std::vector<double> begins(feed_mm_s_.size() + 1, std::numeric_limits<double>::infinity());
  for (std::size_t j = 0; j < original.path.size(); ++j) {
    at[j + 1] = at[j] + geometry::distance(original.path.points[j], original.path.points[j + 1]);
    const std::size_t block =
        original_.pieces.empty() ? 0 : original_.pieces[original.piece[j]].block;
    begins[block] = std::min(begins[block], at[j]);
  }
  begins.back() = at.back();
  std::vector<ChordRange> out;
  out.reserve(changed.path.size());
  const auto chord_at = [&](double mm) {
    const auto after = std::ranges::upper_bound(at, mm) - at.begin();
    return static_cast<std::uint32_t>(std::clamp<std::ptrdiff_t>(after - 1, 0, std::ssize(at) - 2));
  };
  for (std::size_t i = 0; i < changed.path.size(); ++i) {
    const std::size_t block = changed_.pieces.empty() ? 0 : changed_.pieces[changed.piece[i]].block;
    const double reach = kReachTubes * tube_mm_ + kLongestLag_s * feed_mm_s_[block];
    out.push_back({chord_at(begins[block] - reach), chord_at(begins[block + 1] + reach)});
  }
  return out;
}

/// The new moves are the original's: nothing to be proved.
bool Stretch::same() const noexcept {
  const auto near = [](const Point& a, const Point& b) {
    return geometry::distance(a, b) <= kSame_mm;
  };
  if (original_.pieces.size() != changed_.pieces.size() ||
      !near(original_.start_mm, changed_.start_mm)) {
    return false;
  }
  return std::ranges::equal(original_.pieces, changed_.pieces, [&](const Piece& a, const Piece& b) {
    if (!near(a.end_mm, b.end_mm) || a.block != b.block || (a.arc == 0) != (b.arc == 0)) {
      return false;
    }
    if (a.arc == 0) {
      return true;
    }
    const PathSegment& x = original_.arcs[a.arc - 1];
    const PathSegment& y = changed_.arcs[b.arc - 1];
    return near(x.centre_mm, y.centre_mm) && x.axis == y.axis &&
           std::abs(x.sweep_rad - y.sweep_rad) <= kSame_mm;
  });
}

Stretch::Fault Stretch::fault(const Chords& original, const Chords& changed,
                              const geometry::TubeVerdict& verdict) const {
  const std::size_t i = verdict.changed;
  const std::size_t j = verdict.original;
  const auto line_of = [](const Path& path, const Chords& chords, std::size_t chord) {
    return path.pieces.empty() ? 0U : path.pieces[chords.piece[chord]].line;
  };
  const std::uint32_t line = line_of(changed_, changed, i);
  const std::uint32_t original_line = line_of(original_, original, j);
  const ChordRange range = permitted(original, changed)[i];
  const Point& new_end = changed.path.points[i + 1];
  const double out_mm = distance_to(original.path, new_end, range.first, range.last);
  if (out_mm > tube_mm_ - kSame_mm - original.path.slack_mm[j]) {
    return {.of_original = false,
            .line = line,
            .what = fmt::format("is {:.6f} mm from the original's path there (near its line {}); "
                                "the tube is {:g} mm",
                                out_mm, original_line, tube_mm_)};
  }
  constexpr std::size_t kAround = 64;
  const Point& next = original.path.points[j + 1];
  const double left_mm =
      distance_to(changed.path, next, i > kAround ? i - kAround : 0, i + kAround);
  if (left_mm > tube_mm_ - kSame_mm - changed.path.slack_mm[i]) {
    return {.of_original = true,
            .line = original_line,
            .what = fmt::format("is left out by {:.6f} mm at X{:.4f} Y{:.4f} Z{:.4f} (machine "
                                "coordinates); the tube is {:g} mm",
                                left_mm, next[0], next[1], next[2], tube_mm_)};
  }
  return {.of_original = false,
          .line = line,
          .what = fmt::format("does not follow the original's path in its order within the tube of "
                              "{:g} mm (near its line {}): it turns back, is ahead of its block or "
                              "leaves something out",
                              tube_mm_, original_line)};
}

std::optional<Stretch::Fault> Stretch::close() {
  if (!std::exchange(open_, false) || same()) {
    return std::nullopt;
  }
  const double slack_mm = std::min(kFirstSlack_mm, kFirstSlack_ratio * tube_mm_);
  for (std::size_t around = kNearPieces;; around *= 2) {
    const Chords original = chords_of(original_, slack_mm);
    const Chords changed = chords_of(changed_, slack_mm);
    const auto verdict =
        geometry::walk_tube(changed.path, original.path, permitted(original, changed), tube_mm_);
    if (verdict.inside) {
      if (verdict.farthest_mm > farthest_mm_ && !changed_.pieces.empty()) {
        farthest_mm_ = verdict.farthest_mm;
        farthest_line_ = changed_.pieces[changed.piece[verdict.farthest_changed]].line;
      }
      return std::nullopt;
    }
    const bool one = original_.refine(original.piece[verdict.original], around);
    const bool other = changed_.refine(changed.piece[verdict.changed], around);
    if (!one && !other) {
      return fault(original, changed, verdict);
    }
  }
}

}  // namespace steadyrest::nc::rewrite
