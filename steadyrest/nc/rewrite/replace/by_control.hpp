// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include <steadyrest/nc/interpret/decode/dialect_rules.hpp>
#include <steadyrest/nc/interpret/program.hpp>
#include <steadyrest/nc/interpret/state/move.hpp>
#include <steadyrest/nc/interpret/state/state.hpp>
#include <steadyrest/nc/read/text/block.hpp>
#include <steadyrest/nc/rewrite/replace/cut_blocks.hpp>

namespace steadyrest::nc::rewrite {

/// Axes that a line names or its moves change, a mask.
[[nodiscard]] inline std::uint32_t axes_used(const read::Block& block,
                                             std::span<const interpret::Move> moves) noexcept {
  std::uint32_t used = 0;
  for (const interpret::Move& move : moves) {
    for (std::size_t i = 0; i < move.start.size(); ++i) {
      used |= move.start[i] != move.end[i] ? std::uint32_t{1} << i : 0U;
    }
  }
  for (const read::Word& word : block.words()) {
    const auto axis = interpret::kAxisLetters.find(word.letter);
    used |= word.letter != 0 && axis != std::string_view::npos ? std::uint32_t{1} << axis : 0U;
  }
  return used;
}

/// The plane of its machine data is in force at the start of a sinumerik; elsewhere the program
/// sets it, since the one in force may be any.
[[nodiscard]] inline bool plane_known(const interpret::Doubt& doubt,
                                      read::Dialect dialect) noexcept {
  constexpr interpret::ModeMask kPlane = mode(interpret::GGroup::plane);
  return (doubt.lost & kPlane) == 0 &&
         ((doubt.unset & kPlane) == 0 || interpret::rules_of(dialect).settable_frames);
}

/// A block of a straight move or an arc depends on what the control decides: whether it is
/// executed, where it begins, or the modes that give its words their meaning; `doubt`: as the block
/// leaves them. `used`: axes that what comes in the block's place may name.
///
/// G90 or G91 must be set by the program, and the plane of an arc; what else the state at the start
/// may be (feed per revolution, cutter compensation, G90.1) is taken to be as usual, unless the
/// program changes it in some runs alone. In G91 the place does not matter.
[[nodiscard]] inline bool depends_on_control(const interpret::Doubt& doubt,
                                             const interpret::State& state,
                                             const interpret::Move& move, std::uint32_t used,
                                             read::Dialect dialect) noexcept {
  using interpret::GGroup;
  constexpr interpret::ModeMask kNeeded = mode(GGroup::motion) | mode(GGroup::distance);
  constexpr interpret::ModeMask kShape = mode(GGroup::units) | mode(GGroup::feed_mode) |
                                         mode(GGroup::cutter) | mode(GGroup::arc_centre) |
                                         mode(GGroup::lathe_diameter) | interpret::kFeedMode;
  const bool arc = move.kind == interpret::MoveKind::arc;
  if (arc) {
    const auto plane = interpret::axes_of(state.plane);
    used |= std::uint32_t{1} << plane.first | std::uint32_t{1} << plane.second;
  }
  const bool placed = (doubt.axes & used) == 0 || (state.incremental && !state.centre_absolute);
  return doubt.line || !placed || (doubt.unset & kNeeded) != 0 || (doubt.lost & kShape) != 0 ||
         (arc && !plane_known(doubt, dialect));
}

inline constexpr std::string_view kAsksControl =
    "cuts an arc, or names an axis, where the control decides its plane or place";
/// What comes in place of a block would depend on it after all.
[[nodiscard]] inline bool asks_control(const CutBlock& of, const read::Block& block,
                                       std::span<const interpret::Move> moves) noexcept {
  return (axes_used(block, {}) & of.unknown_axes) != 0 ||
         (!of.plane_known && std::ranges::any_of(moves, [](const interpret::Move& move) {
           return move.kind == interpret::MoveKind::arc;
         }));
}

}  // namespace steadyrest::nc::rewrite
