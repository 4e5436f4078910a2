// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include <steadyrest/kernel/machine/thermal.hpp>
#include <steadyrest/kernel/outcome/result.hpp>

namespace steadyrest::kernel::machine {

/// The thermal sections of a machine file, or of a passport that holds nothing else. Refused: what
/// the machine file's reader refuses, and a file without [[thermal.axis]].
[[nodiscard]] outcome::Result<Thermal> read_thermal_passport(const std::string& path);
[[nodiscard]] outcome::Result<Thermal> parse_thermal_passport(std::string_view text,
                                                              const std::string& file);

}  // namespace steadyrest::kernel::machine
