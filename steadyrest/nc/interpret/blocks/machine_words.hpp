// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <steadyrest/nc/interpret/control/stage.hpp>

namespace steadyrest::nc::interpret {

/// Feed, spindle, tool, coolant, override switches, outputs and inputs.
class MachineWords : private Stage {
 public:
  using Stage::Stage;

  /// Converts mm/min, mm/rev or 1/min to the internal unit. On LinuxCNC an F word uses the units in
  /// force before the block: it comes before G20/G21 in the order of execution.
  void feed(const Step& step) noexcept;
  bool spindle_speed(const Step& step);
  bool select_tool(const Step& step);
  bool change_tool(const Step& step);
  void spindle(const Step& step);
  void coolant(const Step& step);
  void overrides(const Step& step) noexcept;
  /// M62 to M68 move nothing. An input (M66) is assumed to read 0, as in rs274: only the machine
  /// knows its real value.
  bool outputs(const Step& step);

 private:
  bool within_limit(const Step& step);

  std::string selected_name_;  ///< sinumerik T="NAME", until M6
};

}  // namespace steadyrest::nc::interpret
