// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <steadyrest/math/geometry/segment.hpp>
#include <steadyrest/math/geometry/vector.hpp>
#include <steadyrest/nc/interpret/state/words.hpp>
#include <steadyrest/nc/rewrite/replace/feed_blocks.hpp>
#include <steadyrest/nc/rewrite/text/source_lines.hpp>

namespace steadyrest::nc::rewrite {
namespace {

namespace geometry = math::geometry;
using kernel::outcome::Result;
using kernel::signal::Geometry;
using kernel::signal::Motion;
using kernel::signal::PathSegment;
using kernel::signal::Point;
using plan::PlannedPath;

/// An arc whose radius changes by more has a centre that its parts would not share.
constexpr double kSpiral_mm = 1e-5;
constexpr double kBeyond_mm =
    1e-6;  ///< a line ends beyond its block when it ends farther than this
/// An arc in one block turns by less, so that its end is not its start.
constexpr double kMostTurn_rad = 1.9 * std::numbers::pi;

/// Its feed may change: where it hands on its motion word, the new blocks have the same.
bool takes_feed(const CutBlock* block) noexcept {
  return block != nullptr && takes_feed(block->stays);
}

bool cuts(const PathSegment& segment) noexcept {
  return segment.motion == Motion::feed;
}

/// The blocks between two lines, both left out, that have no segment of their own.
std::span<const CutBlock> between(const CutBlocks& blocks, std::uint32_t line,
                                  std::uint32_t next) noexcept {
  const auto first = std::ranges::upper_bound(blocks.blocks, line, {}, &CutBlock::line);
  const auto end = std::ranges::lower_bound(blocks.blocks, next, {}, &CutBlock::line);
  return first < end ? std::span<const CutBlock>(first, end) : std::span<const CutBlock>();
}

bool ends_beyond(const PathSegment& segment, const CutBlock& block) noexcept {
  return geometry::norm(geometry::subtract(segment.end_mm, block.start_mm)) >
         geometry::norm(geometry::subtract(block.end_mm, block.start_mm)) + kBeyond_mm;
}

FeedUse use_of(const PlannedPath& path, std::size_t i, const CutBlocks& blocks) noexcept {
  const PathSegment& segment = path.segments[i];
  const CutBlock* block = blocks.find(segment.line);
  if (!cuts(segment) || !takes_feed(block)) {
    return FeedUse::kept;
  }
  if (i > 0 && cuts(path.segments[i - 1]) && path.segments[i - 1].line == segment.line) {
    return FeedUse::joined;
  }
  const bool line = segment.geometry == Geometry::line;
  if (line != (block->motion == interpret::g::kLinear)) {
    return FeedUse::whole;  // an arc so flat that it is planned as lines
  }
  if (line && ends_beyond(segment, *block)) {
    // Merged with blocks behind it: they get its feed.
    const bool last = i + 1 >= path.segments.size();
    const auto merged =
        between(blocks, segment.line, last ? segment.line : path.segments[i + 1].line);
    const bool all = std::ranges::all_of(merged, [](const CutBlock& b) { return takes_feed(&b); });
    return all ? FeedUse::whole : FeedUse::kept;
  }
  // Where an offset has changed under it, LinuxCNC starts elsewhere than its interpreter says.
  const bool starts_there =
      i > 0 && geometry::norm(geometry::subtract(segment.start_mm, path.segments[i - 1].end_mm)) <=
                   kBeyond_mm;
  const bool spiral = !line && std::abs(segment.radius_end_mm - segment.radius_mm) > kSpiral_mm;
  return spiral || !starts_there || block->begins_beside ? FeedUse::whole : FeedUse::anywhere;
}

/// A block with its feeds, in the order of execution.
struct BlockFeeds {
  const CutBlock* block = nullptr;  ///< null: a block that is not known (of a subprogram)
  std::vector<NewMove> moves;       ///< one: the block is not divided. None: it must stay
};

/// Divides the blocks.
class Division {
 public:
  Division(const PlannedPath& path, const CutBlocks& blocks) : path_(path), blocks_(blocks) {}

  std::vector<BlockFeeds> of(std::span<const FeedStretch> stretches) {
    const std::vector<FeedUse> uses = feed_uses(path_, blocks_);
    std::size_t at = 0;
    for (std::size_t i = 0; i < path_.segments.size(); ++i) {
      const PathSegment& segment = path_.segments[i];
      if (!cuts(segment)) {
        continue;
      }
      if (uses[i] != FeedUse::joined) {
        begin(segment.line, uses[i]);
      }
      for (; at < stretches.size() && stretches[at].segment == i; ++at) {
        if (uses[i] == FeedUse::anywhere || uses[i] == FeedUse::whole) {
          add(segment, stretches[at]);
        }
      }
    }
    for (BlockFeeds& one : out_) {
      if (!one.moves.empty()) {
        one.moves.back().end_mm = one.block->end_mm;
      }
    }
    return std::move(out_);
  }

 private:
  void begin(std::uint32_t line, FeedUse use) {
    // Blocks that became part of the line before have its feed.
    if (!out_.empty() && out_.back().block != nullptr && !out_.back().moves.empty()) {
      const double ratio = out_.back().moves.back().feed_ratio;
      for (const CutBlock& block : between(blocks_, out_.back().block->line, line)) {
        if (takes_feed(&block)) {
          out_.push_back({&block, {{.end_mm = block.end_mm, .feed_ratio = ratio}}});
        }
      }
    }
    out_.push_back({blocks_.find(line), {}});
    if (use == FeedUse::kept) {
      return;
    }
    out_.back().moves.reserve(1);
  }
  void add(const PathSegment& segment, const FeedStretch& stretch) {
    BlockFeeds& to = out_.back();
    NewMove move{.geometry = segment.geometry,
                 .centre_mm = segment.centre_mm,
                 .clockwise = to.block->motion == interpret::g::kArcClockwise,
                 .feed_ratio = stretch.ratio};
    const bool whole = stretch.from_mm <= 0.0 && stretch.to_mm >= segment.length_mm;
    const double turn =
        segment.length_mm > 0.0
            ? segment.sweep_rad * (stretch.to_mm - stretch.from_mm) / segment.length_mm
            : 0.0;
    const bool arc = segment.geometry == Geometry::arc;
    const double pieces = arc && !whole ? std::max(1.0, std::ceil(turn / kMostTurn_rad)) : 1.0;
    for (double j = 1.0; j <= pieces; ++j) {
      const double end = stretch.from_mm + (stretch.to_mm - stretch.from_mm) * j / pieces;
      move.end_mm = geometry::point_at(segment, geometry::parameter_at(segment, end));
      to.moves.push_back(move);
    }
  }

  const PlannedPath& path_;
  const CutBlocks& blocks_;
  std::vector<BlockFeeds> out_;
};

/// Follows F through the program and writes it where it changes.
class FeedWriter {
 public:
  FeedWriter(read::Dialect dialect, const std::vector<std::string>& lines, NewLines& out)
      : dialect_(dialect), lines_(lines), out_(out) {}

  void block(const BlockFeeds& one) {
    const bool inherits = before_ != nullptr && before_->feed_inherited;
    const bool free = !one.moves.empty();
    const bool same_unit = before_ != nullptr && one.block != nullptr &&
                           before_->feed_mode == one.block->feed_mode &&
                           before_->unit_mm == one.block->unit_mm;
    if (inherits && !(free && same_unit)) {
      put_back();
    }
    if (one.block == nullptr) {
      before_ = nullptr;
      return;
    }
    const std::string own = BlockText::feed_word(*one.block, 1.0);
    if (!inherits || !same_unit || in_force_.empty()) {
      in_force_ = own;
    }
    before_ = one.block;
    if (free) {
      write(one);
    }
  }
  void finish() {
    if (before_ != nullptr) {
      put_back();
    }
  }

 private:
  std::vector<std::string>& lines_of(std::uint32_t line) {
    const auto [at, fresh] = out_.try_emplace(line);
    if (fresh) {
      at->second.push_back(lines_[line]);
    }
    return at->second;
  }
  /// F as the program has it, behind the block before.
  void put_back() {
    std::string own = BlockText::feed_word(*before_, 1.0);
    if (in_force_ != own) {
      lines_of(before_->line).push_back(own);
      in_force_ = std::move(own);
    }
  }
  void write(const BlockFeeds& one) {
    const CutBlock& block = *one.block;
    const BlockText text(dialect_, decimals_of(dialect_, block.unit_mm));
    const std::string& line = lines_[block.line];
    const double ratio = one.moves.front().feed_ratio;
    if (one.moves.size() == 1) {
      std::string wanted = BlockText::feed_word(block, ratio);
      if (wanted != in_force_) {
        out_[block.line] = {text.with_feed(block, line, ratio)};
        in_force_ = std::move(wanted);
      }
      return;
    }
    kernel::signal::Point at = block.start_mm;
    std::vector<std::string> texts = text.write(block, line, one.moves, at);
    if (texts.empty()) {
      return;
    }
    out_[block.line] = std::move(texts);
    in_force_ = BlockText::feed_word(block, one.moves.back().feed_ratio);
  }

  read::Dialect dialect_;
  const std::vector<std::string>& lines_;
  NewLines& out_;
  const CutBlock* before_ = nullptr;  ///< that cut last
  std::string in_force_;              ///< F behind it in the new program
};

}  // namespace

std::vector<FeedUse> feed_uses(const PlannedPath& path, const CutBlocks& blocks) {
  std::vector<FeedUse> uses(path.segments.size(), FeedUse::kept);
  for (std::size_t i = 0; i < uses.size(); ++i) {
    uses[i] = use_of(path, i, blocks);
    if (uses[i] == FeedUse::joined && uses[i - 1] == FeedUse::kept) {
      uses[i] = FeedUse::kept;
    }
  }
  return uses;
}

std::vector<std::array<float, 2>> rounding_ends(const PlannedPath& path, const CutBlocks& blocks,
                                                double blend_share) {
  constexpr double kSpare = 1.05;
  std::vector<std::array<float, 2>> ends(path.segments.size());
  const double more = kSpare * (1.0 / std::clamp(blend_share, 0.01, 1.0) - 1.0);
  for (std::size_t i = 0; i < ends.size(); ++i) {
    const PathSegment& segment = path.segments[i];
    const CutBlock* block = cuts(segment) ? blocks.find(segment.line) : nullptr;
    if (block != nullptr) {
      const auto taken = [more](const Point& a, const Point& b) {
        const double mm = geometry::norm(geometry::subtract(a, b));
        return mm > kBeyond_mm ? static_cast<float>(more * mm) : 0.0F;
      };
      ends[i] = {taken(segment.start_mm, block->start_mm), taken(segment.end_mm, block->end_mm)};
    }
  }
  return ends;
}

Result<NewLines> feed_lines(const std::string& program, read::Dialect dialect,
                            const PlannedPath& path, const CutBlocks& blocks,
                            std::span<const FeedStretch> stretches) {
  auto source = SourceLines::open(program);
  if (!source) {
    return std::unexpected(source.error());
  }
  std::vector<std::string> lines(1);
  while (source->next()) {
    lines.emplace_back(source->line());
  }
  if (auto whole = source->whole(); !whole) {
    return std::unexpected(whole.error());
  }
  NewLines out;
  FeedWriter writer(dialect, lines, out);
  for (const BlockFeeds& one : Division(path, blocks).of(stretches)) {
    writer.block(one);
  }
  writer.finish();
  return out;
}

}  // namespace steadyrest::nc::rewrite
