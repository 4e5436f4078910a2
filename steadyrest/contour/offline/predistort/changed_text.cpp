// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <optional>
#include <span>
#include <utility>

#include <fmt/core.h>

#include <steadyrest/contour/offline/predistort/changed_text.hpp>
#include <steadyrest/kernel/units/constants.hpp>
#include <steadyrest/math/geometry/foot_point.hpp>
#include <steadyrest/math/geometry/segment.hpp>
#include <steadyrest/math/geometry/vector.hpp>
#include <steadyrest/nc/interpret/state/words.hpp>
#include <steadyrest/nc/plan/path/plan_program.hpp>
#include <steadyrest/nc/rewrite/replace/block_text.hpp>
#include <steadyrest/nc/rewrite/text/source_lines.hpp>

namespace steadyrest::contour::offline {
namespace {

namespace geometry = math::geometry;
using kernel::outcome::Result;
using kernel::signal::Geometry;
using kernel::signal::PathSegment;
using kernel::signal::Point;
using nc::rewrite::CutBlock;
using nc::rewrite::NewLines;
using nc::rewrite::NewMove;
using nc::rewrite::Stays;

/// New blocks that differ from the old by less cut the same part.
constexpr double kSameBlock_mm = 1e-4;
constexpr double kSameBlockFeed = 1e-4;  ///< of the feed

bool same_place(const Point& a, const Point& b) noexcept {
  return geometry::distance(a, b) <= kSameBlock_mm;
}

/// The moves run along the block's own line or arc (a segment of the path) at its own feed.
bool changes_nothing(const std::vector<NewMove>& moves, const CutBlock& block,
                     const PathSegment& segment) {
  const bool line = block.motion == nc::interpret::g::kLinear;
  const PathSegment of = line ? line_segment(block.start_mm, block.end_mm) : segment;
  const bool clockwise = of.axis[nc::interpret::axes_of(block.plane).normal] < 0.0;
  const auto same = [&](const NewMove& move) {
    const bool arc = move.geometry == Geometry::arc;
    return move.geometry == of.geometry && std::abs(move.feed_ratio - 1.0) <= kSameBlockFeed &&
           geometry::foot_point(of, move.end_mm).distance_mm <= kSameBlock_mm &&
           (!arc || (move.clockwise == clockwise && same_place(move.centre_mm, of.centre_mm)));
  };
  return !moves.empty() && std::ranges::all_of(moves, same) &&
         same_place(moves.back().end_mm, block.end_mm) && same_place(of.start_mm, block.start_mm) &&
         same_place(of.end_mm, block.end_mm);
}

/// The pieces of each line, and which of them each new line writes.
class Writer {
 public:
  Writer(const Program& program, const std::vector<Piece>& pieces)
      : program_(program), pieces_(pieces) {}

  Result<NewLines> lines() {
    auto source = nc::rewrite::SourceLines::open(program_.file);
    if (!source) {
      return std::unexpected(source.error());
    }
    NewLines out;
    std::size_t segment = 0;
    while (source->next()) {
      const CutBlock* block = program_.blocks.find(source->number());
      if (block == nullptr) {
        continue;
      }
      if (next_ < pieces_.size() && pieces_[next_].segment.line == block->line) {
        if (auto texts = texts_of(*block, source->line(), segment)) {
          out[block->line] = std::move(*texts);
        } else {
          put_back(out);
        }
      } else if (block->stays == Stays::free && moves_nothing(*block) && led_) {
        if (modes_kept_ && same_place(at_mm_, block->start_mm)) {
          continue;
        }
        // The same point again: the command is elsewhere now.
        out[block->line] = {};
        restore_ = {block->line, mode_words(*block)};
        written_.emplace_back();
        modes_kept_ = false;
      } else {
        put_back(out);
        led_ = false;
      }
    }
    put_back(out);
    return out;
  }

  /// For each replaced line in order, the piece that each of its new lines writes.
  [[nodiscard]] const std::vector<std::vector<std::size_t>>& written() const { return written_; }
  /// The first piece of each line that stays because its pieces would change nothing.
  [[nodiscard]] const std::map<std::uint32_t, std::size_t>& as_they_are() const {
    return as_they_are_;
  }

 private:
  static bool moves_nothing(const CutBlock& block) noexcept {
    return geometry::distance(block.start_mm, block.end_mm) < 1e-9;
  }

  /// Nothing where they would change nothing.
  std::optional<std::vector<std::string>> texts_of(const CutBlock& block, std::string_view line,
                                                   std::size_t& segment) {
    const auto& segments = program_.path.segments;
    while (segment + 1 < segments.size() && segments[segment].line != block.line) {
      ++segment;
    }
    const bool begins = !led_ || pieces_[next_].begins_run;
    if (begins) {
      at_mm_ = block.start_mm;
      modes_kept_ = true;
    }
    const std::size_t first = next_;
    const Moves moves = moves_of(block, segments[segment].feed_mm_s, begins);
    led_ = true;
    if (modes_kept_ && same_place(at_mm_, block.start_mm) &&
        changes_nothing(moves.moves, block, segments[segment])) {
      as_they_are_.emplace(block.line, first);
      at_mm_ = block.incremental
                   ? geometry::add(at_mm_, geometry::subtract(block.end_mm, block.start_mm))
                   : block.end_mm;
      return std::nullopt;
    }
    return write(block, line, moves);
  }

  struct Moves {
    std::vector<NewMove> moves;
    std::vector<std::size_t> piece;  ///< of each
  };
  Moves moves_of(const CutBlock& block, double feed_mm_s, bool begins) {
    Moves out;
    const auto put = [&](const NewMove& move) {
      out.moves.push_back(move);
      out.piece.push_back(next_);
    };
    // The control rounds the corner before the run, so the run begins behind it; the block before,
    // which stays, ends at the corner.
    const Point& first = pieces_[next_].segment.start_mm;
    if (geometry::distance(at_mm_, first) > kLeastArc_mm && begins) {
      put({.geometry = Geometry::line, .end_mm = first, .feed_ratio = 1.0});
    }
    for (; next_ < pieces_.size() && pieces_[next_].segment.line == block.line; ++next_) {
      const PathSegment& of = pieces_[next_].segment;
      const bool arc = is_written_as_arc(of);
      put({.geometry = arc ? Geometry::arc : Geometry::line,
           .end_mm = of.end_mm,
           .centre_mm = of.centre_mm,
           .clockwise = of.axis[nc::interpret::axes_of(block.plane).normal] < 0.0,
           .feed_ratio = feed_mm_s > 0.0 ? of.feed_mm_s / feed_mm_s : 1.0});
    }
    return out;
  }

  std::vector<std::string> write(const CutBlock& block, std::string_view line, const Moves& from) {
    const nc::rewrite::BlockText writer(
        program_.config.dialect, nc::rewrite::decimals_of(program_.config.dialect, block.unit_mm));
    std::vector<NewMove> moves;
    std::vector<std::string> texts;
    written_.emplace_back();
    for (std::size_t i = 0; i < from.moves.size(); ++i) {
      const NewMove& move = from.moves[i];
      const auto text = writer.write(block, texts.empty() ? line : "", {&move, 1}, at_mm_);
      if (!text.empty()) {
        texts.push_back(text.front());
        written_.back().push_back(from.piece[i]);
        moves.push_back(move);
      }
    }
    restore_ = {block.line, writer.restore(block, moves)};
    modes_kept_ = !moves.empty() && restore_.words.empty();
    return texts;
  }

  /// What later blocks may take over from one whose text is left out.
  static std::string mode_words(const CutBlock& block) {
    std::string words = block.inherited ? fmt::format("G{}", block.motion / 10) : std::string{};
    if (block.feed_inherited) {
      words += (words.empty() ? "" : " ") + nc::rewrite::BlockText::feed_word(block, 1.0);
    }
    return words;
  }

  /// The next block that cuts is not replaced: it may take motion and feed over from the last one
  /// that is.
  void put_back(NewLines& out) {
    if (!restore_.words.empty()) {
      out[restore_.line].push_back(std::move(restore_.words));
      restore_ = {};
    }
  }

  const Program& program_;
  const std::vector<Piece>& pieces_;
  std::size_t next_ = 0;
  bool led_ = false;  ///< the blocks so far have pieces, back to a block that has none
  /// A block that is written as it was has the motion word and the feed that it had.
  bool modes_kept_ = true;
  struct Restore {
    std::uint32_t line = 0;
    std::string words;
  };
  Restore restore_;  ///< motion and feed after the last new block, as the program has them
  Point at_mm_{};
  std::vector<std::vector<std::size_t>> written_;
  std::map<std::uint32_t, std::size_t> as_they_are_;
};

/// Original path lengths at the ends of each segment of the changed path.
class Mapping {
 public:
  Mapping(const Program& program, const std::vector<Piece>& pieces, const NewLines& lines,
          const Writer& writer, Changed& changed)
      : original_(program.path.segments), pieces_(pieces), changed_(changed) {
    // The piece of each line of the changed program; the comment that keeps the original first.
    piece_of_.assign(changed.replaced.origin.size(), kNone);
    std::size_t group = 0;
    std::uint32_t before = 0;
    for (std::size_t number = 1; number < changed.replaced.origin.size(); ++number) {
      const std::uint32_t origin = changed.replaced.origin[number];
      if (origin != before && lines.contains(origin)) {
        const auto& of = writer.written()[group++];
        for (std::size_t i = 0; i < of.size(); ++i) {
          piece_of_[number + 1 + i] = of[i];
        }
      } else if (const auto same = writer.as_they_are().find(origin);
                 same != writer.as_they_are().end()) {
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
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);
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

/// A refusal of what was written, at the block that it replaces.
kernel::outcome::Refusal of_original(kernel::outcome::Refusal refusal, const std::string& file,
                                     const std::vector<std::uint32_t>& origin) {
  const auto line = static_cast<std::size_t>(refusal.line);
  if (refusal.file == file && line > 0 && line < origin.size()) {
    refusal.line = origin[line];
    refusal.what = "the control would refuse what would replace this block: " + refusal.what;
  }
  return refusal;
}

}  // namespace

Result<Changed> write_pieces(const Program& program, const std::vector<Piece>& pieces) {
  Writer writer(program, pieces);
  auto lines = writer.lines();
  if (!lines) {
    return std::unexpected(lines.error());
  }
  auto replaced = nc::rewrite::replace(program.file, program.config.dialect, *lines, program.told);
  if (!replaced) {
    return std::unexpected(replaced.error());
  }
  auto path = nc::plan::plan_text(replaced->text, program.config, program.machine, program.file);
  if (!path) {
    return std::unexpected(of_original(path.error(), program.file, replaced->origin));
  }
  Changed changed;
  changed.replaced = std::move(*replaced);
  changed.path = std::move(*path);
  Mapping(program, pieces, *lines, writer, changed).run();
  changed.lines = std::move(*lines);
  return changed;
}

}  // namespace steadyrest::contour::offline
