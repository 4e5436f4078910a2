// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <steadyrest/adapters/linuxcnc/config/configuration.hpp>
#include <steadyrest/adapters/linuxcnc/config/ini_file.hpp>
#include <steadyrest/kernel/machine/machine.hpp>

namespace steadyrest::adapters::linuxcnc::config {

/// Something that the machine file says otherwise than the configuration.
struct Difference {
  std::string what;
  std::string to_do;
};

/// What of `machine` is not so in the configuration that the control runs: which axes there are, in
/// which order and kind, and the servo period; then speeds (the spindle's too), accelerations and
/// ends of travel beyond the control's.
[[nodiscard]] std::vector<Difference> differences(const IniFile& ini,
                                                  const Configuration& configuration,
                                                  const kernel::machine::Machine& machine);

/// What a layer takes over at its start alone, and `wanted` changes: the port turns the offset
/// against heat with `offset_slew_um_s`, and paths are planned by [control] and the axes' limits.
[[nodiscard]] std::optional<Difference> changed_since_start(const kernel::machine::Machine& running,
                                                            const kernel::machine::Machine& wanted);

}  // namespace steadyrest::adapters::linuxcnc::config
