// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include <steadyrest/contour/offline/predistort/polish/chain_motion.hpp>
#include <steadyrest/contour/offline/predistort/shape/piece.hpp>

namespace steadyrest::contour::offline {

/// A piece of the command in its plane.
struct Link {
  ChainPiece piece;
  Piece of;  ///< what it is written as
};

/// The piece in its plane. Nothing for spirals, and for what rises too steeply.
[[nodiscard]] std::optional<ChainPiece> flat(const Piece& from);
[[nodiscard]] Piece in_space(const Link& link);
/// As few slopes as leave the height of every joint within the tolerance: a control stops where the
/// slope changes. `alike`: pieces of one slope of the original have one slope, whatever that
/// leaves.
void level(std::span<ChainPiece> pieces, double tolerance_mm, bool alike = false);
/// `one` becomes its first half, `two` the second.
void halve(Link& one, Link& two);

}  // namespace steadyrest::contour::offline
