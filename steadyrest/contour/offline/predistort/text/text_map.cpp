// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include <steadyrest/contour/offline/predistort/text/text_map.hpp>
#include <steadyrest/kernel/units/constants.hpp>
#include <steadyrest/math/geometry/foot_point.hpp>
#include <steadyrest/math/geometry/segment.hpp>
#include <steadyrest/math/geometry/vector.hpp>

namespace steadyrest::contour::offline {
namespace {

namespace geometry = math::geometry;
using kernel::signal::Geometry;
using kernel::signal::PathSegment;
using kernel::signal::Point;

/// Original path lengths at the ends of each segment of the changed path.
class Mapping {
 public:
  Mapping(const std::vector<PathSegment>& original, const std::vector<Piece>& pieces,
          const WrittenPieces& written, Changed& changed)
      : original_(original), pieces_(pieces), changed_(changed) {
    // The piece of each line of the changed program; the comment that keeps the original first.
    piece_of_.assign(changed.replaced.origin.size(), kNone);
    std::size_t group = 0;
    std::uint32_t before = 0;
    for (std::size_t number = 1; number < changed.replaced.origin.size(); ++number) {
      const std::uint32_t origin = changed.replaced.origin[number];
      if (origin != before && changed.lines.contains(origin)) {
        const auto& of = written.of_lines[group++];
        for (std::size_t i = 0; i < of.size(); ++i) {
          piece_of_[number + 1 + i] = of[i];
        }
      } else if (const auto same = written.as_they_are.find(origin);
                 same != written.as_they_are.end()) {
        piece_of_[number] = same->second;
      }
      before = origin;
    }
  }

  /// The first segment of each piece and of each block that stays has its place, and what rounds
  /// the corner behind a block that stays: it begins before the corner, and the next block behind
  /// it. What the control put between pieces, or divided, or merged lies in proportion to length.
  void run() {
    const auto& segments = changed_.path.segments;
    changed_.start_mm.assign(segments.size() + 1, 0.0);
    std::size_t known = 0;
    double at = 0.0;
    double passed = 0.0;  // since then
    for (std::size_t i = 0; i <= segments.size(); ++i) {
      const double place = i < segments.size() ? place_of(i, at + passed) : whole_mm();
      if (!std::isnan(place)) {
        at = std::max(at, place);
        spread(known, i, at);
        known = i;
        passed = 0.0;
      }
      passed += i < segments.size() ? segments[i].length_mm : 0.0;
    }
    changed_.end_mm.assign(changed_.start_mm.begin() + 1, changed_.start_mm.end());
    changed_.start_mm.pop_back();
  }

 private:
  static constexpr std::size_t kNone = WrittenPieces::kNone;
  static constexpr double kNear_mm = 10.0;  ///< more than a correction moves anything

  [[nodiscard]] double whole_mm() const {
    return original_.empty() ? 0.0 : original_.back().position_mm + original_.back().length_mm;
  }

  /// From the start of segment `from`, which has its place, to that of `to`, which is at `at_mm`.
  void spread(std::size_t from, std::size_t to, double at_mm) {
    const auto& segments = changed_.path.segments;
    double whole = 0.0;
    for (std::size_t i = from; i < to; ++i) {
      whole += segments[i].length_mm;
    }
    const double start = changed_.start_mm[from];
    double passed = 0.0;
    for (std::size_t i = from; i < to; ++i) {
      changed_.start_mm[i] = whole > 0.0 ? start + (at_mm - start) * passed / whole : start;
      passed += segments[i].length_mm;
    }
    changed_.start_mm[to] = at_mm;
  }

  /// Where a segment starts, as original path length; not a number where others decide. `at_mm`: by
  /// what is passed.
  double place_of(std::size_t i, double at_mm) {
    const auto& segments = changed_.path.segments;
    const std::uint32_t line = segments[i].line;
    const bool same_block = i > 0 && segments[i - 1].line == line;
    const std::size_t index = line < piece_of_.size() ? piece_of_[line] : kNone;
    if (index != kNone) {
      return same_block ? kernel::units::kNan : pieces_[index].progress_start_mm;
    }
    // What rounds the end of a block is the last of its line.
    const bool rounds = same_block && i + 1 < segments.size() && segments[i + 1].line != line &&
                        segments[i].geometry == Geometry::arc;
    std::size_t of = same_block ? (rounds ? taken_ : kNone) : kept(line, at_mm);
    if (of == kNone || original_[of].line != origin_of(line)) {
      return kernel::units::kNan;
    }
    // Blocks that the control merges have the first one's line: the end is the last one's.
    const Point& at = segments[i].start_mm;
    for (auto j = of; rounds && j < original_.size() && original_[j].position_mm < at_mm; ++j) {
      const double away_mm = geometry::distance(at, original_[j].end_mm);
      of = away_mm < geometry::distance(at, original_[of].end_mm) ? j : of;
    }
    return original_[of].position_mm + original_[of].length_mm * passed(original_[of], at, rounds);
  }

  /// How much of a segment is behind a point near its start (near its end where `at_end`), as a
  /// share of its length. Elsewhere an arc of a turn and more comes near the point again.
  static double passed(const PathSegment& segment, const Point& point, bool at_end = false) {
    if (!(segment.length_mm > 0.0)) {
      return 0.0;
    }
    const double part = std::min(0.5, std::numbers::pi / std::max(segment.sweep_rad, 1e-9));
    const auto foot = at_end ? geometry::foot_point(segment, point, 1.0 - part, 1.0, 1.0)
                             : geometry::foot_point(segment, point, 0.0, part, 0.0);
    return geometry::distance_at(segment, foot.u) / segment.length_mm;
  }

  /// A block that stays: the next segment of the original with its line.
  std::size_t kept(std::uint32_t changed_line, double at_mm) {
    const std::uint32_t line = origin_of(changed_line);
    const auto is_it = [&](const PathSegment& of) {
      return of.line == line && of.position_mm >= at_mm - kNear_mm;
    };
    // The last one found stays behind: a block may be run again.
    while (index_ < original_.size() && original_[index_].position_mm < at_mm - kNear_mm) {
      ++index_;
    }
    for (std::size_t i = index_;
         i < original_.size() && original_[i].position_mm < at_mm + kNear_mm; ++i) {
      if (is_it(original_[i]) && (taken_ == kNone || i > taken_)) {
        taken_ = i;
        return i;
      }
    }
    return kNone;
  }

  [[nodiscard]] std::uint32_t origin_of(std::uint32_t line) const noexcept {
    return line < changed_.replaced.origin.size() ? changed_.replaced.origin[line] : 0;
  }

  const std::vector<PathSegment>& original_;
  const std::vector<Piece>& pieces_;
  Changed& changed_;
  std::vector<std::size_t> piece_of_;
  std::size_t index_ = 0;
  std::size_t taken_ = kNone;
};

}  // namespace

void map_text(const nc::plan::PlannedPath& original, const std::vector<Piece>& pieces,
              const WrittenPieces& written, Changed& changed) {
  Mapping(original.segments, pieces, written, changed).run();
}

}  // namespace steadyrest::contour::offline
