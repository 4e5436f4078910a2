// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <steadyrest/adapters/linuxcnc/config/ini_file.hpp>
#include <steadyrest/kernel/outcome/result.hpp>

namespace steadyrest::adapters::linuxcnc::config {

/// One axis of the machine, or a placeholder for a missing X, Y or Z.
struct ConfiguredAxis {
  char letter = 'X';
  bool rotary = false;
  std::vector<std::size_t> joints;  ///< those that move it, ascending; none: a placeholder

  [[nodiscard]] bool present() const noexcept { return !joints.empty(); }
};

/// What a configuration's INI file says of its axes, units and periods.
struct Configuration {
  std::string name;
  double mm_per_unit = 1.0;
  double deg_per_unit = 1.0;
  double servo_period_ms = 1.0;
  std::vector<ConfiguredAxis> axes;  ///< X, Y, Z, then A B C U V W, as in a machine file
};

/// Refused: kinematics in which a joint is not an axis, missing sections and keys, axes without a
/// joint, one axis or more than eight.
[[nodiscard]] kernel::outcome::Result<Configuration> configuration_of(const IniFile& ini);

}  // namespace steadyrest::adapters::linuxcnc::config
