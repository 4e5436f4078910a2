// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <utility>
#include <vector>

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
/// Pieces that turn by much are halved: two arcs that close a window's gap must not.
void divide(std::vector<Link>& chain);
/// The progress of the pieces [first, last) in proportion to their length, between those before and
/// behind them. `leaves_mm`, `arrives_mm`: how long the neighbours were, whose progress ends and
/// begins in proportion to their new length; 0: as it was.
void share_progress(std::span<Link> chain, std::pair<std::size_t, std::size_t> range,
                    double leaves_mm, double arrives_mm);

}  // namespace steadyrest::contour::offline
