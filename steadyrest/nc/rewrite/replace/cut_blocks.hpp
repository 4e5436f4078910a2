// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/nc/interpret/parameters/known_state.hpp>
#include <steadyrest/nc/interpret/state/config.hpp>
#include <steadyrest/nc/interpret/state/move.hpp>
#include <steadyrest/nc/interpret/state/state.hpp>

namespace steadyrest::nc::rewrite {

/// Why a block that cuts must stay as it is written. The feed of some may change: takes_feed().
enum class Stays : std::uint8_t {
  free,            ///< it may be replaced
  repeated,        ///< it is in a subprogram, a condition or a loop, or is executed twice
  switchable,      ///< the operator can skip it (block delete)
  after_switch,    ///< it begins, or cuts, as a block says that the operator can skip
  by_control,      ///< where it begins, or what its words mean, is the control's decision
  before_control,  ///< what the control decides may come next: it leaves everything as it was
  calculated,      ///< its words hold parameters or expressions
  more_words,      ///< it does more than move along a line or an arc
  feed_mode,       ///< its feed is a time (G93)
  compensated,     ///< cutter radius compensation is on
  diameter,        ///< X is a diameter
  framed,          ///< its words are mirrored, scaled, turned or polar (G51.1, G51, G68, G16)
  rotary,          ///< an axis beyond X, Y, Z moves
  spline,          ///< a spline, a drilling cycle, a thread
  locked,          ///< no override acts: tapping, threading, M49
  too_long,        ///< the comment that keeps the line would not fit into a block
  motion_needed,   ///< the next block takes its motion word from it
  line_needed,     ///< the first move after G40: it must be straight
  beside,          ///< the control does not count with where it begins (MoveOutput::beside)
  unproved,        ///< the proof has refused what would have replaced it
};
/// The reason in words: "it is executed more than once".
[[nodiscard]] std::string_view sentence(Stays stays) noexcept;
/// Its feed may change, whether its path may or not.
[[nodiscard]] constexpr bool takes_feed(Stays stays) noexcept {
  return stays == Stays::free || stays == Stays::motion_needed || stays == Stays::line_needed ||
         stays == Stays::beside;
}
/// A block that cuts, and what must be known to write other blocks in its place.
struct CutBlock {
  std::uint32_t line = 0;
  Stays stays = Stays::free;
  bool inherited = false;       ///< the next block without a motion word takes this one's
  bool feed_inherited = false;  ///< the next block that cuts without F takes this one's
  bool begins_beside = false;   ///< it cannot be divided: the control counts with another start
  int motion = 0;               ///< G code times ten that it leaves in force
  interpret::FeedMode feed_mode = interpret::FeedMode::per_minute;
  double feed = 0.0;     ///< F in program units
  double unit_mm = 1.0;  ///< of positions
  bool incremental = false;
  bool centre_absolute = false;
  interpret::Plane plane = interpret::Plane::xy;
  bool plane_known = true;            ///< else no arc may come in its place
  std::uint32_t unknown_axes = 0;     ///< what comes in its place must not name them, a mask
  std::array<double, 3> offset_mm{};  ///< machine = turned work position + offset
  double rotation_deg = 0.0;
  std::array<double, 3> start_mm{};  ///< machine
  std::array<double, 3> end_mm{};
};

/// The blocks of a program that cut, in the order of their lines.
struct CutBlocks {
  std::vector<CutBlock> blocks;
  /// What the program reads of values that the control decides, and what was taken for them.
  std::vector<interpret::Assumed> assumed;
  /// None when the line does not cut.
  [[nodiscard]] const CutBlock* find(std::uint32_t line) const noexcept;
  /// So many of the blocks that could be replaced stay from now on (Stays::unproved): those at
  /// `line` and before it, then those behind it. Returns how many there were.
  std::size_t keep_near(std::uint32_t line, std::size_t count);
  [[nodiscard]] std::vector<std::uint32_t> lines_that_stay(Stays why) const;
};

/// Runs the program once. Lines that program compensate has inserted are no cuts. Refuses what the
/// interpreter refuses.
[[nodiscard]] kernel::outcome::Result<CutBlocks> cut_blocks(const std::string& path,
                                                            const interpret::Config& config);

}  // namespace steadyrest::nc::rewrite
