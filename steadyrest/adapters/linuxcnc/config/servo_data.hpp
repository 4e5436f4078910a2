// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <steadyrest/adapters/linuxcnc/config/configuration.hpp>
#include <steadyrest/adapters/linuxcnc/config/hal_use.hpp>
#include <steadyrest/adapters/linuxcnc/config/ini_file.hpp>

namespace steadyrest::adapters::linuxcnc::config {

/// A figure and the `FILE:LINE: text` that it is from.
struct ServoFigure {
  double value = 0.0;
  std::string from;
};

/// The position loop of an axis's first joint, as far as its files say.
///
/// A `pid` whose output is a velocity (it goes to a step generator's velocity-cmd, through an
/// integrator, or has FF1 = 1) is a loop with the gain Pgain in 1/s and the weight FF1. A step
/// generator in position mode, or feedback taken from the command, leaves no lag: weight 1. The
/// latter has no encoder either: a scale in the INI file is unused then.
struct ServoData {
  std::optional<ServoFigure> gain_1_s;
  std::optional<ServoFigure> feed_forward;
  std::optional<ServoFigure> counts_per_unit;  ///< of the encoder, or steps
  std::vector<std::string> unused;             ///< found, with no place in the servo model
};

/// `hal`: null where the HAL files cannot be read; the INI file's [JOINT_N] then counts alone.
[[nodiscard]] ServoData servo_data(const IniFile& ini, const HalUse* hal,
                                   const ConfiguredAxis& axis);

}  // namespace steadyrest::adapters::linuxcnc::config
