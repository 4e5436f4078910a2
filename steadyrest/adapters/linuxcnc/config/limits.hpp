// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include <steadyrest/adapters/linuxcnc/config/configuration.hpp>
#include <steadyrest/adapters/linuxcnc/config/ini_file.hpp>
#include <steadyrest/kernel/outcome/result.hpp>

namespace steadyrest::adapters::linuxcnc::config {

/// A value for the machine file and where it is from.
struct Figure {
  double value = 0.0;
  std::string from;     ///< `[AXIS_X] MAX_VELOCITY = 4`, or LinuxCNC's default
  std::string where;    ///< `FILE:LINE` of an entry
  std::string clipped;  ///< why it is not the entry's: the entry is above what a machine file takes
};

/// What the figures of a machine may be.
struct Range {
  double least = 0.0;
  double most = 0.0;
  const char* unit = "";
};

/// An axis's limits in mm or degrees and seconds. Travel is what axis and joints permit together;
/// speed and acceleration are the axis's, which LinuxCNC plans with.
struct AxisLimits {
  Figure speed_units_s;
  Figure acceleration_units_s2;
  std::optional<Figure> min;
  std::optional<Figure> max;
  std::string slower_joint;  ///< the entry of a joint whose MAX_VELOCITY is below the axis's
};

/// Refused: numbers that are none or out of range, and a travel without room in it.
[[nodiscard]] kernel::outcome::Result<AxisLimits> limits_of(const IniFile& ini,
                                                            const Configuration& machine,
                                                            const ConfiguredAxis& axis);

/// A value × `factor`, at most the largest of the range; nothing without the key. Refused: a value
/// below the range.
[[nodiscard]] kernel::outcome::Result<std::optional<Figure>> figure(const IniFile& ini,
                                                                    const char* section,
                                                                    const char* key, double factor,
                                                                    const Range& range);

}  // namespace steadyrest::adapters::linuxcnc::config
