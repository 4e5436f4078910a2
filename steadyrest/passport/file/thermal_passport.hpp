// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include <steadyrest/kernel/machine/thermal.hpp>
#include <steadyrest/kernel/outcome/result.hpp>

namespace steadyrest::passport {

/// The thermal sections of a machine file, or of a passport that contains nothing else. Refused:
/// what the machine file's reader refuses, and a file without [[thermal.axis]].
[[nodiscard]] kernel::outcome::Result<kernel::machine::Thermal> read_thermal_passport(
    const std::string& path);
[[nodiscard]] kernel::outcome::Result<kernel::machine::Thermal> parse_thermal_passport(
    std::string_view text, const std::string& file);

}  // namespace steadyrest::passport
