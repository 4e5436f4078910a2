// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

#include <steadyrest/adapters/linuxcnc/config/configuration.hpp>
#include <steadyrest/adapters/linuxcnc/config/ini_file.hpp>
#include <steadyrest/kernel/outcome/result.hpp>

namespace steadyrest::adapters::linuxcnc::config {

/// The machine file for a configuration, and what in it no INI file says.
struct MachineText {
  std::string text;
  std::size_t from_ini = 0;  ///< figures from the INI file or LinuxCNC's own defaults
  std::size_t assumed = 0;   ///< figures to be measured; each line of the text says ASSUMED
};

/// Refused: what limits_of() refuses, and speeds, accelerations or overrides out of range.
[[nodiscard]] kernel::outcome::Result<MachineText> machine_text(const IniFile& ini,
                                                                const Configuration& machine);

}  // namespace steadyrest::adapters::linuxcnc::config
