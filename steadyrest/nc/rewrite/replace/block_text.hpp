// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/kernel/signal/path.hpp>
#include <steadyrest/nc/read/text/dialect.hpp>
#include <steadyrest/nc/rewrite/replace/cut_blocks.hpp>

namespace steadyrest::nc::rewrite {

/// A line or an arc to be written, in machine coordinates.
struct NewMove {
  kernel::signal::Geometry geometry = kernel::signal::Geometry::line;
  kernel::signal::Point end_mm{};
  kernel::signal::Point centre_mm{};  ///< arc: in the block's plane, at any height
  bool clockwise = false;             ///< arc: seen against the plane's normal
  double feed_ratio = 1.0;            ///< of the block's own F
};

/// Writes lines and arcs in the modes that are in force where they go: units, plane, work offset
/// and its rotation, G90 or G91, the kind of arc centre.
///
/// Every number is rounded to what the control takes; the next move starts from the rounded point,
/// so nothing adds up. Each block has its motion word and its F, since it may be begun anywhere.
class BlockText {
 public:
  BlockText(read::Dialect dialect, int decimals) : dialect_(dialect), decimals_(decimals) {}

  /// The blocks, without marks. `line` gives its block number to the first. `at_mm` is where the
  /// control is, in machine coordinates, and moves on to where it will be. An arc must turn by less
  /// than 360°.
  [[nodiscard]] std::vector<std::string> write(const CutBlock& block, std::string_view line,
                                               std::span<const NewMove> moves,
                                               kernel::signal::Point& at_mm) const;
  /// What puts motion and feed back after these moves, for blocks that take them over; empty where
  /// none is needed.
  [[nodiscard]] std::string restore(const CutBlock& block, std::span<const NewMove> moves) const;
  /// The same line with another F; for a line that is free.
  [[nodiscard]] std::string with_feed(const CutBlock& block, std::string_view line,
                                      double feed_ratio) const;
  [[nodiscard]] static std::string feed_word(const CutBlock& block, double feed_ratio);

 private:
  [[nodiscard]] static std::string number(double value, int decimals);
  [[nodiscard]] std::string code(const CutBlock& block, const NewMove& move,
                                 kernel::signal::Point& at_mm) const;

  read::Dialect dialect_;
  int decimals_;
};

/// `G4 P0.15`, in seconds, as each control has it.
[[nodiscard]] std::string dwell_text(read::Dialect dialect, double seconds);

/// The line with this word in place of its word with the same letter, or before the comment that
/// ends it; for a line of plain words and comments.
[[nodiscard]] std::string with_word(read::Dialect dialect, std::string_view line,
                                    std::string_view word);

/// As many digits as the control takes, in mm or inch.
[[nodiscard]] int decimals_of(read::Dialect dialect, double unit_mm) noexcept;
/// `N130 ` of a line that begins with a block number; else empty.
[[nodiscard]] std::string_view block_number(std::string_view line) noexcept;

}  // namespace steadyrest::nc::rewrite
