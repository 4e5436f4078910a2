// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace steadyrest::kernel::machine {

/// Shapes of the spindle's speed; chatter/online/speed_law.hpp has the formulas.
enum class SpeedLaw : std::uint8_t { constant, square, pulse, triangle, sine, random, stop };

/// As machine files and the command line write them, in the order of `SpeedLaw`.
inline constexpr std::array<std::string_view, 7> kSpeedLawNames = {
    "constant", "square", "pulse", "triangle", "sine", "random", "stop"};
static_assert(kSpeedLawNames.size() == static_cast<std::size_t>(SpeedLaw::stop) + 1,
              "each law has its name; `stop` is the last");

/// What the chatter room may do on this machine.
struct Chatter {
  bool enabled = false;
  SpeedLaw law = SpeedLaw::triangle;
  double amplitude_ratio = 0.10;  ///< of the mean speed, to either side
  double amplitude_rev_s = 0.0;   ///< the same as a speed; 0 = use `amplitude_ratio`
  double period_s = 2.0;
  double mean_ratio = 1.0;                ///< of the programmed speed
  double min_feed_per_tooth_ratio = 0.8;  ///< of the programmed feed per tooth
  double max_feed_per_tooth_ratio = 1.2;
  std::uint32_t m_code_on = 38;  ///< 0 = always on, whatever the program says
  std::uint32_t m_code_off = 39;
  std::uint64_t seed = 1;

  friend bool operator==(const Chatter&, const Chatter&) = default;
};

}  // namespace steadyrest::kernel::machine
