// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

#include <fmt/core.h>

#include <steadyrest/contour/offline/predistort/text/changed_text.hpp>
#include <steadyrest/contour/offline/predistort/text/text_map.hpp>
#include <steadyrest/math/geometry/foot_point.hpp>
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
      const std::string wait = wait_before(*block);
      if (next_ < pieces_.size() && pieces_[next_].segment.line == block->line) {
        if (auto texts = texts_of(*block, source->line(), segment)) {
          put_first(wait, *texts);
          out[block->line] = std::move(*texts);
        } else {
          put_back(out);
          keep_behind(wait, *block, source->line(), out);
        }
      } else if (block->stays == Stays::free && moves_nothing(*block) && led_) {
        if (modes_kept_ && same_place(at_mm_, block->start_mm)) {
          continue;
        }
        // The same point again: the command is elsewhere now.
        out[block->line] = {};
        restore_ = {block->line, mode_words(*block)};
        written_.of_lines.emplace_back();
        modes_kept_ = false;
      } else {
        put_back(out);
        keep_behind(wait, *block, source->line(), out);
        led_ = false;
      }
    }
    put_back(out);
    return out;
  }

  [[nodiscard]] const WrittenPieces& written() const { return written_; }

 private:
  static bool moves_nothing(const CutBlock& block) noexcept {
    return geometry::distance(block.start_mm, block.end_mm) < 1e-9;
  }

  /// The line that waits before a block; empty: none does.
  [[nodiscard]] std::string wait_before(const CutBlock& block) const {
    const auto wait = program_.waits.find(block.line);
    return wait == program_.waits.end() || block.stays != Stays::free
               ? std::string{}
               : nc::rewrite::dwell_text(program_.config.dialect, wait->second);
  }
  /// Before the new lines of a block.
  void put_first(const std::string& wait, std::vector<std::string>& texts) {
    if (!wait.empty()) {
      texts.insert(texts.begin(), wait);
      auto& of = written_.of_lines.back();
      of.insert(of.begin(), WrittenPieces::kNone);
    }
  }
  /// Before a block that stays as it is.
  void keep_behind(const std::string& wait, const CutBlock& block, std::string_view line,
                   NewLines& out) {
    if (!wait.empty()) {
      out[block.line] = {wait, std::string(line)};
      written_.of_lines.emplace_back();
    }
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
      written_.as_they_are.emplace(block.line, first);
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
    written_.of_lines.emplace_back();
    for (std::size_t i = 0; i < from.moves.size(); ++i) {
      const NewMove& move = from.moves[i];
      const auto text = writer.write(block, texts.empty() ? line : "", {&move, 1}, at_mm_);
      if (!text.empty()) {
        texts.push_back(text.front());
        written_.of_lines.back().push_back(from.piece[i]);
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
  WrittenPieces written_;
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
  changed.lines = std::move(*lines);
  map_text(program.path, pieces, writer.written(), changed);
  return changed;
}

}  // namespace steadyrest::contour::offline
