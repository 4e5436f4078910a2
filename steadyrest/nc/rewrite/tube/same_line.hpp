// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include <steadyrest/nc/interpret/state/move.hpp>
#include <steadyrest/nc/read/text/block.hpp>
#include <steadyrest/nc/rewrite/tube/permitted.hpp>

namespace steadyrest::nc::rewrite {

/// Ends that differ by no more are the same, mm.
inline constexpr double kSameEnd_mm = 1e-6;
/// A kept arc may start so far from where the original's does: LinuxCNC's slack of an arc's radius.
inline constexpr double kSameArc_mm = 0.00127;

/// A line that both programs execute, and its moves in each.
struct LinePair {
  std::span<const interpret::Move> original;
  std::span<const interpret::Move> changed;
  /// Half of the last digit that new blocks are written with, mm: an axis that the line does not
  /// name keeps what that has made of it.
  double rounding_mm = 0.0;
  bool replaceable = false;  ///< a block whose feed could have been changed
};

/// What differs; empty when the line does the same. Kinds of moves, feeds, path modes, ends and
/// offsets are equal. A straight move may start where a replaced block before it has ended, within
/// the tube; an arc within kSameArc_mm, and anything else within the rounding.
[[nodiscard]] std::string line_difference(const LinePair& pair, const Permitted& permitted);

/// The same number of events of the same kinds with the same values, apart from spindle speeds
/// that may differ.
[[nodiscard]] std::string event_difference(std::span<const interpret::Event> original,
                                           std::span<const interpret::Event> changed,
                                           const Permitted& permitted);

/// An arc that starts or runs a little beside the original's.
[[nodiscard]] bool is_moved_arc(const interpret::Move& original, const interpret::Move& changed);

/// The words of a new line are those of the original, apart from the values of S and F and an F
/// more.
[[nodiscard]] bool differs_in_values_alone(const read::Block& original, const read::Block& changed);

}  // namespace steadyrest::nc::rewrite
