// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include <steadyrest/contour/offline/predistort/polish/chain_motion.hpp>

namespace steadyrest::contour::offline {

/// The way round a corner of the path: beyond it, straight across, and on. The first piece becomes
/// longer by `beyond_mm`, the last begins `on_mm` later. False where too little of one is left.
bool turn_corner(std::span<ChainPiece, 3> way, double beyond_mm, double on_mm);

}  // namespace steadyrest::contour::offline
