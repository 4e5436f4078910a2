// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <steadyrest/nc/interpret/state/move.hpp>

namespace steadyrest::nc::interpret {

/// X and Y turned by an angle about Z, counter-clockwise seen from +Z; the others unchanged. Exact
/// for 0.
[[nodiscard]] Axes turned(const Axes& axes, double angle_deg) noexcept;

/// Between the coordinates that a program's words state and the active work coordinates:
/// programmable mirror image (G51.1), then scaling (G51), then rotation (G68), in mm:
///
///   q = factor·word + shift for each of X Y Z;  work = centre + R(angle)·(q − centre) in the plane
///
/// A mirrored axis has a negative factor. The order is that of FANUC's Series 30i operator's
/// manual, "Programmable mirror image", which also reverses arcs and the angle where one axis of
/// the plane is mirrored; so does this. Rotary axes and U V W are left alone.
struct TextFrame {
  bool on = false;  ///< false: words are work coordinates
  std::array<double, 3> factor{1.0, 1.0, 1.0};
  std::array<double, 3> shift_mm{};
  bool scaled = false;         ///< G51 is in force
  bool rotated = false;        ///< G68 is in force
  std::uint32_t mirrored = 0;  ///< axes of G51.1, a mask of X Y Z
  std::array<double, 3> mirror_mm{};
  std::array<double, 3> scale{1.0, 1.0, 1.0};
  std::array<double, 3> scale_centre_mm{};
  std::size_t first = 0;  ///< the axes of the plane of rotation
  std::size_t second = 1;
  double angle_deg = 0.0;  ///< counter-clockwise seen against the plane's normal
  std::array<double, 2> centre_mm{};
  /// First and second axis have not been programmed since the rotation changed.
  bool turned = false;
  std::size_t turned_first = 0;
  std::size_t turned_second = 1;

  /// Factors and shifts from mirror image and scaling.
  void compose() noexcept;
  [[nodiscard]] Axes to_work(const Axes& words) const noexcept;
  [[nodiscard]] Axes to_words(const Axes& work) const noexcept;
  /// A distance, such as that of an arc's centre from its start.
  [[nodiscard]] std::array<double, 3> distance(const std::array<double, 3>& words) const noexcept;
  /// Counter-clockwise stays counter-clockwise in the plane of these axes.
  [[nodiscard]] bool keeps_sense(std::size_t axis_1, std::size_t axis_2) const noexcept {
    return factor[axis_1] * factor[axis_2] > 0.0;
  }
  /// A word of this axis moves another axis too.
  [[nodiscard]] bool turns(std::size_t axis) const noexcept {
    return rotated && (axis == first || axis == second);
  }
  /// The axis is where its word says.
  [[nodiscard]] bool leaves_alone(std::size_t axis) const noexcept {
    return axis > 2 || (factor[axis] == 1.0 && shift_mm[axis] == 0.0 && !turns(axis));
  }

  friend bool operator==(const TextFrame&, const TextFrame&) = default;
};

/// Polar coordinates (G16): the plane's first axis word is a radius about the origin of the words,
/// the second an angle.
struct PolarWords {
  bool on = false;
  bool radius_known = false;
  bool angle_known = false;
  double radius_mm = 0.0;
  double angle_deg = 0.0;

  friend bool operator==(const PolarWords&, const PolarWords&) = default;
};

}  // namespace steadyrest::nc::interpret
