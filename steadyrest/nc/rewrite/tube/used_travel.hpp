// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>

#include <steadyrest/kernel/machine/axis.hpp>
#include <steadyrest/nc/interpret/state/move.hpp>

namespace steadyrest::nc::rewrite {

/// How far the moves of a program go along X, Y and Z in machine coordinates, and in which line.
class UsedTravel {
 public:
  struct Farthest {
    double mm = 0.0;
    std::uint32_t line = 0;
  };

  void add(const interpret::Move& move, std::uint32_t line) noexcept;
  [[nodiscard]] const Farthest& low(std::size_t axis) const { return low_.at(axis); }
  [[nodiscard]] const Farthest& high(std::size_t axis) const { return high_.at(axis); }

 private:
  static constexpr std::size_t kAxes = 3;
  static constexpr double kNone_mm = std::numeric_limits<double>::infinity();

  std::array<Farthest, kAxes> low_ = {Farthest{kNone_mm}, Farthest{kNone_mm}, Farthest{kNone_mm}};
  std::array<Farthest, kAxes> high_ = {Farthest{-kNone_mm}, Farthest{-kNone_mm},
                                       Farthest{-kNone_mm}};
};

/// Where a changed program leaves the travel of an axis.
struct TravelFault {
  std::uint32_t line = 0;  ///< of the changed program
  std::string what;
};
/// None where the changed program stays within the travel, or within what the original uses of it:
/// an original that goes beyond the travel by itself is the control's to stop.
[[nodiscard]] std::optional<TravelFault> travel_fault(std::span<const kernel::machine::Axis> axes,
                                                      const UsedTravel& original,
                                                      const UsedTravel& changed);

}  // namespace steadyrest::nc::rewrite
