// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <steadyrest/kernel/outcome/result.hpp>

namespace steadyrest::adapters::linuxcnc {

/// X Y Z A B C U V W: mm, rotary ones degrees.
using ControlAxes = std::array<double, 9>;

/// What LinuxCNC has loaded and how a program starts there, as its status channel shows it.
struct ControlState {
  struct Tool {
    int number = 0;
    ControlAxes offset{};
    double diameter_mm = 0.0;
    double front_deg = 0.0;
    double back_deg = 0.0;
    int orientation = 0;
  };
  std::string version;       ///< of LinuxCNC
  std::string ini;           ///< that LinuxCNC was started with
  std::string program;       ///< absolute path; empty: none
  bool text_is_file = true;  ///< what it has opened of it is what the file holds now
  bool stopped = true;       ///< no program runs
  ControlAxes position{};    ///< of the machine, while it is stopped
  int work_offset = 1;       ///< 1: G54 … 9: G59.3; 0: not said yet
  ControlAxes work_offset_mm{};
  double rotation_deg = 0.0;
  ControlAxes g92_mm{};
  ControlAxes tool_offset_mm{};
  int tool = 0;  ///< in the spindle
  std::vector<Tool> tools;
  bool block_delete = false;
  bool inch = false;  ///< G20
  bool incremental = false;
  std::string plane;  ///< xy, zx or yz
  bool retract_to_initial = false;
  bool centre_absolute = false;
  std::optional<int> selected_tool;  ///< by T; none: that in the spindle
  std::string unread;                ///< what is in force that the layer's reader does not know
  std::string path_mode;             ///< exact_path, exact_stop or continuous
  double path_tolerance_mm = 0.0;    ///< P of G64
  bool machine_inch = false;         ///< unit of the variable file's lengths
  std::string variables;             ///< file of the numbered parameters; empty: none
  std::vector<std::string> folders;
};

/// One line of control_state.py. Refused: a line that is not of it (bad input), and what it could
/// not do (unavailable).
[[nodiscard]] kernel::outcome::Result<ControlState> control_state(std::string_view line);

}  // namespace steadyrest::adapters::linuxcnc
