// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <expected>

namespace steadyrest::nc::interpret {

/// An arc in its plane. First and second axis in right-handed order: X Y (G17), Z X (G18), Y Z
/// (G19). All in mm.
struct PlanePoint {
  double first = 0.0;
  double second = 0.0;
};

/// How far an arc may miss in LinuxCNC 2.9 (measured with rs274).
struct ArcTolerance {
  double radius_mm = 0.00127;               ///< smallest radius; slack of R against half the chord
  double spiral_mm = 0.028284271247461903;  ///< start and end radius may differ by this,
  double spiral_ratio = 0.001;              ///< or by this share of the larger one,
  double spiral_most_mm = 2.8284271247461903;  ///< but never by more than this
};
/// The tolerances while G20 is in force: 0.00005 in, 0.00282842712 in, 0.282842712 in.
[[nodiscard]] ArcTolerance arc_tolerance(bool inch) noexcept;

enum class ArcFault : unsigned char {
  radius_too_small,  ///< R does not reach the end point
  no_chord,          ///< R with start = end: the centre is anywhere
  zero_radius,       ///< the centre lies on the start or end point
  does_not_close     ///< start and end radius differ too much
};

/// Centre from radius: R > 0 for arcs up to 180°, R < 0 for longer ones.
[[nodiscard]] std::expected<PlanePoint, ArcFault> centre_from_radius(
    PlanePoint start, PlanePoint end, double radius_mm, bool clockwise,
    const ArcTolerance& tolerance) noexcept;

/// Whether `centre` is valid for an arc from `start` to `end`.
[[nodiscard]] std::expected<void, ArcFault> check_centre(PlanePoint start, PlanePoint end,
                                                         PlanePoint centre,
                                                         const ArcTolerance& tolerance) noexcept;

}  // namespace steadyrest::nc::interpret
