// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <steadyrest/kernel/machine/program.hpp>
#include <steadyrest/nc/interpret/state/move.hpp>
#include <steadyrest/nc/read/reader.hpp>

namespace steadyrest::nc::interpret {

enum class Plane : std::uint8_t { xy, zx, yz };

/// One tool of the control's tool table.
struct Tool {
  std::int32_t number = 0;
  Axes offset{};  ///< mm and degrees
  double diameter_mm = 0.0;
  double front_angle_deg = 0.0;  ///< I, J, Q of the tool table: lathe tools
  double back_angle_deg = 0.0;
  std::int32_t orientation = 0;

  friend bool operator==(const Tool&, const Tool&) = default;
};

/// Work offsets G54–G59.3, in this order; for sinumerik G54–G57, G505 ….
inline constexpr std::size_t kWorkOffsets = 9;

inline constexpr std::size_t kReferencePoints = 4;

/// What a number without a decimal point means in a word that takes one (dialect `fanuc`).
enum class DecimalRule : std::uint8_t {
  calculator,      ///< X100 is 100 mm (parameter DPI = 1): most CAM programs rely on it
  least_increment  ///< X100 is 100 increments of 0.001 mm or 0.0001 inch (DPI = 0, IS-B)
};

/// What the interpreter must know that the program does not say.
struct Config {
  read::Dialect dialect = read::Dialect::linuxcnc;
  bool block_delete = false;  ///< the operator's switch: lines that begin with / are left out
  DecimalRule decimal_rule = DecimalRule::calculator;
  bool inch = false;                          ///< units in force at the start (G20)
  bool unit_known = false;                    ///< the control's; false: only assumed
  bool incremental = false;                   ///< G91 in force at the start
  Plane plane = Plane::xy;                    ///< in force at the start
  bool centre_absolute = false;               ///< G90.1 likewise
  bool retract_to_initial = false;            ///< G98 likewise; fanuc begins with it
  PathMode path_mode = PathMode::continuous;  ///< in force at the start, with its tolerance
  double path_tolerance_mm = 0.0;
  bool external_offset = true;  ///< fanuc: G10 L2 P0 is the external offset; false: G52 (Haas)
  Axes external{};              ///< fanuc: external work offset in force at the start
  std::string axes = "XYZABC";  ///< letters of the machine's axes
  Axes start{};                 ///< machine position at the start, mm and degrees
  std::array<Axes, kWorkOffsets> work_offset{};
  std::array<double, kWorkOffsets> rotation_deg{};  ///< of the work offsets about Z
  std::size_t active_offset = 0;  ///< index into work_offset that is in force at the start
  Axes g92{};                     ///< G92 offset at the start
  bool g92_on = false;            ///< in force; false: only stored, for G92.3
  Axes tool_offset{};             ///< tool length in force at the start
  /// G28, G30; fanuc: G30 P3 and P4. Machine coordinates.
  std::array<Axes, kReferencePoints> home{};
  /// linuxcnc: other numbered parameters kept by the control, with their values at the start.
  std::vector<std::pair<int, double>> numbers;
  /// The offsets, the active one, the reference points and the parameters above are the control's;
  /// false: they are only assumed.
  bool start_known = false;
  /// linuxcnc: reads as the running control does. What it may keep from before the program (a
  /// parameter that the program has not set) is refused then, not taken as 0.
  bool on_control = false;
  /// The program is read for a machine, not for a preview: #<_task> is 1.
  bool on_machine = false;
  /// A probing move leaves the axes so far before its end: LinuxCNC's interpreter without a machine
  /// does, by 0.01 in.
  double probe_short_mm = 0.254;
  /// Without a table every tool exists with length 0: positions are then the tip of a tool without
  /// length. With a table, a tool that is not in it is refused.
  std::optional<std::vector<Tool>> tools;
  double data_unit_mm = 1.0;  ///< unit of #5161 … #5410: 1 or 25.4
  /// Folders that `o<name> call` searches for NAME.ngc, in this order.
  std::vector<std::string> subprogram_folders;
  /// Most lines that a program may execute in loops and subprograms; beyond that it is refused.
  std::uint64_t most_repeated_lines = 20'000'000;
  std::int32_t tool_in_spindle = 0;
  std::optional<std::int32_t> selected_tool;  ///< by T, at the start; else that in the spindle
  /// What the control's own configuration makes of a program; its folders are not used here.
  kernel::machine::Program settings;
  /// What is not understood opens an opaque stretch (opaque.hpp); false: it refuses the program.
  bool opaque_stretches = false;
  std::int32_t modulation_on = 0;  ///< M word that switches the speed modulation on; 0 = none
  std::int32_t modulation_off = 0;

  friend bool operator==(const Config&, const Config&) = default;
};

}  // namespace steadyrest::nc::interpret
