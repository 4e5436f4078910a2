// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <steadyrest/adapters/linuxcnc/config/configuration.hpp>
#include <steadyrest/adapters/linuxcnc/config/hal_use.hpp>
#include <steadyrest/adapters/linuxcnc/config/ini_file.hpp>
#include <steadyrest/kernel/outcome/result.hpp>

namespace steadyrest::adapters::linuxcnc::config {

/// One value of the machine file and the line that it is from.
struct FoundValue {
  std::string key;    ///< `control.max_feed_mm_min`, `axis.X.servo_gain_1_s`
  std::string value;  ///< as the machine file writes it
  std::string from;   ///< `FILE:LINE: [AXIS_X] MAX_VELOCITY = 4`, or LinuxCNC's default
};

/// The machine file for a configuration, and what in it no INI or HAL file says.
struct MachineText {
  std::string text;
  std::size_t from_ini = 0;  ///< figures from the files or LinuxCNC's own defaults
  std::size_t assumed = 0;   ///< figures to be measured; each line of the text says ASSUMED
  std::vector<FoundValue> values;
  std::vector<std::string> clipped;  ///< values beyond a machine file's range, with what is taken
  std::vector<std::string> not_carried;  ///< entries that the machine file cannot hold, and why
};

/// `hal`: null where the HAL files cannot be read, for the reason `hal_unread`; then the servo data
/// are the INI file's. Refused: what limits_of() refuses, and speeds or accelerations of 0.
[[nodiscard]] kernel::outcome::Result<MachineText> machine_text(const IniFile& ini,
                                                                const Configuration& machine,
                                                                const HalUse* hal,
                                                                const std::string& hal_unread);

}  // namespace steadyrest::adapters::linuxcnc::config
