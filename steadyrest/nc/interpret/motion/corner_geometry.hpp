// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <expected>

#include <steadyrest/nc/interpret/state/arc.hpp>

namespace steadyrest::nc::interpret {

/// One side of a corner in its plane, mm: a line, or an arc about `centre`.
struct CornerSide {
  PlanePoint start;
  PlanePoint end;
  bool arc = false;
  PlanePoint centre;
  bool clockwise = false;
};

/// What takes the corner's place: from a point of the first side to one of the second.
struct CornerCut {
  PlanePoint from;
  PlanePoint to;
  PlanePoint centre;       ///< of a rounding
  bool clockwise = false;  ///< likewise
};

enum class CornerFault : unsigned char {
  straight,   ///< no corner: the direction changes by less than 1°
  reversal,   ///< the second side goes back along the first
  too_large,  ///< does not fit on the sides
  beside_arc  ///< a chamfer on an arc: whether its length is the chord's is not certain
};

/// A chamfer that takes `length_mm` off both lines.
[[nodiscard]] std::expected<CornerCut, CornerFault> chamfer(const CornerSide& first,
                                                            const CornerSide& second,
                                                            double length_mm) noexcept;
/// A rounding tangent to both sides.
[[nodiscard]] std::expected<CornerCut, CornerFault> rounding(const CornerSide& first,
                                                             const CornerSide& second,
                                                             double radius_mm) noexcept;

}  // namespace steadyrest::nc::interpret
