// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <steadyrest/nc/interpret/state/asked.hpp>
#include <steadyrest/nc/read/text/block.hpp>

namespace steadyrest::nc::interpret {

/// What words may change of a control's state.
struct Effects {
  ModeMask modes = 0;
  std::uint32_t axes = 0;  ///< work positions, a mask
  bool offsets = false;    ///< the work offsets, a shift or a tool's length
  bool ends = false;       ///< M2, M30: the program
  bool program = false;    ///< M98, M99
  bool input = false;      ///< M66
  bool all = false;        ///< anything: the code itself is not known

  static constexpr std::uint32_t kAllAxes = 0x1FF;
  /// Where the machine is, or what the next block makes of its words. Speed, coolant, tool number
  /// and switches are not.
  [[nodiscard]] bool moves() const noexcept;
  void add(const Effects& other) noexcept;
  /// One word; `has_code`: its value is known (a G or M code).
  void add(char letter, double code, bool has_code, bool settable_frames) noexcept;
};

/// Of all words of a block.
[[nodiscard]] Effects effects_of(const read::Block& block, bool settable_frames) noexcept;

/// The modes that a G or M word settles.
[[nodiscard]] ModeMask modes_of_g(double code, bool settable_frames) noexcept;
[[nodiscard]] ModeMask modes_of_m(double code) noexcept;

/// What a line of LinuxCNC would change if it were executed, whatever its values are.
struct Skipped {
  Effects effects;
  std::vector<int> numbers;  ///< parameters that it sets
  std::vector<std::string> names;
  bool any_number = false;  ///< one whose number is calculated
};
[[nodiscard]] Skipped skipped(std::string_view line);

}  // namespace steadyrest::nc::interpret
